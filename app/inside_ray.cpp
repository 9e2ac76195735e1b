// The view of a ray, taken out of any technique's structure.
#include <algorithm>
#include <limits>

#include "app/inside.h"
#include "app/inside_field.h"
#include "techniques/baselines/baselines.h"
#include "techniques/visibility_field/visibility_field.h"

namespace sightlines {
namespace {

bool is_marching(const Session& session) {
    return session.technique == "voxel_marching" || session.technique == "row_marching";
}

/// The cells of the technique's structure, where it has any.
std::vector<ValuedBox> cells_of(const Session& session, const Structure& structure) {
    std::vector<ValuedBox> cells;
    if (is_marching(session))
        for (const Box3& box : baselines::occupied_boxes(structure)) cells.push_back({box, 0.0f});
    return shows_cells(session) ? field_cells(structure) : cells;
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
    PictureMap picture{map.title, ivec2(map.side), {}, map.asked};
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
    if (shows_cells(session)) {
        constexpr float cells_shown = 6.0f;
        picture.end_name = "environment";
        most_m =
            std::min(most_m, cells_shown * visibility_field::built_field(structure->value.structure).options.cell_m);
        add_field(picture, session, ray, structure->value.structure);
    }
    picture.ray = shown_ray(ray, most_m);
    return picture;
}

}  // namespace sightlines
