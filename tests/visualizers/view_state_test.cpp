#include <gtest/gtest.h>

#include "visualizers/view_camera.h"
#include "visualizers/view_state.h"

namespace sightlines {
namespace {

const OrbitCamera shown{
    .focal_point = {1.0f, 2.0f, 3.0f}, .azimuth_deg = 30.0f, .elevation_deg = 20.0f, .distance_m = 10.0f};

TEST(ViewState, TurningStartsFromTheCameraThatIsShown) {
    const ViewState turned_state = turned({}, shown, {15.0f, -5.0f});
    ASSERT_TRUE(turned_state.camera);
    EXPECT_FLOAT_EQ(turned_state.camera->azimuth_deg, 15.0f);
    EXPECT_FLOAT_EQ(turned_state.camera->elevation_deg, 15.0f);
    EXPECT_EQ(turned_state.camera->focal_point, shown.focal_point);
}

TEST(ViewState, TurningBackGivesTheSameView) {
    const ViewState there = turned({}, shown, {40.0f, 10.0f});
    const ViewState back = turned(there, *there.camera, {-40.0f, -10.0f});
    EXPECT_NEAR(back.camera->azimuth_deg, shown.azimuth_deg, 1e-4);
    EXPECT_NEAR(back.camera->elevation_deg, shown.elevation_deg, 1e-4);
}

TEST(ViewState, TurningNeverGoesOverThePole) {
    EXPECT_LE(turned({}, shown, {0.0f, 500.0f}).camera->elevation_deg, 89.0f);
    EXPECT_GE(turned({}, shown, {0.0f, -500.0f}).camera->elevation_deg, -89.0f);
}

TEST(ViewState, ZoomingHalvesTheDistance) { EXPECT_FLOAT_EQ(zoomed({}, shown, 2.0f).camera->distance_m, 5.0f); }

TEST(ViewState, PanningMovesThePointUnderTheMouseByTheDrag) {
    const ImageSize size{640, 480};
    const vec2 drag{50.0f, -30.0f};
    const auto before = projected(view_camera(shown, size), shown.focal_point);
    const ViewState moved = panned({}, shown, drag, size.height);
    const auto after = projected(view_camera(*moved.camera, size), shown.focal_point);
    ASSERT_TRUE(before && after);
    EXPECT_NEAR(after->x - before->x, drag.x, 0.01);
    EXPECT_NEAR(after->y - before->y, drag.y, 0.01);
}

TEST(ViewState, ReframingForgetsTheCameraAndKeepsWhatIsShown) {
    ViewState state = turned({}, shown, {5.0f, 5.0f});
    state.scene = false;
    const ViewState reset = reframed(state);
    EXPECT_FALSE(reset.camera);
    EXPECT_FALSE(reset.scene);
}

TEST(ViewState, SlicingKeepsTheLengthAndStaysInside) {
    ViewState state;
    state.slice_first = 4;
    state.slice_last = 7;
    EXPECT_EQ(sliced(state, 3, 16).slice_first, 7);
    EXPECT_EQ(sliced(state, 3, 16).slice_last, 10);
    EXPECT_EQ(sliced(state, 100, 16).slice_first, 12);
    EXPECT_EQ(sliced(state, 100, 16).slice_last, 15);
    EXPECT_EQ(sliced(state, -100, 16).slice_first, 0);
}

TEST(ViewState, EqualStatesCompareEqualAndAnyEditShows) {
    EXPECT_EQ(ViewState{}, ViewState{});
    EXPECT_NE(ViewState{}, zoomed({}, shown, 1.0f));
    EXPECT_NE(ViewState{}, sliced({}, 0, 16));
}

TEST(ViewCamera, TheDirectionThroughAProjectedPointLeadsToThePoint) {
    const ViewCamera camera = view_camera(shown, {800, 500});
    for (const vec3 point : {vec3(0.0f), vec3(2.0f, 1.0f, 4.0f), vec3(-0.5f, 3.0f, 2.0f)}) {
        const auto at = projected(camera, point);
        ASSERT_TRUE(at);
        const vec3 towards = glm::normalize(point - camera.position);
        EXPECT_NEAR(glm::dot(direction_through(camera, vec2(*at)), towards), 1.0, 1e-6);
    }
}

TEST(ViewCamera, PointsBehindTheEyeAreNotProjected) {
    const ViewCamera camera = view_camera(shown, {800, 500});
    EXPECT_FALSE(projected(camera, camera.position - camera.forward));
    EXPECT_FALSE(projected_segment(camera, camera.position - camera.forward, camera.position - 2.0f * camera.forward));
    EXPECT_TRUE(projected_segment(camera, camera.position - camera.forward, camera.position + camera.forward));
}

}  // namespace
}  // namespace sightlines
