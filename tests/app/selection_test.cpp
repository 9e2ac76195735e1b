#include "app/selection.h"

#include <gtest/gtest.h>

#include "techniques/base/error.h"

namespace sightlines {
namespace {

Session compared_session(const std::string& scene) {
    Session session;
    session.scene = scene;
    session.size = {24, 16};
    session.lights.count = scene == "trees" ? 0 : 40;
    session.backend = BackendChoice::cpu;
    session.reference = true;
    session.parameters["voxel_rows"] = {{"resolution", 64.0}, {"angle_step", 6.0}};
    return session;
}

TEST(PixelRays, AreTheVerdictsOfThePictureAndOfTheReference) {
    for (const std::string scene : {"cornell", "trees"}) {
        Results results(0, Backend::cpu);
        Progress progress;
        Session session = compared_session(scene);
        const auto picture = results.picture(session, progress);
        const auto reference = results.reference(session, progress);
        const auto surfaces = results.surfaces(session, progress);
        std::size_t rows = 0, blocked = 0, wrong = 0;
        for (int y = 0; y < session.size.height; y += 3)
            for (int x = 0; x < session.size.width; x += 2) {
                const auto pixel = static_cast<std::size_t>(y * session.size.width + x);
                if (picture->value.rays_asked.pixels[pixel] == 0) continue;
                session.selection.pixel = ivec2(x, y);
                const PixelRays rays = pixel_rays(session, results, progress);
                EXPECT_EQ(rays.rows.size(), picture->value.rays_asked.pixels[pixel]);
                for (const RayRow& row : rays.rows) {
                    EXPECT_EQ(row.blocked, picture->value.verdicts.blocked(pixel, row.light));
                    EXPECT_EQ(row.truly_blocked, reference->value.verdicts.blocked(pixel, row.light));
                    EXPECT_GT(row.distance_m, 0.0f);
                    EXPECT_LE(row.distance_m, 2.0f * results.scene(session, progress)->value.bounds.diagonal());
                    blocked += row.blocked;
                    wrong += row.wrong();
                }
                rows += rays.rows.size();
            }
        EXPECT_GT(blocked, 0u) << scene;
        EXPECT_LT(blocked, rows) << scene;
        EXPECT_GT(wrong, 0u) << scene << ": the two verdicts would be told apart by nothing";
    }
}

TEST(PixelRays, LeadToTheFirstThatIsWrongElseBlockedElseFirst) {
    Results results(0, Backend::cpu);
    Progress progress;
    Session session = compared_session("cornell");
    session.selection.pixel = ivec2(12, 14);
    PixelRays rays = pixel_rays(session, results, progress);
    ASSERT_GE(rays.rows.size(), 6u);
    for (RayRow& row : rays.rows) row.blocked = row.truly_blocked = false;
    EXPECT_EQ(select_ray(session, rays, results, progress).light, rays.rows[0].light);
    rays.rows[3].blocked = rays.rows[3].truly_blocked = true;
    EXPECT_EQ(select_ray(session, rays, results, progress).light, rays.rows[3].light);
    rays.rows[5].truly_blocked = true;
    EXPECT_EQ(select_ray(session, rays, results, progress).light, rays.rows[5].light);
    session.selection.light = rays.rows[1].light;
    EXPECT_EQ(select_ray(session, rays, results, progress).light, rays.rows[1].light);
}

TEST(PixelRays, AreRefusedOutsideThePictureAndWhereNothingIsAsked) {
    Results results(0, Backend::cpu);
    Progress progress;
    Session session = compared_session("cornell");
    session.selection.pixel = ivec2(24, 0);
    EXPECT_THROW(pixel_rays(session, results, progress), InputError);
    session.selection.pixel = ivec2(12, 14);
    session.selection.light = 40;
    EXPECT_THROW(select_ray(session, results, progress), InputError);
    EXPECT_NO_THROW(pixel_rays(session, results, progress));
}

TEST(PixelRays, StopWhenTheyAreCancelled) {
    Results results(0, Backend::cpu);
    Progress progress, cancelled;
    const Session session = compared_session("cornell");
    pixel_rays(session, results, progress);
    cancelled.cancel();
    EXPECT_THROW(pixel_rays(session, results, cancelled), Cancelled);
}

}  // namespace
}  // namespace sightlines
