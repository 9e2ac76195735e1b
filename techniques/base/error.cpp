#include "techniques/base/error.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace sightlines {
namespace {

std::string one_line(const std::string& where, const std::string& place, const std::string& problem,
                     const std::string& remedy) {
    std::string line = where;
    if (!place.empty()) line += (line.empty() ? "" : ": ") + place;
    line += (line.empty() ? "" : ": ") + problem;
    if (!remedy.empty()) line += " (" + remedy + ")";
    // Names out of untrusted files may hold control characters; the message stays one printable line.
    for (char& letter : line)
        if (static_cast<unsigned char>(letter) < 0x20 || letter == 0x7f) letter = ' ';
    return line;
}

}  // namespace

InputError::InputError(std::string where_, std::string place_, std::string problem_, std::string remedy_)
    : std::runtime_error(one_line(where_, place_, problem_, remedy_)),
      where(std::move(where_)),
      place(std::move(place_)),
      problem(std::move(problem_)),
      remedy(std::move(remedy_)) {}

EnvironmentError::EnvironmentError(std::string where_, std::string problem_, std::string remedy_)
    : std::runtime_error(one_line(where_, "", problem_, remedy_)),
      where(std::move(where_)),
      problem(std::move(problem_)),
      remedy(std::move(remedy_)) {}

int edit_distance(const std::string& a, const std::string& b) {
    std::vector<std::vector<int>> distance(a.size() + 1, std::vector<int>(b.size() + 1));
    for (std::size_t i = 0; i <= a.size(); ++i) distance[i][0] = static_cast<int>(i);
    for (std::size_t j = 0; j <= b.size(); ++j) distance[0][j] = static_cast<int>(j);
    for (std::size_t i = 1; i <= a.size(); ++i) {
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const int replace = distance[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
            distance[i][j] = std::min({replace, distance[i - 1][j] + 1, distance[i][j - 1] + 1});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                distance[i][j] = std::min(distance[i][j], distance[i - 2][j - 2] + 1);
        }
    }
    return distance[a.size()][b.size()];
}

}  // namespace sightlines
