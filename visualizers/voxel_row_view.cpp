#include "visualizers/voxel_row_view.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include <vtkNew.h>
#include <vtkPlane.h>
#include <vtkRenderer.h>

#include "visualizers/canvas.h"
#include "visualizers/offscreen_window.h"
#include "visualizers/raster.h"
#include "visualizers/solid_piece.h"
#include "visualizers/view_camera.h"
#include "visualizers/view_geometry.h"
#include "visualizers/voxel_row_marks.h"

namespace sightlines {
namespace {

/// What a piece of geometry was made from; made again only when that changes. The pointers keep their objects alive, so
/// that equal pointers mean equal content.
struct MadeFrom {
    std::shared_ptr<const void> content;
    mat4 world_from_voxels{0.0f};
    VoxelBox box{};  ///< of voxels; empty: none
    CutPlane cut{};
    int v = -1, w = -1, first = 0, last = 0;
    Theme theme = Theme::light;
    bool mark_extent = false;

    bool operator==(const MadeFrom&) const = default;
};

using Piece = KeptPiece<MadeFrom>;

/// Everything that may be drawn, to set the near and far planes around.
Box3 drawn_bounds(const VoxelRowPicture& picture) {
    Box3 bounds;
    const auto n = static_cast<float>(picture.resolution);
    for (int corner = 0; corner < 8; ++corner)
        bounds.add(world_point(picture, n * vec3(corner & 1, corner >> 1 & 1, corner >> 2 & 1)));
    if (picture.scene && !picture.scene->bounds.empty()) {
        bounds.add(picture.scene->bounds.lowest);
        bounds.add(picture.scene->bounds.highest);
    }
    return bounds;
}

void append(ColouredTriangles& out, const ColouredTriangles& more) {
    const auto first = static_cast<std::uint32_t>(out.positions.size());
    out.positions.insert(out.positions.end(), more.positions.begin(), more.positions.end());
    out.colours.insert(out.colours.end(), more.colours.begin(), more.colours.end());
    for (const uvec3& triangle : more.triangles) out.triangles.push_back(triangle + first);
}

/// The part of an object's voxels that is drawn: the slice counts voxels of what stands still.
VoxelBox object_box(const VoxelRowPicture& rows, ViewState state, vec3 forward) {
    state.slice_first = 0;
    state.slice_last = rows.resolution - 1;
    return cut_away(rows, state, forward).box;
}

/// Where a line enters a box: origin + distance * direction, or nothing.
std::optional<float> entry(vec3 low, vec3 high, vec3 origin, vec3 direction) {
    float enter = 0.0f, leave = std::numeric_limits<float>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
        const float to_low = (low[axis] - origin[axis]) / direction[axis];
        const float to_high = (high[axis] - origin[axis]) / direction[axis];
        enter = std::max(enter, std::min(to_low, to_high));
        leave = std::min(leave, std::max(to_low, to_high));
    }
    return enter < leave ? std::optional(enter) : std::nullopt;
}

}  // namespace

struct VoxelRowView::Objects {
    vtkSmartPointer<vtkRenderWindow> window = make_offscreen_window();
    vtkNew<vtkRenderer> renderer;
    vtkNew<vtkPlane> cut;
    Piece scene, voxels, row;
    KeptPiece<std::vector<MadeFrom>> moving;  ///< voxels and rows of the objects that move

    Objects() {
        renderer->SetBackground(0.0, 0.0, 0.0);
        renderer->SetBackgroundAlpha(0.0);
        for (Piece* const piece : {&scene, &voxels, &row}) renderer->AddActor(piece->solid.actor);
        renderer->AddActor(moving.solid.actor);
        scene.solid.mapper->AddClippingPlane(cut);
        window->AddRenderer(renderer);
    }
};

