#include "visualizers/voxel_row_view.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>

#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkPlane.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkUnsignedCharArray.h>

#include "visualizers/canvas.h"
#include "visualizers/offscreen_window.h"
#include "visualizers/raster.h"
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
    VoxelBox box{};
    CutPlane cut{};
    int v = -1, w = -1, first = 0, last = 0;
    Theme theme = Theme::light;
    bool mark_extent = false;

    bool operator==(const MadeFrom&) const = default;
};

struct Piece {
    vtkNew<vtkPolyDataMapper> mapper;
    vtkNew<vtkActor> actor;
    MadeFrom made_from;

    Piece() {
        mapper->SetColorModeToDirectScalars();
        actor->SetMapper(mapper);
        actor->GetProperty()->LightingOff();  // lit when made
    }
};

vtkSmartPointer<vtkPolyData> poly_data(const ColouredTriangles& from) {
    vtkNew<vtkFloatArray> positions;
    positions->SetNumberOfComponents(3);
    positions->SetNumberOfTuples(static_cast<vtkIdType>(from.positions.size()));
    std::memcpy(positions->GetPointer(0), from.positions.data(), from.positions.size() * sizeof(vec3));
    vtkNew<vtkPoints> points;
    points->SetData(positions);
    vtkNew<vtkUnsignedCharArray> colours;
    colours->SetNumberOfComponents(3);
    colours->SetNumberOfTuples(static_cast<vtkIdType>(from.colours.size()));
    std::memcpy(colours->GetPointer(0), from.colours.data(), from.colours.size() * sizeof(glm::u8vec3));
    vtkNew<vtkCellArray> cells;
    cells->AllocateExact(static_cast<vtkIdType>(from.triangles.size()),
                         3 * static_cast<vtkIdType>(from.triangles.size()));
    for (const uvec3& triangle : from.triangles) {
        cells->InsertNextCell(3);
        for (int i = 0; i < 3; ++i) cells->InsertCellPoint(triangle[i]);
    }
    auto data = vtkSmartPointer<vtkPolyData>::New();
    data->SetPoints(points);
    data->SetPolys(cells);
    data->GetPointData()->SetScalars(colours);
    return data;
}

template <class Make>
void keep_made(Piece& piece, bool visible, MadeFrom from, const Make& make) {
    piece.actor->SetVisibility(visible);
    if (!visible || piece.made_from == from) return;
    piece.mapper->SetInputData(poly_data(make()));
    piece.made_from = std::move(from);
}

/// The distance from which every point falls within `part` of the picture's half width and half height.
float fitting_distance_m(const ViewCamera& camera, vec3 focal_point, std::span<const vec3> points, vec2 part) {
    const vec2 slope = part * 0.5f * vec2(camera.size.width, camera.size.height) / camera.pixels_per_slope;
    float distance_m = 0.0f;
    for (const vec3& point : points) {
        const vec3 offset = point - focal_point;
        const float behind_m = glm::dot(offset, camera.forward);
        distance_m = std::max({distance_m, std::abs(glm::dot(offset, camera.right)) / slope.x - behind_m,
                               std::abs(glm::dot(offset, camera.up)) / slope.y - behind_m});
    }
    return distance_m;
}

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

void set_camera(vtkCamera& camera, const ViewCamera& view, const Box3& bounds) {
    const float centre_m = glm::dot(bounds.centre() - view.position, view.forward);
    const float radius_m = 0.5f * bounds.diagonal();
    const float far_m = std::max(centre_m + radius_m, 1.0f);
    camera.SetPosition(view.position.x, view.position.y, view.position.z);
    const vec3 focal = view.position + view.forward;
    camera.SetFocalPoint(focal.x, focal.y, focal.z);
    camera.SetViewUp(view.up.x, view.up.y, view.up.z);
    camera.SetViewAngle(view_field_of_view_deg);
    camera.SetClippingRange(std::max(centre_m - radius_m, 1e-3f * far_m), far_m);
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

    Objects() {
        renderer->SetBackground(0.0, 0.0, 0.0);
        renderer->SetBackgroundAlpha(0.0);
        for (Piece* const piece : {&scene, &voxels, &row}) renderer->AddActor(piece->actor);
        scene.mapper->AddClippingPlane(cut);
        window->AddRenderer(renderer);
    }
};

namespace {

void make_pieces(VoxelRowView::Objects& objects, const VoxelRowPicture& picture, const ViewState& state,
                 const Cut& cut) {
    const Palette colours = palette(state.theme);
    const CutPlane plane = cut_plane(picture, cut);
    const bool has_scene = picture.scene && !picture.scene->triangles.empty();
    keep_made(objects.scene, state.scene && has_scene, {.content = picture.scene, .cut = plane, .theme = state.theme},
              [&] { return ghost_triangles(*picture.scene, plane, colours); });
    keep_made(objects.voxels, state.voxels && !cut.box.empty(),
              {.content = picture.occupied,
               .world_from_voxels = picture.world_from_voxels,
               .box = cut.box,
               .theme = state.theme},
              [&] { return voxel_triangles(picture, cut.box, colours); });
    keep_made(objects.row, state.row,
              {.content = picture.occupied,
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

std::optional<ivec3> pick(const VoxelRowPicture& picture, const ViewState& state, ImageSize size, vec2 pixel) {
    const ViewCamera camera = view_camera(shown_camera(picture, state, size), size);
    const Cut cut = cut_away(picture, state, camera.forward);
    const mat4 voxels_from_world = glm::inverse(picture.world_from_voxels);
    const vec3 origin(voxels_from_world * vec4(camera.position, 1.0f));
    const vec3 direction(voxels_from_world * vec4(direction_through(camera, pixel), 0.0f));
    std::optional<MetVoxel> met;
    if (state.voxels) met = first_set_voxel(picture, cut.box, origin, direction);
    for (int u = 0; state.row && u < picture.resolution; ++u) {
        const ivec3 cell{u, picture.v, picture.w};
        if (!is_set(picture, cell)) continue;
        const CellBox box = row_cell(picture, u, state.extent);
        const auto distance = entry(box.low, box.high, origin, direction);
        if (distance && (!met || *distance < met->distance)) met = MetVoxel{cell, *distance};
    }
    return met ? std::optional(met->voxel) : std::nullopt;
}

}  // namespace sightlines
