#include "techniques/voxel_rows/array_cache.h"

#include <algorithm>
#include <fstream>

#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/voxel_rows/scenes.h"

namespace sightlines::voxel_rows {
namespace {

namespace fs = std::filesystem;
using testing::scattered_triangles;

/// A folder of its own, gone afterwards.
struct Folder {
    fs::path path = fs::temp_directory_path() / ("sightlines-cache-" + std::to_string(getpid()));
    Folder() { fs::remove_all(path); }
    ~Folder() { fs::remove_all(path); }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;

    std::vector<fs::path> files() const {
        std::vector<fs::path> all;
        if (fs::exists(path))
            for (const auto& entry : fs::directory_iterator(path)) all.push_back(entry.path());
        return all;
    }
};

constexpr std::uint64_t plenty = std::uint64_t{1} << 30u;

BuildOptions small_build() {
    BuildOptions options;
    options.resolution = 32;
    options.angle_step_deg = 6.0;
    return options;
}

DictionaryOptions small_dictionary() {
    DictionaryOptions options;
    options.rows = 512;
    return options;
}

RowArray compressed_array() {
    Progress progress;
    return compress(build_from_fragments(scattered_triangles(40, 7), small_build(), progress), small_dictionary(),
                    progress);
}

const std::string key(32, 'a'), other_key(32, 'b');

TEST(ArrayCache, GivesBackWhatWasKept) {
    const Folder folder;
    const RowArray array = compressed_array();
    save_array(folder.path, key, array, plenty);
    const std::optional<RowArray> loaded = load_array(folder.path, key, array.grid);
    ASSERT_TRUE(loaded);
    EXPECT_TRUE(std::ranges::equal(loaded->words.words, array.words.words));
    EXPECT_EQ(loaded->dictionary.frequencies, array.dictionary.frequencies);
    EXPECT_EQ(loaded->dictionary.rows_mapped, array.dictionary.rows_mapped);
    EXPECT_EQ(loaded->dictionary.index_bits, array.dictionary.index_bits);
    EXPECT_EQ(loaded->dictionary.rows, array.dictionary.rows);
    EXPECT_EQ(loaded->dictionary.distinct_rows, array.dictionary.distinct_rows);
    EXPECT_EQ(loaded->fragments, array.fragments);
    EXPECT_FALSE(load_array(folder.path, other_key, array.grid));
}

TEST(ArrayCache, AFileWithAnyByteChangedOrMissingIsNotTrustedAndGoes) {
    const Folder folder;
    const RowArray array = compressed_array();
    save_array(folder.path, key, array, plenty);
    const fs::path file = folder.files().at(0);
    std::ifstream stream(file, std::ios::binary);
    const std::string good{std::istreambuf_iterator<char>(stream), {}};
    const auto damaged = [&](std::string bytes) {
        std::ofstream(file, std::ios::binary) << bytes;
        const bool trusted = load_array(folder.path, key, array.grid).has_value();
        EXPECT_EQ(fs::exists(file), trusted);
        return !trusted;
    };
    EXPECT_FALSE(damaged(good));
    for (std::size_t k = 0; k < 64; ++k) {
        std::string bytes = good;
        const std::size_t place = k < 24 ? 8 * k : random_u32(5, static_cast<std::uint32_t>(k), 0) % bytes.size();
        bytes[place] = static_cast<char>(bytes[place] ^ (1 << (k % 8)));
        EXPECT_TRUE(damaged(bytes)) << "byte " << place;
    }
    for (const std::size_t length : {std::size_t{0}, std::size_t{100}, good.size() / 2, good.size() - 1})
        EXPECT_TRUE(damaged(good.substr(0, length))) << length;
    EXPECT_TRUE(damaged(good + "x"));
}

TEST(ArrayCache, AFileUnderAnotherNameIsNotTrusted) {
    const Folder folder;
    const RowArray array = compressed_array();
    save_array(folder.path, key, array, plenty);
    fs::rename(folder.files().at(0), folder.path / (other_key + ".rows"));
    EXPECT_FALSE(load_array(folder.path, other_key, array.grid));
}

TEST(ArrayCache, TheLongestUnusedGoFirstWhenTheLimitIsReached) {
    const Folder folder;
    const RowArray array = compressed_array();
    const auto name = [](int k) { return std::string(32, static_cast<char>('a' + k)); };
    save_array(folder.path, name(0), array, plenty);
    const std::uint64_t one = fs::file_size(folder.files().at(0));
    const auto now = fs::file_time_type::clock::now();
    for (int k = 0; k < 3; ++k) {
        save_array(folder.path, name(k), array, plenty);
        fs::last_write_time(folder.path / (name(k) + ".rows"), now - std::chrono::minutes(10 - k));
    }
    EXPECT_TRUE(load_array(folder.path, name(0), array.grid));  // used just now
    save_array(folder.path, name(3), array, 3 * one);
    EXPECT_TRUE(load_array(folder.path, name(0), array.grid));
    EXPECT_FALSE(load_array(folder.path, name(1), array.grid));
    EXPECT_TRUE(load_array(folder.path, name(2), array.grid));
    EXPECT_TRUE(load_array(folder.path, name(3), array.grid));
    save_array(folder.path, name(4), array, one - 1);
    EXPECT_FALSE(load_array(folder.path, name(4), array.grid));
}

TEST(ArrayCache, WhatAWriteThatWasCutOffLeftIsRemovedInTime) {
    const Folder folder;
    fs::create_directories(folder.path);
    const fs::path old_rest = folder.path / "x.tmp", new_rest = folder.path / "y.tmp";
    std::ofstream(old_rest) << "half";
    std::ofstream(new_rest) << "half";
    fs::last_write_time(old_rest, fs::file_time_type::clock::now() - std::chrono::hours(2));
    save_array(folder.path, key, compressed_array(), plenty);
    EXPECT_FALSE(fs::exists(old_rest));
    EXPECT_TRUE(fs::exists(new_rest));
}

TEST(ArrayCache, TheKeyTellsApartAllThatTheArrayDependsOn) {
    const Scene scene = scattered_triangles(40, 7);
    const std::string first = array_key(scene, small_build(), false, small_dictionary());
    EXPECT_EQ(array_key(scene, small_build(), false, small_dictionary()), first);
    Scene moved = scene;
    moved.positions[3].y += 1.0e-3f;
    EXPECT_NE(array_key(moved, small_build(), false, small_dictionary()), first);
    Scene solid = scene;
    solid.materials[0].double_sided = !solid.materials[0].double_sided;
    EXPECT_NE(array_key(solid, small_build(), false, small_dictionary()), first);
    EXPECT_NE(array_key(scene, small_build(), true, small_dictionary()), first);
    BuildOptions finer = small_build();
    finer.coverage = 0.4;
    EXPECT_NE(array_key(scene, finer, false, small_dictionary()), first);
    DictionaryOptions larger = small_dictionary();
    larger.rows = 513;
    EXPECT_NE(array_key(scene, small_build(), false, larger), first);
    DictionaryOptions other_seed = small_dictionary();
    other_seed.seed = 2;
    EXPECT_NE(array_key(scene, small_build(), false, other_seed), first);
    BuildOptions threads = small_build();
    threads.threads = 1;
    EXPECT_EQ(array_key(scene, threads, false, small_dictionary()), first);
}

}  // namespace
}  // namespace sightlines::voxel_rows
