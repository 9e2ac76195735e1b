#include "techniques/base/files.h"

#include <algorithm>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "techniques/base/error.h"

namespace sightlines {
namespace {

namespace fs = std::filesystem;

/// An empty folder for one test, gone afterwards.
struct Folder {
    fs::path path = fs::path(SIGHTLINES_TEST_OUTPUT_FOLDER) / ("files-" + std::to_string(getpid()));

    Folder() {
        fs::remove_all(path);
        fs::create_directories(path);
    }
    ~Folder() { fs::remove_all(path); }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
};

std::string text_of(const fs::path& file) {
    const std::vector<std::uint8_t> bytes = read_file(file, 1000);
    return {bytes.begin(), bytes.end()};
}

template <class Error>
Error thrown_by(const auto& action) {
    try {
        action();
    } catch (const Error& error) {
        return error;
    }
    ADD_FAILURE() << "nothing was thrown";
    if constexpr (std::is_same_v<Error, InputError>)
        return Error("", "", "");
    else
        return Error("", "");
}

TEST(Files, ReadsBackWhatWasWrittenToTheLastByte) {
    const Folder folder;
    std::vector<std::uint8_t> bytes(100000);
    for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(i * 7);
    write_file(folder.path / "data", bytes);
    EXPECT_EQ(read_file(folder.path / "data", 100000), bytes);
    write_file(folder.path / "data", std::string_view{});
    EXPECT_TRUE(read_file(folder.path / "data", 0).empty());
}

TEST(Files, ReplacesAnOlderFileAndLeavesNothingElseBehind) {
    const Folder folder;
    write_file(folder.path / "a.txt", std::string_view("a long old text"));
    write_file(folder.path / "a.txt", std::string_view("new"));
    EXPECT_EQ(text_of(folder.path / "a.txt"), "new");
    EXPECT_EQ(std::distance(fs::directory_iterator(folder.path), fs::directory_iterator{}), 1);
}

TEST(Files, RefusesToReadWhatIsMissingAFolderTooLargeOrNotAFile) {
    const Folder folder;
    EXPECT_EQ(thrown_by<InputError>([&] { read_file(folder.path / "none", 10); }).problem, "no such file");
    EXPECT_EQ(thrown_by<InputError>([&] { read_file(folder.path, 10); }).problem, "is a directory");
    write_file(folder.path / "large", std::string_view("12345678901"));
    const InputError too_large = thrown_by<InputError>([&] { read_file(folder.path / "large", 10); });
    EXPECT_EQ(too_large.problem, "holds 11 bytes; the limit is 10");
    EXPECT_EQ(too_large.where, (folder.path / "large").string());
    ASSERT_EQ(mkfifo((folder.path / "pipe").c_str(), 0600), 0);
    EXPECT_EQ(thrown_by<InputError>([&] { read_file(folder.path / "pipe", 10); }).problem, "is not a regular file");
}

TEST(Files, RefusesToReadThroughAFileAsIfItWereAFolder) {
    const Folder folder;
    write_file(folder.path / "a", std::string_view("x"));
    EXPECT_THROW(read_file(folder.path / "a" / "b", 10), InputError);
}

TEST(Files, SaysEarlyThatAPlaceCannotBeWrittenAndLeavesNothingThere) {
    const Folder folder;
    for (const fs::path& place : {folder.path / "missing" / "a.png", folder.path, fs::path("")}) {
        EXPECT_THROW(check_writable(place), EnvironmentError) << place;
        EXPECT_THROW(write_file(place, std::string_view("x")), EnvironmentError) << place;
    }
    EXPECT_TRUE(fs::is_empty(folder.path));
    EXPECT_NO_THROW(check_writable(folder.path / "new.png"));
    EXPECT_TRUE(fs::is_empty(folder.path));
}

TEST(Files, NeverReplacesADeviceOrAPipe) {
    const Folder folder;
    const fs::path pipe = folder.path / "pipe";
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    EXPECT_THROW(check_writable(pipe), EnvironmentError);
    EXPECT_THROW(write_file(pipe, std::string_view("x")), EnvironmentError);
    EXPECT_TRUE(fs::is_fifo(pipe));
}

TEST(Files, WritesThroughASymbolicLinkInsteadOfReplacingIt) {
    const Folder folder;
    write_file(folder.path / "real.txt", std::string_view("old"));
    fs::create_symlink("real.txt", folder.path / "link.txt");
    write_file(folder.path / "link.txt", std::string_view("new"));
    EXPECT_TRUE(fs::is_symlink(folder.path / "link.txt"));
    EXPECT_EQ(text_of(folder.path / "real.txt"), "new");
}

TEST(Files, RefusesAFolderWithoutPermission) {
    if (geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
    const Folder folder;
    fs::permissions(folder.path, fs::perms::owner_read | fs::perms::owner_exec);
    EXPECT_THROW(check_writable(folder.path / "a.png"), EnvironmentError);
    fs::permissions(folder.path, fs::perms::owner_all);
}

}  // namespace
}  // namespace sightlines
