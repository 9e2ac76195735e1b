#include "techniques/pixel_groups.h"

#include <algorithm>

namespace sightlines {
namespace {

/// Fills in the surfaces of the first `count` pixels; the padding behind them lies where the last one does.
void take_surfaces(PixelGroups& groups, const SurfaceBuffer& surfaces, std::size_t count) {
    const std::size_t padded = groups.pixel.size();
    for (int axis = 0; axis < 3; ++axis) {
        groups.position[axis].resize(padded);
        groups.normal[axis].resize(padded);
        groups.shading_normal[axis].resize(padded);
        for (std::size_t k = 0; k < count; ++k) {
            const std::uint32_t pixel = groups.pixel[k];
            groups.position[axis][k] = surfaces.position[pixel][axis];
            groups.normal[axis][k] = surfaces.normal[pixel][axis];
            groups.shading_normal[axis][k] = surfaces.shading_normal[pixel][axis];
        }
        if (count < padded)
            std::fill_n(&groups.position[axis][count], padded - count, groups.position[axis][count - 1]);
    }
}

}  // namespace

PixelGroups group_pixels(const SurfaceBuffer& surfaces, PixelRect rect, int stride, int skip_stride) {
    PixelGroups groups;
    groups.pixel.reserve(static_cast<std::size_t>(rect.width) * static_cast<std::size_t>(rect.height) +
                         pixel_group_size);
    const int block = 4 * stride;
    const int x_end = rect.x + rect.width, y_end = rect.y + rect.height;
    for (int block_y = rect.y; block_y < y_end; block_y += block) {
        for (int block_x = rect.x; block_x < x_end; block_x += block) {
            for (int y = block_y; y < std::min(block_y + block, y_end); y += stride) {
                for (int x = block_x; x < std::min(block_x + block, x_end); x += stride) {
                    if (skip_stride != 0 && x % skip_stride == 0 && y % skip_stride == 0) continue;
                    const auto pixel = static_cast<std::uint32_t>(y * surfaces.size.width + x);
                    if (surfaces.triangle[pixel] != no_triangle) groups.pixel.push_back(pixel);
                }
            }
        }
    }
    const std::size_t count = groups.pixel.size();
    groups.pixel.resize((count + pixel_group_size - 1) / pixel_group_size * pixel_group_size, no_triangle);
    take_surfaces(groups, surfaces, count);
    return groups;
}

}  // namespace sightlines
