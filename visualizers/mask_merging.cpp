#include "visualizers/mask_merging.h"

#include <algorithm>
#include <array>

#include "shaders/octahedral.h"

namespace sightlines {

std::vector<ValuedPatch> folded(const PictureMap& visible, const PictureMap& occluded, const Box3& cell) {
    const int side = visible.size.x;
    const float radius_m = 0.75f * cell.diagonal(), texel = 2.0f / static_cast<float>(side);
    const auto on_sphere = [&](int column, int row) {
        return cell.centre() +
               radius_m * scalar_kernel::octahedral_direction(
                              {texel * static_cast<float>(column) - 1.0f, texel * static_cast<float>(row) - 1.0f});
    };
    std::vector<ValuedPatch> patches;
    for (int row = 0; row < side; ++row)
        for (int column = 0; column < side; ++column) {
            const auto k = static_cast<std::size_t>(row * side + column);
            const float seen = visible.values[k], blocked = occluded.values[k];
            if (seen + blocked == 0.0f) continue;
            patches.push_back({{on_sphere(column, row), on_sphere(column + 1, row), on_sphere(column + 1, row + 1),
                                on_sphere(column, row + 1)},
                               blocked / (seen + blocked)});
        }
    return patches;
}

RayPicture merged_until(const RayPicture& picture, int merged) {
    RayPicture made = picture;
    made.samples.reset();
    if (!picture.samples || picture.samples->empty()) return made;
    const auto& samples = *picture.samples;
    const std::size_t count = std::min(static_cast<std::size_t>(std::max(merged, 1)), samples.size());
    std::array<PictureMap*, 4> maps{};
    for (std::size_t k = 0; k < maps.size(); ++k) {
        maps[k] = &made.maps[k];
        std::ranges::fill(maps[k]->values, 0.0f);
    }
    const std::string which = std::to_string(count), all = std::to_string(samples.size());
    maps[0]->title = "sample " + which + ": visible";
    maps[1]->title = "occluded";
    maps[2]->title = which + " of " + all + " merged: visible";
    maps[3]->title = "occluded";
    const float stalk_m = picture.cell ? 0.12f * picture.cell->diagonal() : 0.0f;
    for (std::size_t sample = 0; sample < count; ++sample) {
        const CellSample& each = samples[sample];
        const bool latest = sample + 1 == count;
        for (std::size_t k = 0; k < each.visible.size(); ++k) {
            // Merging is OR, texel by texel (equations 5 and 6).
            if (each.visible[k] != 0) maps[2]->values[k] = 1.0f;
            if (each.occluded[k] != 0) maps[3]->values[k] = 1.0f;
            if (!latest) continue;
            maps[0]->values[k] = each.visible[k] != 0 ? 1.0f : 0.0f;
            maps[1]->values[k] = each.occluded[k] != 0 ? 1.0f : 0.0f;
        }
        const TraceGeometry stalk{latest ? "sample " + which : "sample",
                                  TraceShape::segment,
                                  {each.position, each.position + stalk_m * each.normal}};
        (latest ? made.pointed : made.marked).push_back(stalk);
    }
    if (picture.cell) made.patches = folded(*maps[2], *maps[3], *picture.cell);
    return made;
}

}  // namespace sightlines
