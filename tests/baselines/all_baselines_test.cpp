// What holds for every baseline: one picture whatever the threads, tiles and watchers; traces and counts that agree
// with it; walls, slits and spheres; errors that name their remedy.
#include <cmath>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "techniques/base/error.h"
#include "tests/baselines/pictures.h"

namespace sightlines::baselines {
namespace {

struct Baseline {
    const Technique& (*technique)();
    QueryCount (*count)(const Structure&, const RenderRequest&);
    const char* kernel;  ///< where its recorded steps come from
};

std::string test_name(const ::testing::TestParamInfo<Baseline>& info) {
    return std::string(info.param.technique().name);
}

class EveryBaseline : public ::testing::TestWithParam<Baseline> {
protected:
    const Technique& technique() const { return GetParam().technique(); }
};

INSTANTIATE_TEST_SUITE_P(Techniques, EveryBaseline,
                         ::testing::Values(Baseline{voxel_marching, count_by_voxel_marching, "shaders/voxel_march.h"},
                                           Baseline{row_marching, count_by_row_marching, "shaders/voxel_march.h"},
                                           Baseline{shadow_maps, count_by_shadow_maps, "shaders/shadow_map.h"},
                                           Baseline{imperfect_shadow_maps, count_by_imperfect_shadow_maps,
                                                    "shaders/shadow_map.h"},
                                           Baseline{ray_tracing, count_by_ray_tracing, "shaders/ray_triangle.h"}),
                         test_name);

struct Picture {
    Scene scene = testing::scattered_triangles(150, 7);
    SurfaceBuffer surfaces = testing::seen_surfaces(scene, {77, 70});
    std::vector<Light> lights = testing::random_lights(scene.bounds, 37);

