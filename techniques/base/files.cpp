#include "techniques/base/files.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <memory>
#include <string>
#include <system_error>

#include <unistd.h>

#include "techniques/base/error.h"

namespace sightlines {
namespace {

namespace fs = std::filesystem;

fs::path folder_of(const fs::path& file) { return file.has_parent_path() ? file.parent_path() : fs::path("."); }

}  // namespace

std::vector<std::uint8_t> read_file(const fs::path& file, std::uint64_t limit_bytes) {
    std::error_code failure;
    const fs::file_status status = fs::status(file, failure);
    if (!fs::exists(status)) throw InputError(file.string(), "", "no such file", "check the path");
    if (fs::is_directory(status)) throw InputError(file.string(), "", "is a directory", "name a file inside it");
    if (!fs::is_regular_file(status)) throw InputError(file.string(), "", "is not a regular file");
    const std::uint64_t size = fs::file_size(file, failure);
    if (failure) throw InputError(file.string(), "", "cannot be read: " + failure.message());
    if (size > limit_bytes)
        throw InputError(file.string(), "",
                         "holds " + std::to_string(size) + " bytes; the limit is " + std::to_string(limit_bytes));
    std::ifstream stream(file, std::ios::binary);
    std::vector<std::uint8_t> bytes(size);
    stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
    if (!stream || stream.gcount() != static_cast<std::streamsize>(size))
        throw InputError(file.string(), "", "cannot be read", "check its permissions");
    return bytes;
}

void check_writable(const fs::path& file) {
    std::error_code failure;
    const fs::file_status status = fs::status(file, failure);
    if (fs::is_directory(status)) throw EnvironmentError(file.string(), "is a directory", "name a file to write");
    // A rename would put a file in the place of the device or the pipe.
    if (fs::exists(status) && !fs::is_regular_file(status))
        throw EnvironmentError(file.string(), "is not a regular file", "name a file to write");
    if (!file.has_filename()) throw EnvironmentError(file.string(), "names no file", "name a file to write");
    const fs::path folder = folder_of(file);
    if (!fs::is_directory(folder, failure))
        throw EnvironmentError(file.string(), "the folder " + folder.string() + " does not exist", "make it first");
    if (access(folder.c_str(), W_OK) != 0)
        throw EnvironmentError(file.string(), "cannot write into " + folder.string() + ": " + std::strerror(errno));
}

void write_file(const fs::path& named, std::span<const std::uint8_t> bytes) {
    check_writable(named);
    // A link stays and its target is written.
    const fs::path file = fs::is_symlink(named) && fs::exists(named) ? fs::canonical(named) : named;
    check_writable(file);
    const fs::path temporary = file.string() + ".writing-" + std::to_string(getpid());
    const auto fail = [&](const std::string& what) {
        const std::string cause = std::strerror(errno);
        std::remove(temporary.c_str());
        throw EnvironmentError(file.string(), what + ": " + cause);
    };
    std::FILE* stream = std::fopen(temporary.c_str(), "wb");
    if (stream == nullptr) fail("cannot be written");
    // An empty span's pointer may be null, which fwrite must not be given.
    const bool written = (bytes.empty() || std::fwrite(bytes.data(), 1, bytes.size(), stream) == bytes.size()) &&
                         std::fflush(stream) == 0 && fsync(fileno(stream)) == 0;
    const bool closed = std::fclose(stream) == 0;
    if (!written || !closed) fail("could not be written whole");
    if (std::rename(temporary.c_str(), file.c_str()) != 0) fail("cannot be replaced");
}

void write_file(const fs::path& file, std::string_view text) {
    write_file(file, std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

}  // namespace sightlines
