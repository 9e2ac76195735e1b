// Wang 2017, Algorithm 5, as it looks: boxes over a floor at two moments, lit by a few lights.
#include <gtest/gtest.h>

#include "techniques/rays/embree_scene.h"
#include "techniques/voxel_rows/voxel_rows.h"
#include "tests/golden_pictures.h"
#include "tests/voxel_rows/moving_boxes.h"

namespace sightlines::voxel_rows {
namespace {

constexpr ImageSize moment_size{240, 135};

/// The picture of one moment; what moments share is taken from `structure`, which becomes that of this one.
ImageRgba8 picture_of(const Scene& scene, Structure& structure) {
    Progress progress;
    BuildRequest build;
    build.scene = &scene;
    build.parameters = testing::small_parameters();
    if (structure.has_value()) build.kept = technique().kept(structure);
    structure = technique().build(build, progress);
    Camera camera;
    camera.position = {4.6f, 4.2f, 6.4f};
    camera.target = {0.0f, 0.9f, 0.0f};
    const auto embree = build_embree_scene(scene, EmbreeUse::reference, 0, progress);
    const SurfaceBuffer surfaces = visible_surfaces(scene, *embree, camera, moment_size, 0, progress);
    std::vector<Light> lights(3);
    for (std::size_t k = 0; k < lights.size(); ++k) {
        lights[k].position = {static_cast<float>(k) - 1.0f, 4.8f, 1.5f * static_cast<float>(k) - 1.5f};
        lights[k].intensity = vec3(60.0f);
    }
    RenderRequest request;
    request.surfaces = &surfaces;
    request.lights = lights;
    request.parameters = build.parameters;
    return shown(technique().render(structure, request, progress).radiance, {});
}

TEST(ObjectsPicture, LooksAsItDidAtTwoMomentsThatShareTheirArrays) {
    const std::vector<mat4> early{placed({-1.8f, 1.2f, 0.5f}, 20.0f), placed({1.5f, 2.0f, -0.5f}, 75.0f)};
    const std::vector<mat4> late{placed({-0.4f, 2.2f, 1.2f}, 65.0f), placed({1.9f, 0.9f, -1.5f}, 110.0f)};
    Structure structure;
    ImageRgba8 both = picture_of(testing::boxes_over_a_floor(early), structure);
    const ImageRgba8 second = picture_of(testing::boxes_over_a_floor(late), structure);
    ASSERT_EQ(objects(structure).placed.size(), 2u);
    both.pixels.insert(both.pixels.end(), second.pixels.begin(), second.pixels.end());
    both.size.height *= 2;
    EXPECT_EQ(unlike_golden(both, "voxel_rows", "objects-at-two-moments"), "");
}

}  // namespace
}  // namespace sightlines::voxel_rows
