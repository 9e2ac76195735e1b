#include "techniques/voxel_rows/array_cache.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <chrono>
#include <cstring>
#include <memory>
#include <system_error>
#include <vector>

#include <xxhash.h>

#include "techniques/base/error.h"
#include "techniques/base/files.h"

namespace sightlines::voxel_rows {
namespace {

namespace fs = std::filesystem;

/// Grows with every change of what is stored, or of how arrays are made.
constexpr std::uint32_t format_version = 4;
constexpr const char* extension = ".rows";
constexpr std::size_t most_steps = 8;

/// A file's beginning; the frequencies and the words follow. No padding between the fields.
struct Header {
    std::array<char, 8> magic{'S', 'L', 'R', 'O', 'W', 'S', '\r', '\n'};
    std::uint32_t version = format_version;
    std::int32_t index_bits = 0, steps = 0;
    std::uint32_t dictionary_rows = 0;
    std::array<char, 32> key{};
    std::uint64_t words = 0, fragments = 0, distinct_rows = 0, rows_left_over = 0;
    std::array<std::uint64_t, most_steps> rows_mapped{};
    double build_seconds = 0.0, compress_seconds = 0.0, differing_share = 0.0;
    XXH128_hash_t checksum{};  ///< of the whole file with zeros here
};
static_assert(sizeof(Header) == 192);

struct Hasher {
    std::unique_ptr<XXH3_state_t, XXH_errorcode (*)(XXH3_state_t*)> state{XXH3_createState(), XXH3_freeState};

    Hasher() { XXH3_128bits_reset(state.get()); }
    void add(const void* bytes, std::size_t count) { XXH3_128bits_update(state.get(), bytes, count); }
    template <class Value>
    void add(const Value& value) {
        static_assert(std::is_arithmetic_v<Value>);
        add(&value, sizeof value);
    }
    template <class Value>
    void add_all(const std::vector<Value>& values) {
        add(values.size());
        add(values.data(), values.size() * sizeof(Value));
    }
    XXH128_hash_t digest() const { return XXH3_128bits_digest(state.get()); }
};

XXH128_hash_t checksum_of(Header header, std::span<const std::uint8_t> rest) {
    header.checksum = {};
    Hasher hasher;
    hasher.add(&header, sizeof header);
    hasher.add(rest.data(), rest.size());
    return hasher.digest();
}

std::array<char, 32> key_bytes(const std::string& key) {
    std::array<char, 32> bytes{};
    assert(key.size() == bytes.size());
    std::ranges::copy(key, bytes.begin());
    return bytes;
}

fs::path file_of(const fs::path& folder, const std::string& key) { return folder / (key + extension); }

/// The array that the bytes hold; nothing unless each of them is as it was written.
std::optional<RowArray> parse(std::span<const std::uint8_t> bytes, const std::string& key, const RowGrid& grid) {
    Header header;
    if (bytes.size() < sizeof header) return {};
    std::memcpy(&header, bytes.data(), sizeof header);
    const Header expected;
    if (header.magic != expected.magic || header.version != expected.version || header.key != key_bytes(key)) return {};
    const std::span<const std::uint8_t> rest = bytes.subspan(sizeof header);
    const std::uint64_t word_bytes = sizeof(std::uint32_t), room = rest.size() / word_bytes;
    if (header.words > room || header.dictionary_rows > room ||
        (header.words + header.dictionary_rows) * word_bytes != rest.size())
        return {};
    const XXH128_hash_t checksum = checksum_of(header, rest);
    if (!XXH128_isEqual(checksum, header.checksum)) return {};

    RowArray array;
    array.grid = grid;
    array.fragments = header.fragments;
    array.build_seconds = header.build_seconds;
    RowDictionary& dictionary = array.dictionary;
    dictionary.index_bits = header.index_bits;
    dictionary.rows = header.dictionary_rows;
    dictionary.steps = header.steps;
    dictionary.distinct_rows = header.distinct_rows;
    dictionary.rows_left_over = header.rows_left_over;
    dictionary.rows_mapped.assign(header.rows_mapped.begin(), header.rows_mapped.begin() + header.steps);
    dictionary.differing_share = header.differing_share;
    dictionary.seconds = header.compress_seconds;
    dictionary.frequencies.resize(header.dictionary_rows);
    const std::size_t frequency_bytes = header.dictionary_rows * word_bytes;
    std::memcpy(dictionary.frequencies.data(), rest.data(), frequency_bytes);
    array.words = allocate_huge(header.words);
    std::memcpy(array.words.words.data(), rest.data() + frequency_bytes, header.words * word_bytes);
    return array;
}

/// What lies in the folder, longest unused first. What is no cached array was left by a write that was cut off.
struct Kept {
    fs::path file;
    std::uint64_t bytes = 0;
    fs::file_time_type used;
};
std::vector<Kept> kept_arrays(const fs::path& folder) {
    constexpr auto longest_write = std::chrono::hours(1);
    std::vector<Kept> kept;
    std::error_code ignored;  // another process may take files away at the same time
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored)) {
        const auto used = entry.last_write_time(ignored);
        if (entry.path().extension() == extension)
            kept.push_back({entry.path(), entry.file_size(ignored), used});
        else if (used + longest_write < fs::file_time_type::clock::now())
            fs::remove(entry.path(), ignored);
    }
    std::ranges::sort(kept, {}, &Kept::used);
    return kept;
}

