#include "visualizers/inside_view.h"

#include <gtest/gtest.h>

#include "tests/visualizers/visualizer_testing.h"
#include "visualizers/lit_marks.h"
#include "visualizers/view_camera.h"

namespace sightlines {
namespace {

constexpr ImageSize view_size{320, 240};

TraceGeometry ray_of(const VoxelRowPicture& picture) {
    return {"ray", TraceShape::segment, {picture.ray.origin, picture.ray.target}};
}

/// Pixels that differ, and the largest distance of one of them from the geometry.
struct Difference {
    std::size_t pixels = 0;
    float farthest = 0.0f;
};

Difference difference(const ImageRgba8& a, const ImageRgba8& b, const ViewCamera& camera,
                      const std::vector<TraceGeometry>& geometry) {
    Difference found;
    for (int y = 0; y < a.size.height; ++y)
        for (int x = 0; x < a.size.width; ++x) {
            if (a.at(x, y) == b.at(x, y)) continue;
            ++found.pixels;
            float nearest = 1e9f;
            for (const TraceGeometry& piece : geometry)
                nearest = std::min(nearest, distance_pixels(camera, piece, vec2(x, y) + 0.5f).value_or(1e9f));
            found.farthest = std::max(found.farthest, nearest);
        }
    return found;
}

TEST(InsideView, LightsWhatAStepTouchesAndNothingElse) {
    InsideView view;
    const VoxelRowPicture rows = furnished_picture();
    const InsidePicture picture = rows;
    ViewState state;
    state.labels = false;
    const ViewCamera camera = view_camera(shown_camera(picture, state, view_size), view_size);
    const std::vector<TraceGeometry> lit{{"edge", TraceShape::segment, {{3.0f, 4.0f, 8.0f}, {12.0f, 4.0f, 8.0f}}},
                                         {"midpoint", TraceShape::point, {{8.0f, 12.0f, 8.0f}}}};
    const ImageRgba8 plain = render(view, picture, state, {}, view_size, 1, 1.0f);
    const ImageRgba8 step = render(view, picture, state, {lit, {}}, view_size, 1, 1.0f);
    const Difference drawn = difference(plain, step, camera, lit);
    EXPECT_GT(drawn.pixels, 50u);
    EXPECT_LE(drawn.farthest, 9.0f);
}

TEST(InsideView, LightsWhatIsPointedAtMoreStronglyAndNamesIt) {
    InsideView view;
    const InsidePicture picture = furnished_picture();
    const ViewState state;
    const std::vector<TraceGeometry> lit{ray_of(furnished_picture())};
    const ViewCamera camera = view_camera(shown_camera(picture, state, view_size), view_size);
    const ImageRgba8 plain = render(view, picture, state, {}, view_size, 1, 1.0f);
    const ImageRgba8 step = render(view, picture, state, {lit, {}}, view_size, 1, 1.0f);
    const ImageRgba8 pointed = render(view, picture, state, {{}, lit}, view_size, 1, 1.0f);
    EXPECT_GT(difference(plain, pointed, camera, lit).pixels, 2 * difference(plain, step, camera, lit).pixels);
}

TEST(InsideView, DrawsTheSameWhateverWasDrawnBefore) {
    InsideView view, fresh;
    const InsidePicture picture = furnished_picture();
    const InsidePicture other = small_picture({{5, 8, 8}, {5, 2, 2}});
    ViewState dark;
    dark.theme = Theme::dark;
    render(view, picture, {}, {}, view_size, 1, 1.0f);
    render(view, other, {}, {}, view_size, 1, 1.0f);
    render(view, other, dark, {}, view_size, 1, 1.0f);
    render(view, other, dark, {}, {200, 100}, 1, 1.0f);
    render(view, other, dark, {}, view_size, 2, 1.0f);
    EXPECT_EQ(render(view, picture, {}, {}, view_size, 1, 1.0f), render(fresh, picture, {}, {}, view_size, 1, 1.0f));
}

TEST(InsideView, DrawsAsTheTechniquesOwnView) {
    InsideView view;
    VoxelRowView own;
    const VoxelRowPicture rows = furnished_picture();
    EXPECT_EQ(render(view, rows, {}, {}, view_size, 2, 1.0f), render(own, rows, {}, view_size, 2, 1.0f));
}

TEST(InsideView, FindsARecordedLineNearItsProjection) {
    const VoxelRowPicture rows = furnished_picture();
    const InsidePicture picture = rows;
    const ViewState state;
    const std::vector<TraceGeometry> recorded{
        ray_of(rows), {"voxelization", TraceShape::box, {{}, {16, 0, 0}, {0, 16, 0}, {0, 0, 16}}}};
    const ViewCamera camera = view_camera(shown_camera(picture, state, view_size), view_size);
    const vec2 from(*projected(camera, rows.ray.origin)), to(*projected(camera, rows.ray.target));
    const vec2 across = glm::normalize(vec2(from.y - to.y, to.x - from.x));
    for (const float off : {-5.0f, 0.0f, 5.0f})
        EXPECT_EQ(pick(picture, state, recorded, view_size, 0.4f * from + 0.6f * to + off * across).geometry, "ray");
    for (const float off : {-8.0f, 8.0f})
        EXPECT_NE(pick(picture, state, recorded, view_size, 0.4f * from + 0.6f * to + off * across).geometry, "ray");
}

TEST(InsideView, FindsAPointOnALineBeforeTheLine) {
    const VoxelRowPicture rows = furnished_picture();
    const std::vector<TraceGeometry> recorded{
        ray_of(rows), {"midpoint", TraceShape::point, {0.5f * (rows.ray.origin + rows.ray.target)}}};
    const ViewCamera camera = view_camera(shown_camera(InsidePicture(rows), {}, view_size), view_size);
    const vec2 at(*projected(camera, recorded[1].points[0]));
    EXPECT_EQ(pick(rows, {}, recorded, view_size, at + vec2(2.0f, 1.0f)).geometry, "midpoint");
}

TEST(InsideView, NamesTheRowAndItsExtentByTheirVoxels) {
    const VoxelRowPicture rows = furnished_picture();
    const ViewCamera camera = view_camera(shown_camera(InsidePicture(rows), {}, view_size), view_size);
    const auto picked = [&](int u) {
        const vec3 middle = world_point(rows, vec3(static_cast<float>(u) + 0.5f, 8.5f, 8.5f));
        return pick(rows, {}, {}, view_size, vec2(*projected(camera, middle)));
    };
    EXPECT_EQ(picked(6).voxel, ivec3(6, 8, 8));
    EXPECT_EQ(picked(6).geometry, "extent");
    EXPECT_EQ(picked(14).geometry, "row");
}

TEST(InsideView, FindsNothingInTheVoid) {
    const PickedInside picked = pick(small_picture({{5, 8, 8}}), {}, {}, view_size, {2.0f, 2.0f});
    EXPECT_FALSE(picked.voxel);
    EXPECT_EQ(picked.geometry, "");
}

}  // namespace
}  // namespace sightlines
