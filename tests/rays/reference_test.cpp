#include "techniques/rays/reference.h"

#include <array>
#include <cmath>
#include <mutex>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/rays/test_scenes.h"

namespace sightlines::test {
namespace {

constexpr float pi = std::numbers::pi_v<float>;

RenderRequest asking(const SurfaceBuffer& surfaces, const std::vector<Light>& lights, int threads = 2) {
    RenderRequest request;
    request.surfaces = &surfaces;
    request.lights = lights;
    request.threads = threads;
    request.keep_verdicts = true;
    return request;
}

RenderResult rendered(const EmbreeScene& embree, const RenderRequest& request) {
    Progress progress;
    return render_reference(embree, request, progress);
}

/// A grey floor seen from above.
struct Floor {
    Scene scene;
    std::shared_ptr<const EmbreeScene> embree;
    SurfaceBuffer surfaces;
};

Floor lit_floor() {
    Material material;
    material.base_color = {0.5f, 0.25f, 0.75f};
    Floor floor{scene_with_material(material), nullptr, {}};
    add_quad(floor.scene, {-10, 0, -10}, {0, 0, 20}, {20, 0, 0});
    floor.embree = built(floor.scene);
    floor.surfaces = seen(floor.scene, *floor.embree, camera_at({0, 6, 0.1f}, vec3(0.0f)), {45, 31});
    return floor;
}

/// Radiance must be `irradiance(position)` times albedo over pi everywhere.
template <class Irradiance>
void expect_lambert(const Floor& floor, const RenderResult& result, const Irradiance& irradiance) {
    for (std::size_t p = 0; p < floor.surfaces.size.pixels(); ++p) {
        const float expected = irradiance(floor.surfaces.position[p]) / pi;
        const float tolerance = 1e-5f + 1e-4f * expected;
        ASSERT_NEAR(result.radiance.pixels[p].r, 0.5f * expected, tolerance);
        ASSERT_NEAR(result.radiance.pixels[p].g, 0.25f * expected, tolerance);
        ASSERT_NEAR(result.radiance.pixels[p].b, 0.75f * expected, tolerance);
        ASSERT_EQ(result.shadow.pixels[p], 0.0f);
    }
}

TEST(Reference, APointLightGivesIntensityTimesCosineOverSquaredDistance) {
    const Floor floor = lit_floor();
    const std::vector<Light> lights{point_light({0.5f, 2.0f, -0.25f}, vec3(7.0f))};
    const RenderResult result = rendered(*floor.embree, asking(floor.surfaces, lights));
    expect_lambert(floor, result, [&](vec3 position) {
        const float distance = glm::distance(position, lights[0].position);
        return 7.0f * 2.0f / (distance * distance * distance);
    });
    EXPECT_EQ(result.rays, floor.surfaces.size.pixels());
    EXPECT_EQ(result.rays_traced, result.rays);
}

TEST(Reference, ADirectionalLightGivesItsIrradianceTimesTheCosineEverywhere) {
    const Floor floor = lit_floor();
    Light sun;
    sun.kind = LightKind::directional;
    sun.direction = glm::normalize(vec3(1, -2, 0.5f));
    sun.intensity = vec3(3.0f);
    const RenderResult result = rendered(*floor.embree, asking(floor.surfaces, {sun}));
    expect_lambert(floor, result, [&](vec3) { return -3.0f * sun.direction.y; });
}

TEST(Reference, ASpotIsFullInsideItsInnerConeAndDarkOutsideItsOuterCone) {
    const Floor floor = lit_floor();
    Light spot = point_light({0, 3, 0}, vec3(5.0f));
    spot.kind = LightKind::spot;
    spot.direction = {0, -1, 0};
    spot.inner_cone_deg = 20.0f;
    spot.outer_cone_deg = 35.0f;
    const RenderResult result = rendered(*floor.embree, asking(floor.surfaces, {spot}));
    int inside = 0, outside = 0;
    for (std::size_t p = 0; p < floor.surfaces.size.pixels(); ++p) {
        const vec3 position = floor.surfaces.position[p];
        const float angle_deg = glm::degrees(std::atan2(std::hypot(position.x, position.z), 3.0f));
        const float distance = glm::distance(position, spot.position);
        const float full = 0.5f / pi * 5.0f * 3.0f / (distance * distance * distance);
        if (angle_deg < 19.9f) {
            ASSERT_NEAR(result.radiance.pixels[p].r, full, 1e-4f * full);
            ++inside;
        } else if (angle_deg > 35.1f) {
            ASSERT_EQ(result.radiance.pixels[p].r, 0.0f);
            ++outside;
        } else {
            ASSERT_LE(result.radiance.pixels[p].r, full * 1.0001f);
        }
    }
    EXPECT_GT(inside, 20);
    EXPECT_GT(outside, 20);
}

TEST(Reference, LightsBelowTheSurfaceAreNotAskedAndGiveNothing) {
    const Floor floor = lit_floor();
    const RenderResult result = rendered(*floor.embree, asking(floor.surfaces, {point_light({0, -1, 0}, vec3(9.0f))}));
    EXPECT_EQ(result.rays, 0u);
    for (std::size_t p = 0; p < floor.surfaces.size.pixels(); ++p) {
        ASSERT_EQ(result.radiance.pixels[p], vec3(0.0f));
        ASSERT_EQ(result.verdicts.words[p], 0u);
    }
}

TEST(Reference, ACanopyHidesTheSunAndEmissionStays) {
    Material glowing;
    glowing.emissive = vec3(0.125f);
    Scene scene = scene_with_material(glowing);
    add_quad(scene, {-2, 0, -2}, {0, 0, 4}, {4, 0, 0});
    add_quad(scene, {-2, 8, -2}, {0, 0, 4}, {2, 0, 0});  // over the left half, beyond the camera
    const auto embree = built(scene);
    Light sun;
    sun.kind = LightKind::directional;
    const SurfaceBuffer surfaces = seen(scene, *embree, camera_at({0, 3, 0.01f}, vec3(0.0f)), {32, 32});
    const RenderResult result = rendered(*embree, asking(surfaces, {sun}));
    for (std::size_t p = 0; p < surfaces.size.pixels(); ++p) {
        if (std::fabs(surfaces.position[p].x) < 0.01f) continue;
        const bool hidden = surfaces.position[p].x < 0.0f;
        ASSERT_EQ(result.verdicts.blocked(p, 0), hidden);
        ASSERT_EQ(result.shadow.pixels[p], hidden ? 1.0f : 0.0f);
        ASSERT_NEAR(result.radiance.pixels[p].r, hidden ? 0.125f : 0.125f + 0.8f / pi, 1e-5f);
    }
}

/// 200 triangles, 45 lights, 48x36 pixels.
struct Soup {
    Scene scene = triangle_soup(200);
    std::shared_ptr<const EmbreeScene> robust = built(scene);
    SurfaceBuffer surfaces = seen(scene, *robust, camera_at({0.3f, 0.8f, 2.6f}, vec3(0.0f)), {48, 36});
    std::vector<Light> lights;

