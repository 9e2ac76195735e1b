// What a glTF document's URIs bring in: data URIs, and files that lie inside the document's own folder.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace sightlines {

/// The bytes of a `data:` URI (RFC 2397: base64 or percent-encoded, any media type); nothing where it is malformed.
std::optional<std::vector<std::uint8_t>> decode_data_uri(const std::string& uri);

/// True for `data:...`, which names no file.
bool is_data_uri(const std::string& uri);

/// The regular file that a relative URI names, percent-decoded, below `folder` once every symbolic link is followed.
/// InputError (at `place` of `file`) for a scheme, an absolute path, `..`, a backslash, a control character, a link
/// that leads out of the folder, a missing file or one that is not regular.
std::filesystem::path confined_path(const std::string& file, const std::string& place,
                                    const std::filesystem::path& folder, const std::string& uri);

}  // namespace sightlines
