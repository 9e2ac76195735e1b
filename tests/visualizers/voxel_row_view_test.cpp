#include "visualizers/voxel_row_view.h"

#include <gtest/gtest.h>

#include <thread>

#include "techniques/base/error.h"
#include "tests/golden_pictures.h"
#include "visualizer_testing.h"
#include "visualizers/theme.h"
#include "visualizers/view_camera.h"

namespace sightlines {
namespace {

const ImageSize size{480, 320};

TEST(VoxelRowView, DrawsSomethingAndLeavesTheBackgroundClear) {
    VoxelRowView view;
    ViewState state;
    state.scene = false;
    const ImageRgba8 image = render_solid(view, furnished_picture(), state, size, 2);
    ASSERT_EQ(image.size, size);
    EXPECT_GT(pixels_drawn(image), size.pixels() / 20);
    EXPECT_LT(pixels_drawn(image), size.pixels());
}

TEST(VoxelRowView, AnEmptyVoxelizationDrawsNothing) {
    VoxelRowView view;
    EXPECT_EQ(pixels_drawn(render_solid(view, small_picture({}), voxels_only(), size, 1)), 0u);
}

TEST(VoxelRowView, TheSameInputGivesTheSamePixelsWhateverWasDrawnBefore) {
    const VoxelRowPicture picture = furnished_picture();
    VoxelRowView view, fresh;
    const ImageRgba8 first = render(view, picture, {}, size, 2);
    ViewState other;
    other.theme = Theme::dark;
    other.scene = false;
    render(view, small_picture({{1, 2, 3}}), turned(other, shown_camera(picture, {}, size), {33.0f, 9.0f}), {200, 300},
           1);
    EXPECT_EQ(render(view, picture, {}, size, 2), first);
    EXPECT_EQ(render(fresh, picture, {}, size, 2), first);
}

TEST(VoxelRowView, EveryPartOfTheStateChangesThePicture) {
    const VoxelRowPicture picture = furnished_picture();
    VoxelRowView view;
    const ViewState plain;
    const ImageRgba8 before = render(view, picture, plain, size, 1);
    std::vector<ViewState> edits(12, plain);
    edits[0].scene = false;
    edits[1].voxels = false;
    edits[2].row = false;
    edits[3].extent = false;
    edits[4].ray = false;
    edits[5].twin = false;
    edits[6].labels = false;
    edits[7].cut_away = CutAway::none;
    edits[8].slab_voxels = 3;
    edits[9].slice_first = 6;
    edits[10].theme = Theme::dark;
    edits[11] = turned(plain, shown_camera(picture, plain, size), {20.0f, 0.0f});
    for (std::size_t i = 0; i < edits.size(); ++i)
        EXPECT_NE(render(view, picture, edits[i], size, 1), before) << "edit " << i;
}

TEST(VoxelRowView, SetVoxelsOfTheRowAreFilledAndClearOnesOpen) {
    VoxelRowView view;
    ViewState state = voxels_only();
    state.row = true;
    state.extent = true;
    state.voxels = false;
    const VoxelRowPicture all_clear = small_picture({});
    const VoxelRowPicture one_set = small_picture({{7, 8, 8}});
    const ImageRgba8 open = render_solid(view, all_clear, state, size, 2);
    const ImageRgba8 filled = render_solid(view, one_set, state, size, 2);
    // In the middle of the cell's front face there is nothing of an open cell, and the accent colour of a filled one.
    const ViewCamera camera = view_camera(shown_camera(one_set, state, size), size);
    const auto middle = projected(camera, {7.5f, 8.5f, 9.0f});
    ASSERT_TRUE(middle);
    const glm::u8vec4 pixel = filled.at(static_cast<int>(middle->x), static_cast<int>(middle->y));
    EXPECT_EQ(pixel.a, 255);
    EXPECT_GT(pixel.r, pixel.g + 60);
    EXPECT_GT(pixel.g, pixel.b);
    EXPECT_GT(pixels_drawn(filled), pixels_drawn(open) + 100);
}

TEST(VoxelRowView, BitsOutsideTheExtentLookDifferent) {
    VoxelRowView view;
    ViewState state = voxels_only();
    state.row = state.extent = true;
    const VoxelRowPicture kept = small_picture({{7, 8, 8}});
    VoxelRowPicture clipped = kept;
    clipped.first = 9;
    // The same camera for both.
    state.camera = shown_camera(kept, state, size);
    EXPECT_NE(render_solid(view, kept, state, size, 1), render_solid(view, clipped, state, size, 1));
}

TEST(VoxelRowView, ThePickedVoxelIsTheOneDrawnThere) {
    // Each voxel alone is drawn where the pick says it is, and nowhere else.
    const std::vector<ivec3> voxels{{2, 3, 4}, {9, 6, 1}, {12, 1, 6}, {4, 11, 5}, {8, 8, 8}};
    const VoxelRowPicture together = small_picture(voxels);
    ViewState state = voxels_only();
    state.row = true;
    state.camera = shown_camera(together, state, size);
    ViewState bare = state;
    bare.row = false;
    bare.cut_away = CutAway::none;
    VoxelRowView view;
    std::vector<ImageRgba8> alone;
    for (const ivec3& voxel : voxels) alone.push_back(render_solid(view, small_picture({voxel}), bare, size, 1));
    int checked = 0, on_edges = 0;
    for (int y = 0; y < size.height; y += 2)
        for (int x = 0; x < size.width; x += 2) {
            const auto picked = pick(together, bare, size, vec2(x, y) + 0.5f);
            bool any = false;
            for (std::size_t i = 0; i < voxels.size(); ++i) {
                const bool drawn = alone[i].at(x, y).a > 0;
                any |= drawn;
                if (drawn && picked == voxels[i]) ++checked;
                if (picked == voxels[i] && !drawn) ++on_edges;
            }
            on_edges += picked.has_value() != any;
        }
    EXPECT_GT(checked, 200);
    EXPECT_LE(on_edges, 4);  // the rasteriser rounds edges to a fraction of a pixel
}

TEST(VoxelRowView, OfTwoVoxelsInLineTheNearerIsPicked) {
    const VoxelRowPicture picture = small_picture({{8, 8, 3}, {8, 8, 6}});
    ViewState state = voxels_only();
    state.camera =
        OrbitCamera{.focal_point = {8.5f, 8.5f, 8.5f}, .azimuth_deg = 0.0f, .elevation_deg = 0.0f, .distance_m = 60.0f};
    const vec2 middle = 0.5f * vec2(size.width, size.height);
    EXPECT_EQ(pick(picture, state, size, middle), ivec3(8, 8, 6));
    state.camera->azimuth_deg = 180.0f;
    state.cut_away = CutAway::none;
    EXPECT_EQ(pick(picture, state, size, middle), ivec3(8, 8, 3));
    EXPECT_FALSE(pick(picture, state, size, {1.0f, 1.0f}));
}

TEST(VoxelRowView, WhatIsCutAwayIsNotPicked) {
    const VoxelRowPicture picture = small_picture({{8, 8, 12}, {8, 8, 5}});
    ViewState state = voxels_only();
    state.camera =
        OrbitCamera{.focal_point = {8.5f, 8.5f, 8.5f}, .azimuth_deg = 0.0f, .elevation_deg = 0.0f, .distance_m = 60.0f};
    EXPECT_EQ(pick(picture, state, size, 0.5f * vec2(size.width, size.height)), ivec3(8, 8, 5));
}

TEST(VoxelRowView, TheAutomaticCameraShowsTheKeptRowFromLeftToRight) {
    const VoxelRowPicture picture = furnished_picture();
    const ViewCamera camera = view_camera(shown_camera(picture, {}, size), size);
    const auto s = projected(camera, {3.0f, 8.5f, 8.5f}), e = projected(camera, {13.0f, 8.5f, 8.5f});
    ASSERT_TRUE(s && e);
    EXPECT_GT(s->x, 0.0f);
    EXPECT_LT(e->x, static_cast<float>(size.width));
    EXPECT_GT(e->x - s->x, 0.5f * static_cast<float>(size.width));
    EXPECT_GT(std::min(s->y, e->y), 0.0f);
    EXPECT_LT(std::max(s->y, e->y), static_cast<float>(size.height));
}

TEST(VoxelRowView, WorksForUprightRowsAndEmptyExtents) {
    VoxelRowView view;
    VoxelRowPicture upright = furnished_picture();
    upright.world_from_voxels = mat4(vec4(0, 1, 0, 0), vec4(0, 0, 1, 0), vec4(1, 0, 0, 0), vec4(0, 0, 0, 1));
    upright.row_direction = {0.0f, 1.0f, 0.0f};
    upright.ray = {{8.5f, 2.6f, 8.4f}, {8.5f, 13.4f, 8.6f}};
    EXPECT_GT(pixels_drawn(render(view, upright, {}, size, 1)), 0u);
    VoxelRowPicture nothing_kept = furnished_picture();
    nothing_kept.first = 9;
    nothing_kept.last = 8;
    EXPECT_GT(pixels_drawn(render(view, nothing_kept, {}, size, 1)), 0u);
}

TEST(VoxelRowView, SeveralViewsLiveSideBySideEachOnItsThread) {
    const VoxelRowPicture picture = furnished_picture();
    VoxelRowView here;
    const ImageRgba8 expected = render(here, picture, {}, size, 1);
    std::vector<ImageRgba8> elsewhere(2);
    {
        std::vector<std::jthread> threads;
        for (ImageRgba8& image : elsewhere)
            threads.emplace_back([&] {
                VoxelRowView view;
                for (const ImageSize other : {ImageSize{64, 48}, ImageSize{300, 500}, size})
                    image = render(view, picture, {}, other, 1);
            });
    }
    for (const ImageRgba8& image : elsewhere) EXPECT_EQ(image, expected);
    EXPECT_EQ(render(here, picture, {}, size, 1), expected);
}

TEST(VoxelRowViewDeathTest, SaysSoWhereThereIsNoOpenGl) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");  // in a process that has not met EGL yet
    const auto attempt = [] {
        setenv("__EGL_VENDOR_LIBRARY_FILENAMES", "/nonexistent.json", 1);
        try {
            const VoxelRowView view;
        } catch (const EnvironmentError&) {
            std::_Exit(4);
        }
        std::_Exit(0);
    };
    EXPECT_EXIT(attempt(), testing::ExitedWithCode(4), "");
}

TEST(VoxelRowView, LooksAsItDid) {
    VoxelRowView view;
    ViewState state;
    state.labels = false;  // text depends on the fonts that are installed
    const ImageRgba8 image = render(view, furnished_picture(), state, {360, 240}, 2);
    EXPECT_EQ(unlike_golden(image, "visualizers", "voxel-row"), "");
}

}  // namespace
}  // namespace sightlines
