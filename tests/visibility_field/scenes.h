// Small scenes for the tests of the visibility field.
#pragma once

#include "techniques/visibility_field/bake.h"
#include "tests/rays/test_scenes.h"

namespace sightlines::visibility_field::testing {

/// A scene whose triangles are seen from their fronts only.
inline Scene one_sided_scene() {
    Material solid;
    solid.double_sided = false;
    return test::scene_with_material(solid);
}

/// A courtyard 8 m wide, open above, with a pillar, a sheet that is seen from both sides, and a small ball.
inline Scene courtyard() {
    Material solid, sheet;
    solid.double_sided = false;
    solid.base_color = vec3(0.7f, 0.6f, 0.5f);
    Scene scene = test::scene_with_material(solid);
    scene.materials.push_back(sheet);
    test::add_box(scene, {-4.0f, -0.5f, -4.0f}, {4.0f, 0.0f, 4.0f});
    test::add_box(scene, {-4.0f, 0.0f, -4.3f}, {4.0f, 3.0f, -4.0f});
    test::add_box(scene, {-4.3f, 0.0f, -4.0f}, {-4.0f, 3.0f, 4.0f});
    test::add_box(scene, {4.0f, 0.0f, -4.0f}, {4.3f, 2.0f, 4.0f});
    test::add_box(scene, {-0.6f, 0.0f, -1.2f}, {0.3f, 2.5f, -0.4f});
    test::add_quad(scene, {1.1f, 1.0f, -2.0f}, {0.2f, 0.9f, 0.0f}, {0.0f, 0.0f, 2.7f}, 1);
    test::add_sphere(scene, {-2.0f, 0.7f, 1.5f}, 0.7f, 16);
    // Spheres have no texture coordinates of their own.
    scene.texture_coordinates[0].clear();
    return scene;
}

inline Camera courtyard_camera() { return test::camera_at({3.2f, 2.6f, 5.5f}, {-0.8f, 0.6f, -0.5f}); }

inline BakeOptions small_bake() {
    BakeOptions options;
    options.points = 6000;
    options.rays = 64;
    options.threads = 2;
    return options;
}

inline VisibilityField baked(const Scene& scene, const EmbreeScene& embree, const BakeOptions& options) {
    Progress progress;
    return bake(scene, embree, options, progress);
}

}  // namespace sightlines::visibility_field::testing
