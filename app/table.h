// Text for people: aligned tables, and numbers with units.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace sightlines {

enum class TableAlign { left, right };

/// Columns padded to their widest cell (counted in characters, not bytes), two spaces between them.
struct TextTable {
    std::vector<std::string> heading;  ///< may be empty: no heading line
    std::vector<TableAlign> align;     ///< by column; left where it is shorter
    std::vector<std::vector<std::string>> rows;
};

/// Each row one line that ends in a newline, indented by `indent` spaces.
std::string text_from(const TextTable& table, int indent = 0);
/// RFC 4180, the heading first.
std::string csv_from(const TextTable& table);
std::string markdown_from(const TextTable& table);

std::string count_text(std::uint64_t count);       ///< 1,234,567
std::string fixed_text(double value, int digits);  ///< 12.35
std::string bytes_text(std::uint64_t bytes);       ///< 2.1 GiB
std::string seconds_text(double seconds);          ///< 1.24 s, 12.3 ms
std::string rate_text(double per_second);          ///< 373 M rays/s
std::string percent_text(double percent);          ///< 4.73 %

/// Splits `text` at spaces into lines of at most `width` characters (a longer word stands alone).
std::vector<std::string> wrapped(const std::string& text, std::size_t width);

}  // namespace sightlines
