// Reading with a limit, writing whole or not at all.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

namespace sightlines {

/// The whole of a regular file of at most `limit_bytes`. InputError for: missing, a directory, not a regular file,
/// unreadable, too large (the message names the limit).
std::vector<std::uint8_t> read_file(const std::filesystem::path& file, std::uint64_t limit_bytes);

/// Writes to a temporary name beside `file`, then renames: after a crash there is the old file or the new one, never
/// half of one. A symbolic link is followed. EnvironmentError where that is not possible (names the folder or the disk
/// as the cause), and for directories, devices and pipes.
void write_file(const std::filesystem::path& file, std::span<const std::uint8_t> bytes);
void write_file(const std::filesystem::path& file, std::string_view text);

/// Throws EnvironmentError now if write_file(file, ...) could not work later (asked before long work starts).
void check_writable(const std::filesystem::path& file);

}  // namespace sightlines