namespace {

/// What the objects' voxels and rows were made from: two entries an object.
std::vector<MadeFrom> moving_from(const VoxelRowPicture& picture, const ViewState& state, vec3 forward) {
    std::vector<MadeFrom> from;
    for (const ObjectPicture& object : picture.objects) {
        if (!object.rows) continue;
        const VoxelRowPicture& rows = *object.rows;
        MadeFrom piece{.content = rows.occupied, .world_from_voxels = rows.world_from_voxels, .theme = state.theme};
        if (state.voxels) piece.box = object_box(rows, state, forward);
        if (state.row) {
            piece.v = rows.v;
            piece.w = rows.w;
            piece.first = rows.first;
            piece.last = rows.last;
            piece.mark_extent = state.extent;
        }
        from.push_back(piece);
    }
    return from;
}

void make_moving(VoxelRowView::Objects& objects, const VoxelRowPicture& picture, const ViewState& state, vec3 forward) {
    const std::vector<MadeFrom> from = moving_from(picture, state, forward);
    keep_made(objects.moving, !from.empty(), from, [&] {
        const Palette colours = palette(state.theme);
        ColouredTriangles all;
        for (const ObjectPicture& object : picture.objects) {
            if (!object.rows) continue;
            if (state.voxels)
                append(all, voxel_triangles(*object.rows, object_box(*object.rows, state, forward), colours));
            if (state.row) append(all, row_triangles(*object.rows, colours, state.extent));
        }
        return all;
    });
}

void make_pieces(VoxelRowView::Objects& objects, const VoxelRowPicture& picture, const ViewState& state,
                 const Cut& cut) {
    const Palette colours = palette(state.theme);
    const CutPlane plane = cut_plane(picture, cut);
    const bool has_scene = picture.scene && !picture.scene->triangles.empty();
    keep_made(objects.scene, state.scene && has_scene,
              MadeFrom{.content = picture.scene, .cut = plane, .theme = state.theme},
              [&] { return ghost_triangles(*picture.scene, plane, colours); });
    keep_made(objects.voxels, state.voxels && !cut.box.empty(),
              MadeFrom{.content = picture.occupied,
                       .world_from_voxels = picture.world_from_voxels,
                       .box = cut.box,
                       .theme = state.theme},
              [&] { return voxel_triangles(picture, cut.box, colours); });
    keep_made(objects.row, state.row,
              MadeFrom{.content = picture.occupied,
                       .world_from_voxels = picture.world_from_voxels,
                       .v = picture.v,
                       .w = picture.w,
                       .first = picture.first,
                       .last = picture.last,
                       .theme = state.theme,
                       .mark_extent = state.extent},
              [&] { return row_triangles(picture, colours, state.extent); });
}

}  // namespace

VoxelRowView::VoxelRowView() : objects(std::make_unique<Objects>()) {}
VoxelRowView::~VoxelRowView() = default;
VoxelRowView::VoxelRowView(VoxelRowView&&) noexcept = default;
VoxelRowView& VoxelRowView::operator=(VoxelRowView&&) noexcept = default;

OrbitCamera shown_camera(const VoxelRowPicture& picture, const ViewState& state, ImageSize size) {
    if (state.camera) return *state.camera;
    const auto n = static_cast<float>(picture.resolution);
    // Wide enough to see where the extent lies in the row, however short it is.
    const bool kept = picture.first <= picture.last;
    const float middle = kept ? 0.5f * static_cast<float>(picture.first + picture.last + 1) : 0.5f * n;
    const float half =
        kept ? std::max(0.56f * static_cast<float>(picture.last - picture.first + 1), 0.08f * n) : 0.5f * n;
    const vec3 row{0.0f, static_cast<float>(picture.v) + 0.5f, static_cast<float>(picture.w) + 0.5f};
    const vec3 points[] = {world_point(picture, row + vec3(std::max(middle - half, 0.0f), 0.0f, 0.0f)),
                           world_point(picture, row + vec3(std::min(middle + half, n), 0.0f, 0.0f)), picture.ray.origin,
                           picture.ray.target};
    OrbitCamera camera;
    camera.focal_point = 0.5f * (points[0] + points[1]);
    const vec3 along = glm::normalize(vec3(picture.world_from_voxels[0]));
    const bool upright = std::hypot(along.x, along.z) < 0.05f;
    const float across_deg = upright ? 0.0f : glm::degrees(std::atan2(-along.z, along.x));
    camera.azimuth_deg = std::remainder(across_deg - 14.0f, 360.0f);
    camera.elevation_deg = 24.0f;
    const ViewCamera view = view_camera(camera, size);
    camera.distance_m = fitting_distance_m(view, camera.focal_point, points, {0.84f, 0.72f});
    return camera;
}

