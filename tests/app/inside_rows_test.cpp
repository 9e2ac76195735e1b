// The view inside of voxel rows, from a session to its pixels.
#include <algorithm>

#include <gtest/gtest.h>

#include "app/inside.h"
#include "techniques/base/error.h"
#include "tests/golden_pictures.h"
#include "visualizers/dictionary_panel.h"

namespace sightlines {
namespace {

/// Quick to build and to ask.
Session small_session(const std::string& scene, const ParameterValues& parameters = {}) {
    Session session;
    session.scene = scene;
    session.size = {96, 54};
    session.lights.count = 8;
    session.backend = BackendChoice::cpu;
    session.parameters["voxel_rows"] = {{"resolution", 32.0}, {"angle_step", 6.0}};
    for (const auto& [name, value] : parameters) session.parameters["voxel_rows"][name] = value;
    return session;
}

struct Made {
    Results results{0, Backend::cpu};
    Progress progress;
    UnpackedVoxels unpacked;

    SelectedRay ray(const Session& session) { return select_ray(session, results, progress); }
    InsidePicture picture(const Session& session, const SelectedRay& ray) {
        return inside_picture(session, ray, results, progress, unpacked);
    }
};

TEST(InsideRows, ShowsTheObjectsThatTheRayWasAskedOfWithTheVerdictOfAll) {
    Made made;
    Session session = small_session("planes", {{"motion", 2.0}});
    int in_the_way = 0, passed = 0;
    for (int k = 0; k < 400 && in_the_way < 3; ++k) {
        session.selection.pixel = ivec2(k * 37 % 96, k * 23 % 54);
        SelectedRay ray;
        try {
            ray = made.ray(session);
        } catch (const InputError&) {
            continue;  // the sky
        }
        const auto picture = std::get<VoxelRowPicture>(made.picture(session, ray));
        ASSERT_EQ(picture.blocked, ray.trace.blocked);
        for (const ObjectPicture& object : picture.objects) {
            ASSERT_EQ(object.bounds.size(), 4u);
            passed += object.rows == nullptr;
            if (!object.blocked) continue;
            ++in_the_way;
            ASSERT_TRUE(object.rows);
            const VoxelRowPicture& rows = *object.rows;
            bool set = false;
            for (int u = rows.first; u <= rows.last; ++u) set = set || is_set(rows, {u, rows.v, rows.w});
            EXPECT_TRUE(set) << "a voxel of the row is in the way";
        }
    }
    EXPECT_GT(in_the_way, 0);
    EXPECT_GT(passed, 0);
}

/// Without text, which depends on the fonts that are installed.
ViewState without_labels() {
    ViewState state;
    state.labels = false;
    return state;
}

TEST(InsideRows, TheSearchForTheFirstHitLooksAsItDid) {
    Made made;
    Session session = small_session("cornell", {{"first_hits", 1.0}});
    session.lights.count = 32;
    const PixelRays rays = pixel_rays(session, made.results, made.progress);
    const auto blocked = std::ranges::find_if(rays.rows, &RayRow::blocked);
    ASSERT_NE(blocked, rays.rows.end());
    session.selection.pixel = rays.pixel;
    session.selection.light = blocked->light;
    const SelectedRay ray = made.ray(session);
    ASSERT_TRUE(ray.trace.blocked);
    LitGeometry lit;
    for (const TraceStep& step : ray.trace.steps)
        if (step.paper.starts_with("Section 7"))
            lit.step.insert(lit.step.end(), step.geometry.begin(), step.geometry.end());
    ASSERT_FALSE(lit.step.empty());
    InsideView view;
    const ImageRgba8 image = render(view, made.picture(session, ray), without_labels(), lit, {360, 240}, 2, 1.0f);
    EXPECT_EQ(unlike_golden(image, "app", "inside-first-hit"), "");
}

TEST(InsideRows, ARowThatTheDictionaryMappedLooksAsItDid) {
    Made made;
    Session session = small_session("cornell", {{"compression", 1.0}, {"dictionary_rows", 1024.0}});
    session.views = {View{"dictionary", {}}};
    const SelectedRay ray = made.ray(session);
    const auto picture = std::get<DictionaryPicture>(made.picture(session, ray));
    ASSERT_FALSE(differing_voxels(picture).empty()) << "a row that is in the dictionary shows nothing";
    InsideView view;
    const ImageSize size{480, 600};
    ImageRgba8 image = render(view, picture, without_labels(), {}, size, 2, 1.0f);
    // What is above the panel, whose text depends on the fonts.
    image.size.height -= static_cast<int>(dictionary_panel_height(vec2(size.width, size.height), 12.0f)) + 1;
    image.pixels.resize(image.size.pixels());
    EXPECT_EQ(unlike_golden(image, "app", "inside-dictionary"), "");
}

}  // namespace
}  // namespace sightlines
