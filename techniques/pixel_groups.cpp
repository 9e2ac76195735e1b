#include "techniques/pixel_groups.h"

#include <algorithm>

namespace sightlines {
namespace {

void append(PixelGroups& groups, const SurfaceBuffer& surfaces, std::uint32_t pixel) {
    groups.pixel.push_back(pixel);
    for (int axis = 0; axis < 3; ++axis) {
        groups.position[axis].push_back(surfaces.position[pixel][axis]);
        groups.normal[axis].push_back(surfaces.normal[pixel][axis]);
        groups.shading_normal[axis].push_back(surfaces.shading_normal[pixel][axis]);
    }
}

void pad(PixelGroups& groups) {
    while (groups.pixel.size() % pixel_group_size != 0) {
        // The last pixel's position keeps the padding where its neighbours are.
        groups.pixel.push_back(no_triangle);
        for (int axis = 0; axis < 3; ++axis) {
            groups.position[axis].push_back(groups.position[axis].back());
            groups.normal[axis].push_back(0.0f);
            groups.shading_normal[axis].push_back(0.0f);
        }
    }
}

}  // namespace

PixelGroups group_pixels(const SurfaceBuffer& surfaces, PixelRect rect, int stride, int skip_stride) {
    PixelGroups groups;
    const int block = 4 * stride;
    const int x_end = rect.x + rect.width, y_end = rect.y + rect.height;
    for (int block_y = rect.y; block_y < y_end; block_y += block) {
        for (int block_x = rect.x; block_x < x_end; block_x += block) {
            for (int y = block_y; y < std::min(block_y + block, y_end); y += stride) {
                for (int x = block_x; x < std::min(block_x + block, x_end); x += stride) {
                    if (skip_stride != 0 && x % skip_stride == 0 && y % skip_stride == 0) continue;
                    const auto pixel = static_cast<std::uint32_t>(y * surfaces.size.width + x);
                    if (surfaces.triangle[pixel] != no_triangle) append(groups, surfaces, pixel);
                }
            }
        }
    }
    pad(groups);
    return groups;
}

}  // namespace sightlines
