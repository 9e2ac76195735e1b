#include "shaders/wide.h"  // first: makes the kernel below wide

#include "shaders/octahedral.h"
#include "tests/visibility_field/wide_octahedral.h"

namespace sightlines::visibility_field::testing {

namespace wide = wide_kernel;
using wide::lanes;

std::vector<int> wide_texels(std::span<const vec3> directions, int size) {
    std::vector<int> texels;
    for (std::size_t start = 0; start < directions.size(); start += lanes) {
        const std::size_t count = std::min(lanes, directions.size() - start);
        float axes[3][lanes];
        int columns[lanes], rows[lanes];
        for (std::size_t lane = 0; lane < lanes; ++lane)
            for (int axis = 0; axis < 3; ++axis) axes[axis][lane] = directions[start + std::min(lane, count - 1)][axis];
        const wide::OctahedralTexel texel = wide::octahedral_texel(
            wide::octahedral_place({wide::load(axes[0]), wide::load(axes[1]), wide::load(axes[2])}), size);
        wide::store(texel.column, columns);
        wide::store(texel.row, rows);
        for (std::size_t lane = 0; lane < count; ++lane) texels.push_back(rows[lane] * size + columns[lane]);
    }
    return texels;
}

}  // namespace sightlines::visibility_field::testing