ImageRgba8 render_solid(VoxelRowView& view, const VoxelRowPicture& picture, const ViewState& state, ImageSize size,
                        int samples_per_axis) {
    VoxelRowView::Objects& objects = *view.objects;
    const ImageSize drawn_size{size.width * samples_per_axis, size.height * samples_per_axis};
    const ViewCamera camera = view_camera(shown_camera(picture, state, size), drawn_size);
    const Cut cut = cut_away(picture, state, camera.forward);
    const CutPlane plane = cut_plane(picture, cut);
    make_pieces(objects, picture, state, cut);
    make_moving(objects, picture, state, camera.forward);

    objects.cut->SetOrigin(plane.origin.x, plane.origin.y, plane.origin.z);
    objects.cut->SetNormal(plane.normal.x, plane.normal.y, plane.normal.z);
    set_camera(*objects.renderer->GetActiveCamera(), camera, drawn_bounds(picture));
    DrawnPixels drawn = draw(*objects.window, drawn_size);
    const vec3 voxel_m = voxel_size_m(picture);
    ink_outlines(drawn, 1.5f * std::max({voxel_m.x, voxel_m.y, voxel_m.z}), palette(state.theme).ink,
                 state.theme == Theme::dark ? 0.25f : 0.35f);
    return reduced(drawn.colour, samples_per_axis);
}

ImageRgba8 render(VoxelRowView& view, const VoxelRowPicture& picture, const ViewState& state, ImageSize size,
                  int samples_per_axis, float text_scale) {
    ImageRgba8 solid = render_solid(view, picture, state, size, samples_per_axis);
    if (state.theme != Theme::print) solid = over_page(solid, palette(state.theme).page);
    Canvas canvas = make_picture_canvas(solid);
    draw_voxel_row_marks(canvas, picture, state, size, text_scale, MarksKey::in_corner);
    return finished_picture(canvas);
}

namespace {

/// The nearest voxel of the box or of the row that is drawn along a line of sight in the world.
std::optional<MetVoxel> met_voxel(const VoxelRowPicture& picture, const ViewState& state, const VoxelBox& drawn,
                                  vec3 eye, vec3 sight) {
    const mat4 voxels_from_world = glm::inverse(picture.world_from_voxels);
    const vec3 origin(voxels_from_world * vec4(eye, 1.0f)), direction(voxels_from_world * vec4(sight, 0.0f));
    std::optional<MetVoxel> met;
    if (state.voxels) met = first_set_voxel(picture, drawn, origin, direction);
    for (int u = 0; state.row && u < picture.resolution; ++u) {
        const ivec3 cell{u, picture.v, picture.w};
        if (!is_set(picture, cell)) continue;
        const CellBox box = row_cell(picture, u, state.extent);
        const auto distance = entry(box.low, box.high, origin, direction);
        if (distance && (!met || *distance < met->distance)) met = MetVoxel{cell, *distance};
    }
    return met;
}

}  // namespace

std::optional<ivec3> pick(const VoxelRowPicture& picture, const ViewState& state, ImageSize size, vec2 pixel) {
    const ViewCamera camera = view_camera(shown_camera(picture, state, size), size);
    const vec3 sight = direction_through(camera, pixel);
    const auto met = met_voxel(picture, state, cut_away(picture, state, camera.forward).box, camera.position, sight);
    if (!met) return std::nullopt;
    for (const ObjectPicture& object : picture.objects) {
        if (!object.rows) continue;
        const VoxelBox drawn = object_box(*object.rows, state, camera.forward);
        const auto before = met_voxel(*object.rows, state, drawn, camera.position, sight);
        if (before && before->distance < met->distance) return std::nullopt;
    }
    return met->voxel;
}

}  // namespace sightlines
