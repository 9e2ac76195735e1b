// The Cornell box: the geometry measured at Cornell University's Program of Computer Graphics, at a hundredth of its
// published numbers (in which the room is about 555 wide) in metres. Reflectances are the measured spectra as linear
// Rec. 709, as commonly used.
#include <array>
#include <cmath>

#include "techniques/scene/builtin_mesh.h"
#include "techniques/scene/builtin_models.h"

namespace sightlines {
namespace {

enum MaterialIndex : std::uint32_t { white, red, green, lamp };

using Quad = std::array<vec3, 4>;  ///< corners in the published order and units

/// Adds a published quadrilateral, turned so that it faces `seen_from`.
void add_measured(Mesh& mesh, Quad corners, vec3 seen_from, std::uint32_t material) {
    for (vec3& corner : corners) corner *= 0.01f;
    const vec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
    if (glm::dot(normal, 0.01f * seen_from - corners[0]) < 0.0f) std::swap(corners[1], corners[3]);
    add_polygon(mesh, corners, material);
}

constexpr vec3 room_middle(278.0f, 273.0f, 280.0f);
constexpr float lamp_low_x = 213.0f, lamp_high_x = 343.0f, lamp_low_z = 227.0f, lamp_high_z = 332.0f;
constexpr float ceiling_y = 548.8f;

/// A level rectangle at the height of the ceiling.
Quad overhead(float low_x, float high_x, float low_z, float high_z) {
    return {vec3(low_x, ceiling_y, low_z), vec3(high_x, ceiling_y, low_z), vec3(high_x, ceiling_y, high_z),
            vec3(low_x, ceiling_y, high_z)};
}

Mesh room_mesh() {
    Mesh mesh;
    const auto wall = [&](const Quad& corners, std::uint32_t material) {
        add_measured(mesh, corners, room_middle, material);
    };
    wall({vec3(552.8f, 0.0f, 0.0f), vec3(0.0f), vec3(0.0f, 0.0f, 559.2f), vec3(549.6f, 0.0f, 559.2f)}, white);
    wall({vec3(549.6f, 0.0f, 559.2f), vec3(0.0f, 0.0f, 559.2f), vec3(0.0f, 548.8f, 559.2f),
          vec3(556.0f, 548.8f, 559.2f)},
         white);
    wall({vec3(0.0f, 0.0f, 559.2f), vec3(0.0f), vec3(0.0f, 548.8f, 0.0f), vec3(0.0f, 548.8f, 559.2f)}, green);
    wall({vec3(552.8f, 0.0f, 0.0f), vec3(549.6f, 0.0f, 559.2f), vec3(556.0f, 548.8f, 559.2f),
          vec3(556.0f, 548.8f, 0.0f)},
         red);
    // The ceiling, left out where the lamp is: both lie in one plane.
    wall(overhead(0.0f, 556.0f, 0.0f, lamp_low_z), white);
    wall(overhead(0.0f, 556.0f, lamp_high_z, 559.2f), white);
    wall(overhead(0.0f, lamp_low_x, lamp_low_z, lamp_high_z), white);
    wall(overhead(lamp_high_x, 556.0f, lamp_low_z, lamp_high_z), white);
    return mesh;
}

/// A block on the floor: its footprint's corners (x, z) and its height, in the published units.
Mesh block_mesh(const std::array<vec2, 4>& footprint, float height) {
    Mesh mesh;
    vec3 middle(0.0f);
    for (const vec2 corner : footprint) middle += 0.25f * vec3(corner.x, 0.5f * height, corner.y);
    const auto at = [&](std::size_t i, float y) { return vec3(footprint[i % 4].x, y, footprint[i % 4].y); };
    // Outside faces: turned away from the block's middle.
    const auto face = [&](const Quad& corners) {
        add_measured(mesh, corners, 2.0f * corners[0] + 2.0f * corners[2] - 3.0f * middle, white);
    };
    face({at(0, height), at(1, height), at(2, height), at(3, height)});
    for (std::size_t i = 0; i < 4; ++i) face({at(i, 0.0f), at(i + 1, 0.0f), at(i + 1, height), at(i, height)});
    return mesh;
}

/// The lamp as a grid of downward spots whose light falls off as the squared cosine, just under it.
std::vector<Light> lamp_lights() {
    constexpr int per_side = 4;
    constexpr float below_m = 0.02f;
    std::vector<Light> lights;
    for (int j = 0; j < per_side; ++j) {
        for (int i = 0; i < per_side; ++i) {
            const float u = (static_cast<float>(i) + 0.5f) / per_side, v = (static_cast<float>(j) + 0.5f) / per_side;
            Light light;
            light.kind = LightKind::spot;
            light.position =
                0.01f * vec3(glm::mix(lamp_low_x, lamp_high_x, u), ceiling_y, glm::mix(lamp_low_z, lamp_high_z, v));
            light.position.y -= below_m;
            light.outer_cone_deg = 90.0f;
            light.intensity = vec3(34.0f, 26.0f, 15.5f) / static_cast<float>(per_side * per_side);
            lights.push_back(light);
        }
    }
    return lights;
}

Scene cornell_at(double time_s) {
    Scene scene;
    scene.name = "cornell";
    scene.time_s = time_s;
    scene.materials = {diffuse("white", {0.725f, 0.71f, 0.68f}), diffuse("red", {0.63f, 0.065f, 0.05f}),
                       diffuse("green", {0.14f, 0.45f, 0.091f}), diffuse("lamp", vec3(0.78f))};
    scene.materials[lamp].emissive = {18.4f, 13.5f, 7.2f};
    Mesh lamp_mesh;
    add_measured(lamp_mesh, overhead(lamp_low_x, lamp_high_x, lamp_low_z, lamp_high_z), room_middle, lamp);
    const Mesh short_block =
        block_mesh({vec2(130.0f, 65.0f), vec2(82.0f, 225.0f), vec2(240.0f, 272.0f), vec2(290.0f, 114.0f)}, 165.0f);
    const Mesh tall_block =
        block_mesh({vec2(423.0f, 247.0f), vec2(265.0f, 296.0f), vec2(314.0f, 456.0f), vec2(472.0f, 406.0f)}, 330.0f);
    add_part(scene, room_mesh(), "room", 0, mat4(1.0f));
    add_part(scene, lamp_mesh, "lamp", 1, mat4(1.0f));
    add_part(scene, short_block, "short block", 2, mat4(1.0f));
    add_part(scene, tall_block, "tall block", 3, mat4(1.0f));
    // The published camera: focal length 0.035, film 0.025 square.
    Camera camera{"default", CameraKind::perspective, {2.78f, 2.73f, -8.0f}, {2.78f, 2.73f, 2.8f}};
    camera.vertical_field_of_view_deg = glm::degrees(2.0f * std::atan(0.0125f / 0.035f));
    scene.cameras = {camera};
    scene.lights = lamp_lights();
    scene.bounds = scene.motion_bounds = tight_bounds(scene);
    scene.light_volume = {{0.3f, 3.5f, 0.3f}, {5.2f, 5.3f, 5.2f}};  // above the blocks
    return scene;
}

}  // namespace

SceneModel cornell_model() {
    return {"cornell", "The Cornell box: a closed room, two blocks, one lamp, measured in 1984 and later.", 0.0,
            cornell_at};
}

}  // namespace sightlines
