// The view of a ray, taken out of any technique's structure.
#include <algorithm>
#include <limits>

#include "app/inside.h"
#include "shaders/octahedral.h"
#include "techniques/baselines/baselines.h"
#include "techniques/visibility_field/visibility_field.h"

namespace sightlines {
namespace {

bool is_marching(const Session& session) {
    return session.technique == "voxel_marching" || session.technique == "row_marching";
}

bool is_field(const Session& session) { return session.technique == "visibility_field"; }

/// The cells of the technique's structure, where it has any.
std::vector<ValuedBox> cells_of(const Session& session, const Structure& structure) {
    std::vector<ValuedBox> cells;
    if (is_marching(session))
        for (const Box3& box : baselines::occupied_boxes(structure)) cells.push_back({box, 0.0f});
    if (!is_field(session)) return cells;
    const visibility_field::VisibilityField& field = visibility_field::built_field(structure).field;
    constexpr float shown_part = 0.4f;  // of a cell's side, so that what lies between can be seen
    for (const visibility_field::OccupiedCell& cell : visibility_field::occupied_cells(field)) {
        const Box3 box = visibility_field::cell_box(field.shape, cell.place);
        const vec3 half = 0.5f * shown_part * box.size();
        cells.push_back({{box.centre() - half, box.centre() + half},
                         static_cast<float>(visibility_field::occlusion_ratio(field, cell.index))});
    }
    return cells;
}

std::shared_ptr<const std::vector<ValuedBox>> cells_of(const Session& session, const Shared<BuiltStructure>& structure,
                                                       UnpackedVoxels& unpacked) {
    if (!unpacked.boxes || unpacked.boxed.lock() != structure) {
        unpacked.boxes = std::make_shared<const std::vector<ValuedBox>>(cells_of(session, structure->value.structure));
        unpacked.boxed = structure;
    }
    return unpacked.boxes;
}

/// Near is strong: each map from its least number that is not "nothing there" to its greatest.
PictureMap picture_map(const baselines::LookedUpMap& map) {
    PictureMap picture{map.title, map.side, {}, map.asked};
    float least = std::numeric_limits<float>::infinity(), most = 0.0f;
    for (const float near : map.nearness) {
        if (near > 0.0f) least = std::min(least, near);
        most = std::max(most, near);
    }
    for (const float near : map.nearness)
        picture.values.push_back(near <= 0.0f   ? 0.0f
                                 : most > least ? 0.15f + 0.85f * (near - least) / (most - least)
                                                : 1.0f);
    return picture;
}

std::vector<PictureMap> maps_of(const Session& session, const SelectedRay& ray, const Structure& structure) {
    std::vector<PictureMap> maps;
    if (session.technique == "shadow_maps")
        for (const auto& map : baselines::looked_up_maps(structure, ray.request, ray.trace))
            maps.push_back(picture_map(map));
    if (session.technique == "imperfect_shadow_maps")
        for (const auto& map : baselines::looked_up_imperfect_maps(structure, ray.request, ray.trace))
            maps.push_back(picture_map(map));
    return maps;
}

/// The directions of both masks on a sphere about their cell.
std::vector<ValuedPatch> folded(const PictureMap& visible, const PictureMap& occluded, const Box3& cell) {
    const int side = visible.side;
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

/// What the field knows of the cell that a sample starts in: both masks, flat and folded.
void add_masks(RayPicture& picture, const visibility_field::BuiltField& built, const SelectedRay& ray) {
    using namespace visibility_field;
    const TraceRequest& request = ray.request;
    const SampleTrace traced = trace_sample(built.field, *built.embree, culling_of(request.parameters),
                                            {request.position, request.normal, -request.light.direction, vec3(0.0f)});
    if (traced.fate == Fate::outside_cells || traced.fate == Fate::below_surface) return;
    const int side = built.field.shape.mask_size;
    for (const int which : {0, 1}) {
        const auto words = mask_words(built.field, traced.cell_index, which);
        PictureMap map{which == 0 ? "visibility mask" : "occlusion mask", side, {}, traced.texel};
        for (int row = 0; row < side; ++row)
            for (int column = 0; column < side; ++column)
                map.values.push_back(mask_bit(words, side, column, row) ? 1.0f : 0.0f);
        picture.maps.push_back(std::move(map));
    }
    picture.patches = folded(picture.maps[0], picture.maps[1], cell_box(built.field.shape, traced.cell));
}

/// Each piece of geometry once.
std::vector<TraceGeometry> touched(const Trace& trace) {
    std::vector<TraceGeometry> pieces;
    for (const TraceStep& step : trace.steps)
        for (const TraceGeometry& piece : step.geometry)
            if (std::ranges::find(pieces, piece) == pieces.end()) pieces.push_back(piece);
    return pieces;
}

/// A ray to the sun is shown as far as something is, or that would be a speck at its end.
Segment shown_ray(const SelectedRay& ray, float most) {
    const Segment whole = ray.trace.ray;
    const vec3 along = whole.target - whole.origin;
    const float length = glm::length(along);
    if (ray.request.light.kind != LightKind::directional || length <= most) return whole;
    return {whole.origin, whole.origin + along / length * most};
}

}  // namespace

RayPicture ray_picture(const Session& session, const SelectedRay& ray, Results& results, Progress& progress,
                       UnpackedVoxels& unpacked) {
    const auto structure = results.structure(session, progress);
    const auto scene = results.scene(session, progress);
    RayPicture picture;
    picture.scene = {scene, &scene->value};
    picture.boxes = cells_of(session, structure, unpacked);
    if (is_marching(session)) picture.boxes_title = "occupied voxels";
    picture.maps = maps_of(session, ray, structure->value.structure);
    picture.recorded = touched(ray.trace);
    picture.blocked = ray.trace.blocked;
    picture.truly_blocked = ray.truly_blocked;
    float most_m = 0.5f * scene->value.bounds.diagonal();
    if (is_field(session)) {
        constexpr float cells_shown = 6.0f;
        const visibility_field::BuiltField& built = visibility_field::built_field(structure->value.structure);
        picture.boxes_title = "cells, from visible to occluded";
        picture.boxes_graded = true;
        picture.end_name = "environment";
        add_masks(picture, built, ray);
        most_m = std::min(most_m, cells_shown * built.options.cell_m);
    }
    picture.ray = shown_ray(ray, most_m);
    return picture;
}

}  // namespace sightlines