void make_room(const fs::path& folder, std::uint64_t room_bytes) {
    std::vector<Kept> kept = kept_arrays(folder);
    std::uint64_t all = 0;
    for (const Kept& one : kept) all += one.bytes;
    std::error_code ignored;
    for (const Kept& one : kept) {
        if (all <= room_bytes) return;
        fs::remove(one.file, ignored);
        all -= one.bytes;
    }
}

}  // namespace

std::string array_key(const Scene& scene, const BuildOptions& build, bool directly,
                      const DictionaryOptions& dictionary) {
    Hasher hasher;
    hasher.add(format_version);
    hasher.add_all(scene.positions);
    hasher.add_all(scene.triangles);
    hasher.add_all(scene.triangle_materials);
    for (const Material& material : scene.materials) hasher.add(material.double_sided);
    hasher.add(&scene.bounds, sizeof scene.bounds);
    for (const double number : {static_cast<double>(build.resolution), build.angle_step_deg, build.samples_per_voxel,
                                build.coverage, build.inset, directly ? 1.0 : 0.0, static_cast<double>(dictionary.rows),
                                static_cast<double>(dictionary.steps), static_cast<double>(dictionary.leftovers),
                                static_cast<double>(dictionary.choice), dictionary.packed ? 1.0 : 0.0})
        hasher.add(number);
    hasher.add(dictionary.seed);
    XXH128_canonical_t canonical;
    XXH128_canonicalFromHash(&canonical, hasher.digest());
    std::string key;
    constexpr const char* digits = "0123456789abcdef";
    for (const unsigned char byte : canonical.digest) {
        key += digits[byte >> 4u];
        key += digits[byte & 15u];
    }
    return key;
}

std::optional<RowArray> load_array(const fs::path& folder, const std::string& key, const RowGrid& grid) {
    const fs::path file = file_of(folder, key);
    std::error_code error;
    const std::uint64_t bytes = fs::file_size(file, error);
    if (error) return {};
    std::optional<RowArray> array;
    try {
        array = parse(read_file(file, bytes), key, grid);
    } catch (const InputError&) {
        return {};
    }
    if (array)
        fs::last_write_time(file, fs::file_time_type::clock::now(), error);
    else
        fs::remove(file, error);
    return array;
}

void save_array(const fs::path& folder, const std::string& key, const RowArray& array, std::uint64_t limit_bytes) {
    const RowDictionary& dictionary = array.dictionary;
    assert(dictionary.index_bits != 0 && dictionary.rows_mapped.size() <= most_steps);
    Header header;
    header.index_bits = dictionary.index_bits;
    header.steps = dictionary.steps;
    header.dictionary_rows = dictionary.rows;
    header.key = key_bytes(key);
    header.words = array.words.words.size();
    header.fragments = array.fragments;
    header.distinct_rows = dictionary.distinct_rows;
    header.rows_left_over = dictionary.rows_left_over;
    std::ranges::copy(dictionary.rows_mapped, header.rows_mapped.begin());
    header.build_seconds = array.build_seconds;
    header.compress_seconds = dictionary.seconds;
    header.differing_share = dictionary.differing_share;

    const std::size_t frequency_bytes = dictionary.frequencies.size() * sizeof(std::uint32_t);
    std::vector<std::uint8_t> bytes(sizeof header + frequency_bytes + array.words.bytes());
    if (bytes.size() > limit_bytes) return;
    const std::span<std::uint8_t> rest = std::span(bytes).subspan(sizeof header);
    std::memcpy(rest.data(), dictionary.frequencies.data(), frequency_bytes);
    std::memcpy(rest.data() + frequency_bytes, array.words.words.data(), array.words.bytes());
    header.checksum = checksum_of(header, rest);
    std::memcpy(bytes.data(), &header, sizeof header);

    std::error_code error;
    fs::create_directories(folder, error);
    if (error) throw EnvironmentError(folder.string(), "cannot be made (" + error.message() + ")");
    make_room(folder, limit_bytes - bytes.size());
    write_file(file_of(folder, key), bytes);
}

}  // namespace sightlines::voxel_rows
