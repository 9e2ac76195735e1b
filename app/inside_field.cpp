#include "app/inside_field.h"

#include <algorithm>
#include <array>

#include "app/inside.h"
#include "shaders/visibility_field.h"
#include "techniques/trace_boxes.h"
#include "techniques/visibility_field/visibility_field.h"
#include "visualizers/mask_merging.h"

namespace sightlines {
namespace {

using visibility_field::BuiltField;
using visibility_field::OccupiedCell;

/// The cell that is shown, and the texel of its masks that holds the ray's direction.
struct ShownCell {
    std::uint32_t index = scalar_kernel::no_cell;  ///< no_cell: it holds no masks
    ivec3 place{0};
    ivec2 texel{0};
    bool picked = false;
};

bool is_in_grid(const FieldShape& shape, ivec3 place) {
    return glm::all(glm::greaterThanEqual(place, ivec3(0))) &&
           glm::all(glm::lessThan(place, ivec3(shape.cells_x, shape.cells_y, shape.cells_z)));
}

ShownCell shown_cell(const BuiltField& built, const Session& session, const SelectedRay& ray) {
    const FieldShape& shape = built.field.shape;
    const scalar_kernel::Bricks bricks{built.field.bricks.data()};
    const int texel = scalar_kernel::texel_of(shape, -ray.request.light.direction);
    ShownCell shown;
    shown.texel = {texel % shape.mask_size, texel / shape.mask_size};
    const auto take = [&](const scalar_kernel::FieldCell& cell) {
        shown.index = cell.index;
        shown.place = {cell.x, cell.y, cell.z};
        return cell.index != scalar_kernel::no_cell;
    };
    const std::optional<ivec3> voxel = session.selection.voxel;
    shown.picked = voxel && is_in_grid(shape, *voxel) &&
                   take(scalar_kernel::find_cell(shape, bricks, voxel->x, voxel->y, voxel->z));
    if (!shown.picked) take(scalar_kernel::locate_cell(shape, bricks, ray.request.position, ray.request.normal));
    return shown;
}

std::vector<std::uint8_t> bits_of(std::span<const std::uint32_t> words, int side) {
    std::vector<std::uint8_t> bits;
    for (int row = 0; row < side; ++row)
        for (int column = 0; column < side; ++column)
            bits.push_back(visibility_field::mask_bit(words, side, column, row) ? 1 : 0);
    return bits;
}

PictureMap mask_map(const std::string& title, const std::vector<std::uint8_t>& bits, int side, ivec2 asked) {
    return {title, ivec2(side), std::vector<float>(bits.begin(), bits.end()), asked};
}

/// Both masks as they are stored, flat and folded.
void add_masks(RayPicture& picture, const BuiltField& built, const ShownCell& shown) {
    const int side = built.field.shape.mask_size;
    const std::array<std::string, 2> titles = shown.picked
                                                  ? std::array<std::string, 2>{"picked cell: visible", "occluded"}
                                                  : std::array<std::string, 2>{"visibility mask", "occlusion mask"};
    for (const int which : {0, 1})
        picture.maps.push_back(mask_map(titles[static_cast<std::size_t>(which)],
                                        bits_of(mask_words(built.field, shown.index, which), side), side, shown.texel));
    picture.patches = folded(picture.maps[0], picture.maps[1], *picture.cell);
}

/// The cell's point samples, each with its own masks, for merged_until.
void add_merging(RayPicture& picture, const BuiltField& built, const ShownCell& shown) {
    const int side = built.field.shape.mask_size;
    const visibility_field::CellSteps steps = bake_steps(samples_of(built, shown.place), *built.embree, built.options);
    std::vector<CellSample> samples;
    for (std::size_t k = 0; k < steps.visible.size(); ++k)
        samples.push_back({steps.points.points[k].position, steps.points.points[k].normal,
                           bits_of(steps.visible[k], side), bits_of(steps.occluded[k], side)});
    const std::vector<std::uint8_t> clear(static_cast<std::size_t>(side * side), 0);
    for (int map = 0; map < 4; ++map) picture.maps.push_back(mask_map("", clear, side, shown.texel));
    picture.samples = std::make_shared<const std::vector<CellSample>>(std::move(samples));
    picture.boxes.reset();
    picture.focus = *picture.cell;
}

/// The cells of one layer of the paper's layout, and the layer itself (Xu 2022, Figure 4).
void add_atlas(RayPicture& picture, const BuiltField& built, const ShownCell& shown) {
    const FieldShape& shape = built.field.shape;
    const ImageScalar layer = dense_layer(built.field, shown.place.y);
    const int map_side = shape.mask_size + 2;
    PictureMap map{"layer " + std::to_string(shown.place.y + 1) + " of " + std::to_string(shape.cells_y) + ": " +
                       std::to_string(shape.cells_x) + " \u00d7 " + std::to_string(shape.cells_z) +
                       " cells, a byte a texel",
                   {layer.size.width, layer.size.height},
                   layer.pixels,
                   map_side * ivec2(shown.place.x, shown.place.z),
                   map_side};
    // The strongest byte has both masks' bits and the label's.
    constexpr float most = static_cast<float>(visibility_field::dense_visible + visibility_field::dense_occluded +
                                              visibility_field::dense_label) /
                           255.0f;
    for (float& value : map.values) value /= most;
    picture.maps = {std::move(map)};
    picture.maps_share = 0.5f;
    auto in_layer = std::make_shared<std::vector<ValuedBox>>();
    Box3 bounds;
    for (const ValuedBox& box : *picture.boxes)
        if (box.place.y == shown.place.y) {
            in_layer->push_back(box);
            bounds.add(box.box.lowest);
            bounds.add(box.box.highest);
        }
    picture.boxes = std::move(in_layer);
    picture.boxes_whole = true;
    picture.boxes_title = "cells of the layer, from visible to occluded";
    if (!bounds.empty()) picture.focus = bounds;
}

}  // namespace

std::vector<ValuedBox> field_cells(const Structure& structure) {
    const visibility_field::VisibilityField& field = visibility_field::built_field(structure).field;
    constexpr float shown_part = 0.4f;  // of a cell's side, so that what lies between can be seen
    std::vector<ValuedBox> cells;
    for (const OccupiedCell& cell : occupied_cells(field)) {
        const Box3 box = visibility_field::cell_box(field.shape, cell.place);
        const vec3 half = 0.5f * shown_part * box.size();
        cells.push_back({{box.centre() - half, box.centre() + half},
                         static_cast<float>(visibility_field::occlusion_ratio(field, cell.index)),
                         cell.place});
    }
    return cells;
}

void add_field(RayPicture& picture, const Session& session, const SelectedRay& ray, const Structure& structure) {
    const BuiltField& built = visibility_field::built_field(structure);
    picture.boxes_title = "cells, from visible to occluded";
    picture.boxes_graded = true;
    const ShownCell shown = shown_cell(built, session, ray);
    if (shown.index == scalar_kernel::no_cell) return;
    picture.cell = visibility_field::cell_box(built.field.shape, shown.place);
    if (shown.picked) picture.pointed.push_back(box_geometry("picked cell", *picture.cell));
    const std::string_view figure = shown_figure(session);
    if (figure == "merging")
        add_merging(picture, built, shown);
    else if (figure == "atlas")
        add_atlas(picture, built, shown);
    else
        add_masks(picture, built, shown);
}

}  // namespace sightlines
