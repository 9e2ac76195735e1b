// Radiance pictures. Our own reader: Debian's stb_image never returns from a run-length picture that is cut short.
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <span>
#include <string_view>

#include "techniques/base/error.h"
#include "techniques/base/files.h"
#include "techniques/scene/environment.h"

namespace sightlines {
namespace {

constexpr std::uint64_t file_limit_bytes = std::uint64_t{1} << 30u;
constexpr int widest = 16384, highest = 8192;
constexpr std::size_t longest_line = 4096;
constexpr int shortest_run_length_row = 8, longest_run_length_row = 32767;  // others are never run-length coded

using Rgbe = std::array<std::uint8_t, 4>;

struct Reader {
    std::string where;
    std::span<const std::uint8_t> bytes;
    std::size_t at = 0;

    [[noreturn]] void refuse(const std::string& problem, const std::string& remedy = {}) const {
        throw InputError(where, "byte " + std::to_string(at), problem, remedy);
    }
    std::uint8_t byte() {
        if (at >= bytes.size()) refuse("the picture is cut short");
        return bytes[at++];
    }
    /// Up to the end of the line, which is taken too.
    std::string line() {
        std::string text;
        for (std::uint8_t next = byte(); next != '\n'; next = byte()) {
            text += static_cast<char>(next);
            if (text.size() > longest_line) refuse("a line of the header is longer than 4,096 bytes");
        }
        return text;
    }
};

/// The decimal number that is all of `text`.
int whole_number(const Reader& reader, std::string_view text) {
    int number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size() || number <= 0)
        reader.refuse("\"" + std::string(text) + "\" is not a size");
    return number;
}

/// "-Y 256 +X 512"
ImageSize read_size(Reader& reader) {
    const std::string line = reader.line();
    const std::size_t x = line.find(" +X ");
    if (!line.starts_with("-Y ") || x == std::string::npos)
        reader.refuse("rows must go down and columns to the right (\"-Y height +X width\")", "flip the picture");
    ImageSize size;
    size.height = whole_number(reader, std::string_view(line).substr(3, x - 3));
    size.width = whole_number(reader, std::string_view(line).substr(x + 4));
    if (size.width > widest || size.height > highest)
        reader.refuse("the picture is larger than 16,384 x 8,192 pixels", "scale it down");
    return size;
}

/// Returns the factor that the header's EXPOSURE lines put on the values.
float read_header(Reader& reader) {
    const std::string first = reader.line();
    if (!first.starts_with("#?")) reader.refuse("it is not a Radiance picture (.hdr)");
    float exposure = 1.0f;
    for (std::string line = reader.line(); !line.empty(); line = reader.line()) {
        if (line.starts_with("FORMAT=") && line != "FORMAT=32-bit_rle_rgbe")
            reader.refuse("the format " + line.substr(7) + " is not read", "convert it to 32-bit_rle_rgbe");
        if (line.starts_with("EXPOSURE=")) {
            const std::size_t value = line.find_first_not_of(' ', 9);
            float factor = 0.0f;
            if (value != std::string::npos) std::from_chars(line.data() + value, line.data() + line.size(), factor);
            if (!(factor > 0.0f) || !std::isfinite(factor)) reader.refuse("EXPOSURE is not a positive number");
            exposure *= factor;
        }
    }
    return exposure;
}

/// One of the four channels of a row, as runs and literals.
void read_runs(Reader& reader, std::size_t channel, std::span<Rgbe> row) {
    for (std::size_t x = 0; x < row.size();) {
        const std::uint8_t count = reader.byte();
        const bool is_run = count > 128;
        const std::size_t length = is_run ? count - 128u : count;
        if (length == 0 || length > row.size() - x) reader.refuse("a run does not fit into its row");
        const std::uint8_t repeated = is_run ? reader.byte() : std::uint8_t{0};
        for (std::size_t k = 0; k < length; ++k) row[x++][channel] = is_run ? repeated : reader.byte();
    }
}

void read_row(Reader& reader, std::span<Rgbe> row) {
    const auto width = row.size();
    Rgbe first;
    for (std::uint8_t& value : first) value = reader.byte();
    const bool can_have_runs = width >= shortest_run_length_row && width <= longest_run_length_row;
    if (can_have_runs && first[0] == 2 && first[1] == 2 && first[2] < 128) {
        if (first[2] * std::size_t{256} + first[3] != width) reader.refuse("a row has another width than the picture");
        for (std::size_t channel = 0; channel < 4; ++channel) read_runs(reader, channel, row);
        return;
    }
    row[0] = first;
    for (std::size_t x = 1; x < width; ++x) {
        for (std::uint8_t& value : row[x]) value = reader.byte();
        if (row[x][0] == 1 && row[x][1] == 1 && row[x][2] == 1) reader.refuse("old-style runs are not read");
    }
}

vec3 radiance_of(const Rgbe& value, float scale) {
    if (value[3] == 0) return vec3(0.0f);
    return vec3(value[0], value[1], value[2]) * (scale * std::ldexp(1.0f, static_cast<int>(value[3]) - 136));
}

}  // namespace

Environment read_environment(const std::filesystem::path& file) {
    const std::vector<std::uint8_t> bytes = read_file(file, file_limit_bytes);
    Reader reader{file.string(), bytes};
    const float scale = 1.0f / read_header(reader);
    const ImageSize size = read_size(reader);
    // A row takes at least 2 bytes for 127 pixels of a channel: what claims more pixels than that is not worth the
    // memory.
    if (size.pixels() / 32 > bytes.size()) reader.refuse("the picture is cut short");
    ImageRgb radiance(size);
    std::vector<Rgbe> row(static_cast<std::size_t>(size.width));
    for (int y = 0; y < size.height; ++y) {
        read_row(reader, row);
        for (int x = 0; x < size.width; ++x) radiance.at(x, y) = radiance_of(row[static_cast<std::size_t>(x)], scale);
    }
    return make_environment(file.filename().string(), std::move(radiance));
}

}  // namespace sightlines