    Soup() {
        for (std::uint32_t i = 0; i < 45; ++i)
            lights.push_back(point_light(random_point({vec3(-1.2f), vec3(1.2f)}, i, 9), vec3(0.1f)));
        lights[7].kind = LightKind::directional;
        lights[7].direction = glm::normalize(vec3(0.2f, -1, 0.4f));
    }
};

TEST(Reference, AgreesWithBruteForceRayByRay) {
    const Soup soup;
    const RenderResult result = rendered(*soup.robust, asking(soup.surfaces, soup.lights));
    std::uint64_t asked = 0, blocked = 0, different = 0;
    for (std::size_t p = 0; p < soup.surfaces.size.pixels(); ++p) {
        if (soup.surfaces.triangle[p] == no_triangle) continue;
        const vec3 position = soup.surfaces.position[p], normal = soup.surfaces.normal[p];
        std::uint32_t asked_here = 0;
        for (std::uint32_t l = 0; l < soup.lights.size(); ++l) {
            const Light& light = soup.lights[l];
            const vec3 target =
                light.kind == LightKind::directional ? position - 10.0f * light.direction : light.position;
            if (glm::dot(target - position, normal) <= 0.0f) {
                ASSERT_FALSE(result.verdicts.blocked(p, l));
                continue;
            }
            ++asked_here;
            // Brute force starts a little above the surface too; the triangle itself cannot be in the way there.
            const bool truth = any_crosses(soup.scene, position + 1e-5f * normal, target, 0.0, 1.0);
            blocked += truth ? 1 : 0;
            different += truth != result.verdicts.blocked(p, l) ? 1 : 0;
        }
        ASSERT_EQ(result.rays_asked.pixels[p], asked_here);
        asked += asked_here;
    }
    EXPECT_EQ(result.rays, asked);
    EXPECT_GT(blocked, asked / 10);
    EXPECT_LT(blocked, asked * 9 / 10);
    // Rays that graze an edge within rounding may fall on either side: at most one in ten thousand.
    EXPECT_LE(different, asked / 10000);
}

TEST(Reference, OccludedGivesTheVerdictsOfTheReference) {
    const Soup soup;
    const RenderResult result = rendered(*soup.robust, asking(soup.surfaces, soup.lights));
    for (std::size_t p = 0; p < soup.surfaces.size.pixels(); p += 3) {
        if (soup.surfaces.triangle[p] == no_triangle) continue;
        for (std::uint32_t l = 0; l < soup.lights.size(); ++l) {
            const vec3 position = soup.surfaces.position[p], normal = soup.surfaces.normal[p];
            if (soup.lights[l].kind != LightKind::point) continue;
            if (glm::dot(soup.lights[l].position - position, normal) <= 0.0f) continue;
            ASSERT_EQ(occluded(*soup.robust, {position, soup.lights[l].position}, normal),
                      result.verdicts.blocked(p, l));
        }
    }
}

TEST(CountBlocked, EveryVariantAsksTheRaysOfTheReferenceAndCountsAlike) {
    const Soup soup;
    const RenderResult result = rendered(*soup.robust, asking(soup.surfaces, soup.lights));
    std::uint64_t blocked = 0;
    for (std::size_t p = 0; p < soup.surfaces.size.pixels(); ++p)
        for (std::uint32_t l = 0; l < soup.lights.size(); ++l) blocked += result.verdicts.blocked(p, l) ? 1 : 0;
    const auto fast = built(soup.scene, EmbreeUse::benchmark);
    for (const EmbreeVariant variant :
         {EmbreeVariant::single, EmbreeVariant::packet_8, EmbreeVariant::packet_16, EmbreeVariant::stream}) {
        const QueryCount robust = count_blocked(*soup.robust, variant, soup.surfaces, soup.lights, 2);
        EXPECT_EQ(robust.rays, result.rays);
        EXPECT_EQ(robust.blocked, blocked);
        const QueryCount quick = count_blocked(*fast, variant, soup.surfaces, soup.lights, 2);
        EXPECT_EQ(quick.rays, result.rays);
        // Without ROBUST a ray through an edge may slip past: at most one in a thousand.
        EXPECT_NEAR(static_cast<double>(quick.blocked), static_cast<double>(blocked),
                    static_cast<double>(result.rays) / 1000.0);
        EXPECT_GT(quick.seconds, 0.0);
    }
}

TEST(CountBlocked, DoesNotDependOnTheNumberOfThreads) {
    const Soup soup;
    const auto fast = built(soup.scene, EmbreeUse::benchmark);
    for (const EmbreeVariant variant :
         {EmbreeVariant::single, EmbreeVariant::packet_8, EmbreeVariant::packet_16, EmbreeVariant::stream})
        EXPECT_EQ(count_blocked(*fast, variant, soup.surfaces, soup.lights, 1).blocked,
                  count_blocked(*fast, variant, soup.surfaces, soup.lights, 2).blocked);
}

TEST(Reference, IsTheSameForAnyNumberOfThreadsAndOrderOfTiles) {
    const Soup soup;
    const RenderResult first = rendered(*soup.robust, asking(soup.surfaces, soup.lights, 1));
    for (const bool reverse : {false, true}) {
        RenderRequest request = asking(soup.surfaces, soup.lights, 2);
        request.reverse_tiles = reverse;
        const RenderResult second = rendered(*soup.robust, request);
        EXPECT_EQ(first.radiance, second.radiance);
        EXPECT_EQ(first.shadow, second.shadow);
        EXPECT_EQ(first.rays_asked, second.rays_asked);
        EXPECT_EQ(first.verdicts.words, second.verdicts.words);
    }
}

TEST(Reference, ShadowIsTheShareOfAskedRaysThatAreBlocked) {
    const Soup soup;
    const RenderResult result = rendered(*soup.robust, asking(soup.surfaces, soup.lights));
    for (std::size_t p = 0; p < soup.surfaces.size.pixels(); ++p) {
        std::uint32_t blocked = 0;
        for (std::uint32_t l = 0; l < soup.lights.size(); ++l) blocked += result.verdicts.blocked(p, l) ? 1 : 0;
        const std::uint32_t asked = result.rays_asked.pixels[p];
        ASSERT_LE(blocked, asked);
        ASSERT_FLOAT_EQ(result.shadow.pixels[p],
                        asked == 0 ? 0.0f : static_cast<float>(blocked) / static_cast<float>(asked));
    }
}

TEST(Reference, KeepsVerdictsOnlyWhereAsked) {
    const Soup soup;
    RenderRequest request = asking(soup.surfaces, soup.lights);
    request.keep_verdicts = false;
    EXPECT_TRUE(rendered(*soup.robust, request).verdicts.words.empty());
}

TEST(Reference, ReportsEachPixelInExactlyOneRegion) {
    const Soup soup;
    Image<std::uint32_t> reported(soup.surfaces.size, 0u);
    const RenderResult whole = rendered(*soup.robust, asking(soup.surfaces, soup.lights));
    RenderRequest request = asking(soup.surfaces, soup.lights);
    request.on_region = [&](const RenderResult& so_far, PixelRect changed) {
        for (int y = changed.y; y < changed.y + changed.height; ++y) {
            for (int x = changed.x; x < changed.x + changed.width; ++x) {
                ++reported.at(x, y);
                EXPECT_EQ(so_far.radiance.at(x, y), whole.radiance.at(x, y));
            }
        }
    };
    rendered(*soup.robust, request);
    for (const std::uint32_t times : reported.pixels) ASSERT_EQ(times, 1u);
}

TEST(Reference, StopsWhenCancelledFromAReport) {
    const Soup soup;
    Progress progress;
    RenderRequest request = asking(soup.surfaces, soup.lights);
    request.on_region = [&](const RenderResult&, PixelRect) { progress.cancel(); };
    EXPECT_THROW(render_reference(*soup.robust, request, progress), Cancelled);
}

TEST(Reference, WithoutLightsShowsEmissionOnly) {
    const Soup soup;
    const RenderResult result = rendered(*soup.robust, asking(soup.surfaces, {}));
    EXPECT_EQ(result.rays, 0u);
    EXPECT_EQ(result.radiance.pixels, soup.surfaces.emission);
}

}  // namespace
}  // namespace sightlines::test
