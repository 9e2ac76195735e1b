// Compressed arrays kept on disk between runs: compressing takes ten times as long as building.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "techniques/voxel_rows/dictionary.h"

namespace sightlines::voxel_rows {

/// The name of what scene and options make: 32 hexadecimal digits, a hash of all that the array depends on and of the
/// format's version. Threads and memory do not count.
std::string array_key(const Scene& scene, const BuildOptions& build, bool directly,
                      const DictionaryOptions& dictionary);

/// The compressed array of this name; nothing where there is none, or where the file is damaged or of another version
/// (it is removed then). `grid` is that of the options.
std::optional<RowArray> load_array(const std::filesystem::path& folder, const std::string& key, const RowGrid& grid);

/// Keeps the array under that name, whole or not at all, and removes the longest unused ones until all together take
/// at most `limit_bytes`. An array that is larger than that is not kept. EnvironmentError where the folder or the disk
/// refuses.
void save_array(const std::filesystem::path& folder, const std::string& key, const RowArray& array,
                std::uint64_t limit_bytes);

}  // namespace sightlines::voxel_rows
