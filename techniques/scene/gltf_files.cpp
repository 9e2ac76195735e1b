#include "techniques/scene/gltf_files.h"

#include <algorithm>
#include <string_view>
#include <system_error>

#include "techniques/base/error.h"

namespace sightlines {
namespace {

namespace fs = std::filesystem;

int hex_digit(char letter) {
    if (letter >= '0' && letter <= '9') return letter - '0';
    if (letter >= 'a' && letter <= 'f') return letter - 'a' + 10;
    if (letter >= 'A' && letter <= 'F') return letter - 'A' + 10;
    return -1;
}

std::string percent_decoded(const std::string& uri) {
    std::string text;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        const bool coded =
            uri[i] == '%' && i + 2 < uri.size() && hex_digit(uri[i + 1]) >= 0 && hex_digit(uri[i + 2]) >= 0;
        text += coded ? static_cast<char>(hex_digit(uri[i + 1]) * 16 + hex_digit(uri[i + 2])) : uri[i];
        if (coded) i += 2;
    }
    return text;
}

int base64_digit(char letter) {
    if (letter >= 'A' && letter <= 'Z') return letter - 'A';
    if (letter >= 'a' && letter <= 'z') return letter - 'a' + 26;
    if (letter >= '0' && letter <= '9') return letter - '0' + 52;
    if (letter == '+') return 62;
    if (letter == '/') return 63;
    return -1;
}

std::optional<std::vector<std::uint8_t>> decode_base64(std::string_view text) {
    const std::size_t length = text.size();
    while (!text.empty() && text.back() == '=') text.remove_suffix(1);
    if (text.size() % 4 == 1 || length - text.size() > 2) return std::nullopt;
    std::vector<std::uint8_t> bytes;
    bytes.reserve(text.size() * 3 / 4);
    std::uint32_t bits = 0;
    unsigned held = 0;
    for (const char letter : text) {
        const int digit = base64_digit(letter);
        if (digit < 0) return std::nullopt;
        bits = (bits << 6u) | static_cast<std::uint32_t>(digit);
        held += 6;
        if (held < 8) continue;
        held -= 8;
        bytes.push_back(static_cast<std::uint8_t>(bits >> held));
    }
    return bytes;
}

/// True where every component of `path` up to the length of `folder` is the folder's.
bool lies_below(const fs::path& path, const fs::path& folder) {
    const auto [in_folder, in_path] = std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
    return in_folder == folder.end() && in_path != path.end();
}

}  // namespace

bool is_data_uri(const std::string& uri) { return uri.starts_with("data:"); }

std::optional<std::vector<std::uint8_t>> decode_data_uri(const std::string& uri) {
    const std::size_t comma = uri.find(',');
    if (!is_data_uri(uri) || comma == std::string::npos) return std::nullopt;
    if (uri.compare(std::max<std::size_t>(comma, 7) - 7, 7, ";base64") == 0)
        return decode_base64(std::string_view(uri).substr(comma + 1));
    const std::string plain = percent_decoded(uri.substr(comma + 1));
    return std::vector<std::uint8_t>(plain.begin(), plain.end());
}

fs::path confined_path(const std::string& file, const std::string& place, const fs::path& folder,
                       const std::string& uri) {
    const std::string name = percent_decoded(uri);
    const std::string shown = std::string("`").append(name, 0, 200).append("`");
    const std::string remedy = "keep external files beside the scene and name them by a relative path";
    const bool control =
        std::ranges::any_of(name, [](unsigned char letter) { return letter < 0x20 || letter == 0x7f; });
    if (name.empty() || control) throw InputError(file, place, "is not the name of a file", remedy);
    if (name.find(':') != std::string::npos)
        throw InputError(file, place, shown + " is neither a relative path nor a data URI", remedy);
    const fs::path relative = name;
    const bool climbs = std::ranges::find(relative, fs::path("..")) != relative.end();
    if (relative.is_absolute() || climbs || name.find('\\') != std::string::npos)
        throw InputError(file, place, shown + " may lead out of the scene's folder", remedy);

    std::error_code failure;
    const fs::path home = fs::canonical(folder, failure);
    if (failure) throw InputError(file, place, "the scene's folder cannot be read: " + failure.message());
    const fs::path target = fs::canonical(home / relative, failure);
    if (failure)
        throw InputError(file, place, shown + " cannot be found: " + failure.message(), "put it beside the scene");
    if (!lies_below(target, home)) throw InputError(file, place, shown + " leads out of the scene's folder", remedy);
    if (!fs::is_regular_file(target, failure)) throw InputError(file, place, shown + " is not a regular file", remedy);
    return target;
}

}  // namespace sightlines