    Picture() {
        lights[3].kind = LightKind::directional;
        lights[3].direction = glm::normalize(vec3(1.0f, -2.0f, 0.5f));
        lights[4].kind = LightKind::spot;
    }
};

TEST_P(EveryBaseline, GivesTheSamePictureForAnyThreadsTilesAndWatchers) {
    const Picture picture;
    const Structure structure = testing::built(technique(), picture.scene);
    RenderRequest request = testing::request_for(picture.surfaces, picture.lights);
    request.threads = 2;
    const RenderResult two = testing::rendered(technique(), structure, request);
    request.threads = 1;
    const RenderResult one = testing::rendered(technique(), structure, request);
    request.reverse_tiles = true;
    const RenderResult reversed = testing::rendered(technique(), structure, request);
    int regions = 0;
    request.on_region = [&](const RenderResult& so_far, PixelRect) {
        ++regions;
        ASSERT_EQ(so_far.radiance.size, picture.surfaces.size);
    };
    const RenderResult watched = testing::rendered(technique(), structure, request);
    EXPECT_GT(regions, 2);
    for (const RenderResult* other : {&one, &reversed, &watched}) {
        EXPECT_EQ(two.radiance, other->radiance);
        EXPECT_EQ(two.shadow, other->shadow);
        EXPECT_EQ(two.rays_asked, other->rays_asked);
        EXPECT_EQ(two.verdicts.words, other->verdicts.words);
    }
}

TEST_P(EveryBaseline, AsksTheRaysOfTheReferenceAndCountsThem) {
    const Picture picture;
    const Structure structure = testing::built(technique(), picture.scene);
    const RenderRequest request = testing::request_for(picture.surfaces, picture.lights);
    const RenderResult result = testing::rendered(technique(), structure, request);
    Progress progress;
    const auto embree = build_embree_scene(picture.scene, EmbreeUse::reference, 0, progress);
    EXPECT_EQ(result.rays_asked, render_reference(*embree, request, progress).rays_asked);
    std::uint64_t blocked = 0;
    for (std::size_t pixel = 0; pixel < picture.surfaces.size.pixels(); ++pixel)
        for (std::uint32_t light = 0; light < picture.lights.size(); ++light)
            blocked += result.verdicts.blocked(pixel, light);
    const QueryCount count = GetParam().count(structure, request);
    EXPECT_EQ(count.rays, result.rays);
    // Embree answers a few rays along edges otherwise, packed otherwise.
    EXPECT_NEAR(static_cast<double>(count.blocked), static_cast<double>(blocked),
                technique().name == "ray_tracing" ? 3.0 : 0.0);
    EXPECT_GT(blocked, result.rays / 20);
    EXPECT_LT(blocked, result.rays - result.rays / 20);
}

TEST_P(EveryBaseline, RecordsTheRayThatItRenders) {
    const Picture picture;
    const Structure structure = testing::built(technique(), picture.scene);
    RenderRequest request = testing::request_for(picture.surfaces, picture.lights);
    int different = 0, rays = 0, with_steps = 0;
    for (std::uint32_t light = 0; light < picture.lights.size(); light += 3) {
        // Alone the light is number 0 for the picture too, which decides its set of points.
        request.lights = std::span(picture.lights).subspan(light, 1);
        const RenderResult result = testing::rendered(technique(), structure, request);
        for (std::size_t pixel = 0; pixel < picture.surfaces.size.pixels(); pixel += 13) {
            if (result.rays_asked.pixels[pixel] == 0) continue;
            const Trace trace = technique().trace(
                structure,
                {picture.surfaces.position[pixel], picture.surfaces.normal[pixel], picture.lights[light], {}});
            different += trace.blocked != result.verdicts.blocked(pixel, 0);
            with_steps += !trace.steps.empty();
            ++rays;
            EXPECT_EQ(trace.ray.origin, picture.surfaces.position[pixel]);
        }
    }
    EXPECT_GT(rays, 100);
    EXPECT_LE(different, technique().name == "ray_tracing" ? 2 : 0);
    EXPECT_GT(with_steps, rays / 20);
}

TEST_P(EveryBaseline, NamesTheLinesOfItsKernel) {
    const Scene scene = testing::wall_in_a_box(2.0f);
    const Structure structure = testing::built(technique(), scene);
    const Light light{.position = {1.5f, 0.1f, 0.1f}};
    const Trace trace = technique().trace(structure, {{-1.5f, 0.0f, 0.0f}, {1, 0, 0}, light, {}});
    EXPECT_TRUE(trace.blocked);
    ASSERT_GE(trace.steps.size(), 2u);
    std::vector<std::string> source;
    std::ifstream stream(std::string(SIGHTLINES_SOURCE_FOLDER) + "/" + GetParam().kernel);
    for (std::string line; std::getline(stream, line);) source.push_back(line);
    for (const TraceStep& step : trace.steps) {
        EXPECT_EQ(step.file, GetParam().kernel);
        ASSERT_LE(static_cast<std::size_t>(step.line), source.size());
        EXPECT_NE(source[static_cast<std::size_t>(step.line) - 1].find("NOTE(\"" + step.paper), std::string::npos);
        EXPECT_FALSE(step.sentence.empty());
    }
}

TEST_P(EveryBaseline, SeesAWallBetweenSurfaceAndLightAndNothingBesideIt) {
    const Scene scene = testing::wall_in_a_box(2.0f);
    const Structure structure = testing::built(technique(), scene);
    for (std::uint32_t k = 0; k < 300; ++k) {
        const float y = 1.2f * random_unit(1, k, 0) - 0.6f, z = 1.2f * random_unit(1, k, 1) - 0.6f;
        const Light behind{.position = {1.6f, 1.2f * random_unit(1, k, 2) - 0.6f, 1.2f * random_unit(1, k, 3) - 0.6f}};
        ASSERT_TRUE(testing::is_blocked(technique(), structure, {-1.8f, y, z}, {1, 0, 0}, behind)) << k;
        const Light before{.position = {-0.6f, behind.position.y, behind.position.z}};
        ASSERT_FALSE(testing::is_blocked(technique(), structure, {-1.8f, y, z}, {1, 0, 0}, before)) << k;
        const Light beside{.position = {1.6f, 1.85f, z}};
        ASSERT_FALSE(testing::is_blocked(technique(), structure, {-1.8f, 1.85f, z}, {1, 0, 0}, beside)) << k;
    }
}

TEST_P(EveryBaseline, SeesAWallBetweenSurfaceAndDirectionalLight) {
    const Scene scene = testing::wall_in_a_box(2.0f);
    const Structure structure = testing::built(technique(), scene);
    const Light light{.kind = LightKind::directional, .direction = glm::normalize(vec3(-1.0f, 0.1f, -0.1f))};
    for (std::uint32_t k = 0; k < 200; ++k) {
        const float y = 1.0f * random_unit(2, k, 0) - 0.5f, z = 1.0f * random_unit(2, k, 1) - 0.5f;
        ASSERT_TRUE(testing::is_blocked(technique(), structure, {-1.2f, y, z}, {1, 0, 0}, light)) << k;
        ASSERT_FALSE(testing::is_blocked(technique(), structure, {0.5f, y, z}, {1, 0, 0}, light)) << k;
        ASSERT_FALSE(testing::is_blocked(technique(), structure, {-1.2f, 1.8f, z}, {1, 0, 0}, light)) << k;
    }
}

TEST_P(EveryBaseline, LetsNoLightOutOfASphere) {
    const Scene scene = testing::sphere_in_a_box(1.0f, 48);
    const Structure structure = testing::built(technique(), scene);
    std::vector<vec3> points, normals;
    for (std::uint32_t k = 0; k < 4000; ++k) {
        const vec3 direction = sphere_direction(random_unit(3, k, 0), random_unit(3, k, 1));
        points.push_back(1.7f * direction);
        normals.push_back(-direction);
    }
    const Light light{.position = {0.1f, -0.05f, 0.07f}};
    const SurfaceBuffer surfaces = testing::surfaces_of(points, normals);
    const RenderResult result =
        testing::rendered(technique(), structure, testing::request_for(surfaces, std::span(&light, 1)));
    ASSERT_EQ(result.rays, points.size());
    for (std::size_t k = 0; k < points.size(); ++k) ASSERT_TRUE(result.verdicts.blocked(k, 0)) << k;
}

TEST_P(EveryBaseline, LetsLightThroughASlitOnly) {
    const Scene scene = testing::wall_with_a_slit(0.5f);
    const Structure structure = testing::built(technique(), scene);
    const Light light{.position = {1.0f, 0.0f, 0.0f}};
    // From the light the slit's shadow gap is three times as wide at x = -2.
    for (std::uint32_t k = 0; k < 200; ++k) {
        const float y = random_unit(4, k, 0) - 0.5f;
        const float inside = 0.6f * random_unit(4, k, 1) - 0.3f, outside = 1.25f + 0.6f * random_unit(4, k, 2);
        ASSERT_FALSE(testing::is_blocked(technique(), structure, {-1.9f, y, inside}, {1, 0, 0}, light)) << k;
        ASSERT_TRUE(testing::is_blocked(technique(), structure, {-1.9f, y, outside}, {1, 0, 0}, light)) << k;
    }
}

TEST_P(EveryBaseline, LightsAnEmptySceneAsTheInverseSquareLawSays) {
    Scene scene;
    scene.materials.resize(1);
    const Structure structure = testing::built(technique(), scene);
    const vec3 position(0.0f), normal(0, 1, 0);
    const SurfaceBuffer surfaces = testing::surfaces_of(std::span(&position, 1), std::span(&normal, 1));
    const Light light{.position = {0.0f, 2.0f, 0.0f}, .intensity = vec3(8.0f)};
    const RenderResult result =
        testing::rendered(technique(), structure, testing::request_for(surfaces, std::span(&light, 1)));
    EXPECT_NEAR(result.radiance.pixels[0].g, 0.5f * (8.0f / 4.0f) / 3.14159265f, 1e-5f);
}

TEST_P(EveryBaseline, IsDarkWithoutLights) {
    const Picture picture;
    const Structure structure = testing::built(technique(), picture.scene);
    const RenderResult result = testing::rendered(technique(), structure, testing::request_for(picture.surfaces, {}));
    EXPECT_EQ(result.rays, 0u);
    for (const vec3& radiance : result.radiance.pixels) ASSERT_EQ(radiance, vec3(0.0f));
}

TEST_P(EveryBaseline, StopsWhenCancelled) {
    const Picture picture;
    const Structure structure = testing::built(technique(), picture.scene);
    Progress progress;
    progress.cancel();
    EXPECT_THROW(technique().build({&picture.scene, {}, Backend::cpu, 0}, progress), Cancelled);
    EXPECT_THROW(technique().render(structure, testing::request_for(picture.surfaces, picture.lights), progress),
                 Cancelled);
}

TEST_P(EveryBaseline, RefusesVulkanAndNamesTheRemedy) {
    const Picture picture;
    EXPECT_FALSE(technique().on_vulkan);
    const Structure structure = testing::built(technique(), picture.scene);
    RenderRequest request = testing::request_for(picture.surfaces, picture.lights);
    request.backend = Backend::vulkan;
    const auto refused = [&](const auto& work) {
        try {
            work();
        } catch (const InputError& error) {
            return error.problem == "runs on the CPU only" && error.remedy == "give --backend cpu";
        }
        return false;
    };
    Progress progress;
    EXPECT_TRUE(refused([&] { technique().render(structure, request, progress); }));
    EXPECT_TRUE(refused([&] { technique().build({&picture.scene, {}, Backend::vulkan, 0}, progress); }));
    EXPECT_TRUE(refused([&] { GetParam().count(structure, request); }));
}

TEST_P(EveryBaseline, HasParametersWhoseDefaultsAreAllowed) {
    for (const Parameter& parameter : technique().parameters) {
        EXPECT_NO_THROW(
            check_parameters(technique().parameters, {{std::string(parameter.name), parameter.default_value}}))
            << parameter.name;
        EXPECT_THROW(check_parameters(technique().parameters, {{std::string(parameter.name), parameter.highest + 1.0}}),
                     InputError);
        EXPECT_TRUE(parameter.help.ends_with('.')) << parameter.name;
    }
}

}  // namespace
}  // namespace sightlines::baselines
