// Brute force against the reference.
#include <algorithm>

#include <gtest/gtest.h>

#include "tests/baselines/pictures.h"

namespace sightlines::baselines {
namespace {

TEST(RayTracing, JudgesAsTheReferenceInEveryVariantButForRaysAlongEdges) {
    const Scene scene = testing::scattered_triangles(150, 8);
    const SurfaceBuffer surfaces = testing::seen_surfaces(scene, {90, 70});
    std::vector<Light> lights = testing::random_lights(scene.bounds, 45);
    lights[7].kind = LightKind::directional;
    for (double variant = 0.0; variant <= 3.0; variant += 1.0)
        EXPECT_LT(testing::visibility_error(ray_tracing(), scene, surfaces, lights, {{"variant", variant}}), 0.01)
            << variant;
}

TEST(RayTracing, RecordsTheTriangleNearestToTheLight) {
    Scene scene = testing::wall_in_a_box(2.0f);
    const Structure structure = testing::built(ray_tracing(), scene);
    const Light light{.position = {1.5f, 0.3f, 0.1f}};
    const Trace blocked = ray_tracing().trace(structure, {{-1.5f, 0.0f, 0.0f}, {1, 0, 0}, light, {}});
    ASSERT_EQ(blocked.steps.size(), 2u);
    const TraceStep& last = blocked.steps.back();
    for (const char* name : {"inside", "between"}) {
        const auto value = std::ranges::find(last.values, name, &TraceValue::name);
        ASSERT_NE(value, last.values.end());
        EXPECT_TRUE(std::get<bool>(value->value)) << name;
    }
    const auto share = std::ranges::find(last.values, "share", &TraceValue::name);
    EXPECT_NEAR(std::get<double>(share->value), 0.5, 1e-5);  // the wall is half way
    const Trace open =
        ray_tracing().trace(structure, {{-1.5f, 1.5f, 0.0f}, {1, 0, 0}, {.position = {1.5f, 1.6f, 0.0f}}, {}});
    EXPECT_FALSE(open.blocked);
    EXPECT_TRUE(open.steps.empty());
}

}  // namespace
}  // namespace sightlines::baselines
