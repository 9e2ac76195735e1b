#include "visualizers/ray_view.h"

#include <gtest/gtest.h>

#include "tests/visualizers/visualizer_testing.h"
#include "visualizers/figure.h"
#include "visualizers/inside_view.h"
#include "visualizers/mask_merging.h"
#include "visualizers/theme.h"
#include "visualizers/view_camera.h"

namespace sightlines {
namespace {

constexpr ImageSize view_size{320, 240};

/// A ray along x, and cells before and behind it as the automatic camera sees them.
RayPicture picture_with(std::vector<ValuedBox> boxes) {
    RayPicture picture;
    picture.ray = {{0.0f, 2.0f, 0.0f}, {10.0f, 2.0f, 0.0f}};
    picture.boxes = std::make_shared<const std::vector<ValuedBox>>(std::move(boxes));
    picture.boxes_title = "cells";
    return picture;
}

const ValuedBox in_front{{{3.0f, 1.0f, 1.0f}, {7.0f, 3.0f, 3.0f}}, 0.0f};
const ValuedBox behind{{{3.0f, 1.0f, -3.0f}, {7.0f, 3.0f, -1.0f}}, 1.0f};

ViewState cells_only() {
    ViewState state;
    state.ray = state.row = state.labels = false;
    return state;
}

PictureMap map_of(int side, std::optional<ivec2> asked) {
    PictureMap map{"+X", ivec2(side), std::vector<float>(static_cast<std::size_t>(side * side), 0.0f), asked};
    map.values.front() = 1.0f;
    return map;
}

TEST(RayView, CutsAwayTheCellsBetweenTheEyeAndTheRay) {
    RayView view;
    const auto drawn = [&](const RayPicture& picture, CutAway cut) {
        ViewState state = cells_only();
        state.cut_away = cut;
        return pixels_drawn(render_solid(view, picture, state, view_size, 1));
    };
    EXPECT_EQ(drawn(picture_with({in_front}), CutAway::to_row), 0u);
    EXPECT_GT(drawn(picture_with({in_front}), CutAway::none), 500u);
    EXPECT_GT(drawn(picture_with({behind}), CutAway::to_row), 500u);
}

TEST(RayView, ShowsCellsFromPaleToStrong) {
    RayView view;
    const ViewState state = cells_only();
    ValuedBox pale = behind;
    pale.value = 0.0f;
    const auto strong_pixels = [&](const ValuedBox& box) {
        std::size_t warm = 0;
        for (const glm::u8vec4 p : render_solid(view, picture_with({box}), state, view_size, 1).pixels)
            warm += p.a > 200 && p.r > p.b + 60;
        return warm;
    };
    EXPECT_GT(strong_pixels(behind), 500u);
    EXPECT_EQ(strong_pixels(pale), 0u);
}

TEST(RayView, DrawsPatchesOnTheSpherePastTheCut) {
    RayView view;
    RayPicture picture = picture_with({});
    picture.patches.push_back(
        {{vec3{3.0f, 1.0f, 1.0f}, {7.0f, 1.0f, 1.0f}, {7.0f, 3.0f, 1.0f}, {3.0f, 3.0f, 1.0f}}, 1.0f});
    EXPECT_GT(pixels_drawn(render_solid(view, picture, cells_only(), view_size, 1)), 500u);
    picture.patches.clear();
    EXPECT_EQ(pixels_drawn(render_solid(view, picture, cells_only(), view_size, 1)), 0u);
}

TEST(RayView, PutsTheWholeRayIntoThePicture) {
    for (const Segment ray : {Segment{{0, 0, 0}, {10, 0, 0}}, Segment{{0, 0, 0}, {0, 7, 0}},
                              Segment{{5, 1, 2}, {5, 1, 2}}, Segment{{1e5f, 0, 0}, {0, 1e5f, 3}}}) {
        RayPicture picture;
        picture.ray = ray;
        const ViewCamera camera = view_camera(shown_camera(picture, {}, view_size), view_size);
        for (const vec3 end : {ray.origin, ray.target}) {
            const auto at = projected(camera, end);
            ASSERT_TRUE(at.has_value());
            EXPECT_TRUE(at->x > 0.0f && at->x < 320.0f && at->y > 0.0f && at->y < 240.0f);
        }
    }
}

TEST(RayView, DrawsTheSameWhateverWasDrawnBefore) {
    InsideView view, fresh;
    const InsidePicture picture = picture_with({in_front, behind});
    RayPicture other = picture_with({behind});
    other.maps.push_back(map_of(4, ivec2(1, 2)));
    ViewState dark;
    dark.theme = Theme::dark;
    render(view, picture, {}, {}, view_size, 1, 1.0f);
    render(view, other, dark, {}, view_size, 1, 1.0f);
    render(view, furnished_picture(), dark, {}, view_size, 1, 1.0f);
    EXPECT_EQ(render(view, picture, {}, {}, view_size, 1, 1.0f), render(fresh, picture, {}, {}, view_size, 1, 1.0f));
}

TEST(RayView, ShowsMapsBelowWithTheTexelThatWasAsked) {
    InsideView view;
    RayPicture picture = picture_with({behind});
    EXPECT_EQ(map_panel_height(picture, vec2(640.0f, 480.0f), 12.0f), 0.0f);
    picture.maps = {map_of(8, ivec2(6, 6)), map_of(8, std::nullopt)};
    const float panel = map_panel_height(picture, vec2(640.0f, 480.0f), 12.0f);
    ASSERT_GT(panel, 100.0f);
    const auto marks = [&](const RayPicture& shown) {
        return pixels_near(render(view, shown, {}, {}, {640, 480}, 1, 1.0f), palette(Theme::light).pointed, 12);
    };
    EXPECT_GT(marks(picture), 20u);
    picture.maps.front().asked.reset();
    EXPECT_EQ(marks(picture), 0u);
}

TEST(RayView, IsAFigureWithVerdictLegendAndMaps) {
    RayView view;
    RayPicture picture = picture_with({behind});
    picture.blocked = true;
    picture.truly_blocked = false;
    picture.end_name = "environment";
    picture.maps = {map_of(8, ivec2(6, 6))};
    const auto bytes = ray_figure(view, picture, {}, CanvasFormat::svg, {.dpi = 72.0f});
    const std::string svg(bytes.begin(), bytes.end());
    for (const char* const label :
         {"BLOCKED", "Wrong: by Embree the ray is open.", "cells", "surface point", "environment", "+X"})
        EXPECT_NE(svg.find(">" + std::string(label) + "<"), std::string::npos) << label;
}

TEST(RayView, PicksTheNearestCellThatIsDrawnUnderThePixel) {
    const RayPicture picture = picture_with({{in_front.box, 0.0f, {1, 2, 3}}, {behind.box, 0.0f, {4, 5, 6}}});
    const ViewCamera camera = view_camera(shown_camera(picture, {}, view_size), view_size);
    const vec2 middle(*projected(camera, behind.box.centre()));
    EXPECT_EQ(pick(picture, {}, {}, view_size, middle).voxel, ivec3(4, 5, 6)) << "what is cut away is not picked";
    ViewState whole;
    whole.cut_away = CutAway::none;
    const vec2 before(*projected(camera, in_front.box.centre()));
    EXPECT_EQ(pick(picture, whole, {}, view_size, before).voxel, ivec3(1, 2, 3));
    EXPECT_EQ(pick(picture, whole, {}, view_size, {2.0f, 2.0f}).voxel, std::nullopt);
    whole.voxels = false;
    EXPECT_EQ(pick(picture, whole, {}, view_size, before).voxel, std::nullopt);
}

TEST(RayView, StepsThroughTheMergingOfACellsSamples) {
    RayPicture picture = picture_with({});
    picture.cell = in_front.box;
    picture.samples = std::make_shared<const std::vector<CellSample>>(std::vector<CellSample>{
        {{4, 2, 2}, {0, 1, 0}, {1, 0, 0, 0}, {0, 1, 0, 0}}, {{5, 2, 2}, {0, 1, 0}, {0, 0, 1, 0}, {0, 1, 0, 0}}});
    for (int k = 0; k < 4; ++k) picture.maps.push_back(map_of(2, ivec2(0, 0)));
    const auto at = [&](int merged) { return merged_until(picture, merged); };
    using Values = std::vector<float>;
    EXPECT_EQ(at(1).maps[0].values, (Values{1, 0, 0, 0}));
    EXPECT_EQ(at(1).maps[2].values, (Values{1, 0, 0, 0}));
    EXPECT_EQ(at(2).maps[0].values, (Values{0, 0, 1, 0}));
    EXPECT_EQ(at(2).maps[2].values, (Values{1, 0, 1, 0}));
    EXPECT_EQ(at(2).maps[3].values, (Values{0, 1, 0, 0}));
    EXPECT_EQ(at(1).patches.size(), 2u);
    EXPECT_EQ(at(2).patches.size(), 3u);
    EXPECT_EQ(at(2).marked.size(), 1u);
    EXPECT_EQ(at(99).maps[2].title, "2 of 2 merged: visible");
    InsideView view;
    ViewState first;
    first.merged_samples = 1;
    const ImageRgba8 earlier = render(view, picture, first, {}, view_size, 1, 1.0f);
    EXPECT_NE(render(view, picture, {}, {}, view_size, 1, 1.0f), earlier);
    EXPECT_EQ(render(view, picture, first, {}, view_size, 1, 1.0f), earlier);
}

TEST(RayView, FindsNoCellUnderThePanelOfMaps) {
    RayPicture picture = picture_with({behind});
    picture.maps = {map_of(8, ivec2(6, 6))};
    const std::vector<TraceGeometry> recorded{{"ray", TraceShape::segment, {picture.ray.origin, picture.ray.target}}};
    EXPECT_EQ(pick(picture, {}, recorded, {640, 480}, {320.0f, 475.0f}).geometry, "");
    const float panel = map_panel_height(picture, vec2(640.0f, 480.0f), 12.0f);
    const ImageSize in_space{640, 480 - static_cast<int>(panel)};
    const ViewCamera camera = view_camera(shown_camera(picture, {}, in_space), in_space);
    const vec2 middle(*projected(camera, 0.5f * (picture.ray.origin + picture.ray.target)));
    EXPECT_EQ(pick(picture, {}, recorded, {640, 480}, middle).geometry, "ray");
}

}  // namespace
}  // namespace sightlines
