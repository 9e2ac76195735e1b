#include "app/table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace sightlines {
namespace {

/// Code points in UTF-8: every byte but the continuation bytes.
std::size_t characters(const std::string& text) {
    return static_cast<std::size_t>(
        std::ranges::count_if(text, [](char letter) { return (static_cast<unsigned char>(letter) & 0xc0u) != 0x80u; }));
}

std::vector<std::vector<std::string>> all_rows(const TextTable& table) {
    std::vector<std::vector<std::string>> rows = table.rows;
    if (!table.heading.empty()) rows.insert(rows.begin(), table.heading);
    return rows;
}

std::string csv_cell(const std::string& cell) {
    if (cell.find_first_of(",\"\n") == std::string::npos) return cell;
    std::string quoted = "\"";
    for (const char letter : cell) quoted.append(letter == '"' ? 2 : 1, letter);
    return quoted.append("\"");
}

}  // namespace

std::string text_from(const TextTable& table, int indent) {
    const auto rows = all_rows(table);
    std::vector<std::size_t> widths;
    for (const auto& row : rows) {
        widths.resize(std::max(widths.size(), row.size()));
        for (std::size_t column = 0; column < row.size(); ++column)
            widths[column] = std::max(widths[column], characters(row[column]));
    }
    std::string text;
    for (const auto& row : rows) {
        std::string line(static_cast<std::size_t>(indent), ' ');
        for (std::size_t column = 0; column < row.size(); ++column) {
            const std::string padding(widths[column] - characters(row[column]), ' ');
            const bool right = column < table.align.size() && table.align[column] == TableAlign::right;
            if (column > 0) line += "  ";
            line += right ? padding + row[column] : row[column] + padding;
        }
        const std::size_t end = line.find_last_not_of(' ');
        text += line.substr(0, end == std::string::npos ? 0 : end + 1) + "\n";
    }
    return text;
}

std::string csv_from(const TextTable& table) {
    std::string text;
    for (const auto& row : all_rows(table)) {
        for (std::size_t column = 0; column < row.size(); ++column)
            text.append(column > 0 ? "," : "").append(csv_cell(row[column]));
        text += "\n";
    }
    return text;
}

std::string markdown_from(const TextTable& table) {
    const auto line = [](const std::vector<std::string>& row) {
        std::string text = "|";
        for (const std::string& cell : row) text.append(" ").append(cell).append(" |");
        return text.append("\n");
    };
    std::string rule = "|";
    for (std::size_t column = 0; column < table.heading.size(); ++column)
        rule += column < table.align.size() && table.align[column] == TableAlign::right ? "---:|" : "---|";
    std::string text = line(table.heading) + rule + "\n";
    for (const auto& row : table.rows) text += line(row);
    return text;
}

std::string count_text(std::uint64_t count) {
    std::string digits = std::to_string(count);
    for (std::size_t place = 3; place < digits.size(); place += 4) digits.insert(digits.size() - place, 1, ',');
    return digits;
}

std::string fixed_text(double value, int digits) {
    std::array<char, 64> text{};
    std::snprintf(text.data(), text.size(), "%.*f", digits, value);
    return text.data();
}

std::string bytes_text(std::uint64_t bytes) {
    constexpr std::array<const char*, 5> units{"B", "KiB", "MiB", "GiB", "TiB"};
    double value = static_cast<double>(bytes);
    std::size_t unit = 0;
    for (; value >= 1024.0 && unit + 1 < units.size(); ++unit) value /= 1024.0;
    return fixed_text(value, unit == 0 || value >= 100.0 ? 0 : 1) + " " + units[unit];
}

std::string seconds_text(double seconds) {
    if (seconds < 0.9995) return fixed_text(1e3 * seconds, seconds < 0.01 ? 2 : 0) + " ms";
    return fixed_text(seconds, 2) + " s";
}

std::string rate_text(double per_second) {
    return fixed_text(1e-6 * per_second, per_second < 1e8 ? 1 : 0) + " M rays/s";
}

std::string percent_text(double percent) { return fixed_text(percent, 2) + " %"; }

std::vector<std::string> wrapped(const std::string& text, std::size_t width) {
    std::vector<std::string> lines;
    std::size_t start = 0;
    while (start < text.size()) {
        const std::size_t end = std::min(text.find(' ', start), text.size());
        const std::string word = text.substr(start, end - start);
        if (!lines.empty() && characters(lines.back()) + 1 + characters(word) <= width)
            lines.back().append(" ").append(word);
        else
            lines.push_back(word);
        start = end + 1;
    }
    return lines;
}

}  // namespace sightlines
