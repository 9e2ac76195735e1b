// The built-in trees: four kinds, four of each, on rolling ground with grass and stones.
#include <array>
#include <cmath>
#include <numbers>

#include "techniques/scene/builtin_mesh.h"
#include "techniques/scene/builtin_models.h"

namespace sightlines {
namespace {

constexpr float pi = std::numbers::pi_v<float>;
constexpr float ground_half = 25.0f;  ///< m
constexpr std::uint32_t triangles_in_all = 626000;

enum MaterialIndex : std::uint32_t {
    grass,
    grass_dry,
    grass_dark,
    earth,
    stone,
    blade,
    bark,
    bark_pale,
    first_leaf,  ///< three tones for each kind of tree
};
constexpr std::uint32_t leaf_tones = 3;

std::vector<Material> materials() {
    return {
        diffuse("grass", {0.13f, 0.20f, 0.045f}),
        diffuse("dry grass", {0.17f, 0.215f, 0.055f}),
        diffuse("dark grass", {0.105f, 0.172f, 0.04f}),
        diffuse("earth", {0.30f, 0.20f, 0.11f}),
        diffuse("stone", {0.36f, 0.34f, 0.31f}),
        diffuse("grass blade", {0.17f, 0.28f, 0.05f}),
        diffuse("bark", {0.16f, 0.11f, 0.07f}),
        diffuse("pale bark", {0.55f, 0.51f, 0.44f}),
        diffuse("oak leaf, dark", {0.06f, 0.17f, 0.03f}),
        diffuse("oak leaf", {0.10f, 0.24f, 0.04f}),
        diffuse("oak leaf, light", {0.17f, 0.33f, 0.06f}),
        diffuse("maple leaf, red", {0.45f, 0.08f, 0.025f}),
        diffuse("maple leaf", {0.56f, 0.19f, 0.03f}),
        diffuse("maple leaf, gold", {0.66f, 0.34f, 0.04f}),
        diffuse("birch leaf", {0.22f, 0.32f, 0.05f}),
        diffuse("birch leaf, light", {0.34f, 0.42f, 0.07f}),
        diffuse("birch leaf, gold", {0.50f, 0.44f, 0.07f}),
        diffuse("lime leaf, dark", {0.05f, 0.20f, 0.06f}),
        diffuse("lime leaf", {0.08f, 0.28f, 0.08f}),
        diffuse("lime leaf, light", {0.14f, 0.37f, 0.10f}),
    };
}

/// How a kind of tree grows. Lengths in metres, shares of the parent's length.
struct Kind {
    const char* name;
    float trunk_length, trunk_radius;
    float bare_trunk;          ///< share of the trunk without branches
    float branch_share;        ///< length of the lowest branches over the trunk's
    float spread_deg;          ///< between a branch and what it grows from
    float rise;                ///< how strongly branches turn upwards
    int limbs, boughs, twigs;  ///< branches of each order on one of the order below
    float leaf_length;
    std::uint32_t bark;
};

constexpr std::array<Kind, 4> kinds = {{
    {"oak", 7.2f, 0.38f, 0.28f, 0.78f, 60.0f, 0.09f, 13, 7, 5, 0.27f, bark},
    {"maple", 8.2f, 0.29f, 0.24f, 0.62f, 48.0f, 0.22f, 14, 7, 5, 0.24f, bark},
    {"birch", 11.0f, 0.20f, 0.26f, 0.36f, 50.0f, -0.14f, 18, 6, 4, 0.20f, bark_pale},
    {"lime", 9.6f, 0.34f, 0.20f, 0.54f, 54.0f, 0.02f, 16, 7, 4, 0.23f, bark},
}};

/// A grown branch: where leaves may hang.
struct Twig {
    vec3 from{0.0f}, to{0.0f};
};

struct Growth {
    Mesh mesh;
    Draws draws;
    const Kind& kind;
    std::vector<Twig> twigs;
};

/// Turns `direction` by `angle_deg` towards a side, chosen by `azimuth_rad` around it.
vec3 branched(vec3 direction, float angle_deg, float azimuth_rad) {
    const vec3 helper = std::abs(direction.y) < 0.95f ? vec3(0.0f, 1.0f, 0.0f) : vec3(1.0f, 0.0f, 0.0f);
    const vec3 first = glm::normalize(glm::cross(direction, helper)), second = glm::cross(direction, first);
    const float angle = angle_deg * pi / 180.0f;
    return std::cos(angle) * direction +
           std::sin(angle) * (std::cos(azimuth_rad) * first + std::sin(azimuth_rad) * second);
}

/// Order 0 is the trunk, 3 a twig.
void grow(Growth& tree, vec3 start, vec3 direction, float length, float radius, int order) {
    constexpr std::array<int, 4> sides = {12, 7, 5, 3}, steps = {12, 6, 4, 2};
    const auto level = static_cast<std::size_t>(order);
    const float wander = order == 0 ? 0.07f : 0.16f;
    std::vector<TubeRing> rings = {{start, radius}};
    std::vector<vec3> directions = {direction};
    for (int i = 1; i <= steps[level]; ++i) {
        const float t = static_cast<float>(i) / static_cast<float>(steps[level]);
        const vec3 turn = wander * sphere_direction(tree.draws.unit(), tree.draws.unit());
        const float rise = order == 0 ? 0.05f : tree.kind.rise;
        direction = glm::normalize(direction + turn + vec3(0.0f, rise, 0.0f));
        const vec3 next = rings.back().centre + length / static_cast<float>(steps[level]) * direction;
        rings.push_back({next, std::max(radius * (1.0f - 0.85f * t), 0.004f)});
        directions.push_back(direction);
    }
    if (order == 0) rings.front().radius *= 1.45f;  // the roots' flare
    add_tube(tree.mesh, rings, sides[level], tree.kind.bark);
    if (order == 3) {
        tree.twigs.push_back({rings.front().centre, rings.back().centre});
        return;
    }
    const int count = order == 0 ? tree.kind.limbs : order == 1 ? tree.kind.boughs : tree.kind.twigs;
    const float bare = order == 0 ? tree.kind.bare_trunk : 0.25f;
    float azimuth = 2.0f * pi * tree.draws.unit();
    for (int k = 0; k < count; ++k) {
        const float along =
            bare + (1.0f - bare) * (static_cast<float>(k) + 0.7f * tree.draws.unit()) / static_cast<float>(count);
        const float at = along * static_cast<float>(steps[level]);
        const auto i = std::min(static_cast<std::size_t>(at), rings.size() - 2);
        const float share = at - static_cast<float>(i);
        const vec3 base = glm::mix(rings[i].centre, rings[i + 1].centre, share);
        const float thickness = glm::mix(rings[i].radius, rings[i + 1].radius, share);
        azimuth += 2.39996f + tree.draws.between(-0.4f, 0.4f);
        const float narrowing = 1.0f - 0.55f * (along - bare) / (1.0f - bare);  // a rounded crown
        const float child_share = order == 0 ? tree.kind.branch_share : order == 1 ? 0.48f : 0.42f;
        const float child_length = length * child_share * narrowing * tree.draws.between(0.8f, 1.15f);
        const float spread = tree.kind.spread_deg * (1.0f - 0.25f * along) * tree.draws.between(0.8f, 1.2f);
        grow(tree, base, branched(directions[i], spread, azimuth), child_length, 0.6f * thickness, order + 1);
    }
}

/// Leaves on the twigs, as many as asked.
void add_leaves(Growth& tree, std::uint32_t count, std::uint32_t first_tone) {
    for (std::uint32_t i = 0; i < count; ++i) {
        const Twig& twig = tree.twigs[i % tree.twigs.size()];
        const vec3 along = glm::normalize(twig.to - twig.from);
        const vec3 base = glm::mix(twig.from, twig.to, tree.draws.between(0.15f, 1.05f)) +
                          0.05f * sphere_direction(tree.draws.unit(), tree.draws.unit());
        const vec3 off = sphere_direction(tree.draws.unit(), tree.draws.unit());
        const vec3 direction = glm::normalize(0.7f * along + 0.9f * off + vec3(0.0f, -0.25f, 0.0f));
        const vec3 other = sphere_direction(tree.draws.unit(), tree.draws.unit());
        // Broad side up, more or less: blades lie across the light.
        const vec3 across = glm::cross(direction, vec3(0.0f, 1.0f, 0.0f) + 0.6f * other);
        const vec3 side = glm::dot(across, across) > 1e-4f ? glm::normalize(across) : branched(direction, 90.0f, 0.0f);
        const float length = tree.kind.leaf_length * tree.draws.between(0.75f, 1.2f);
        add_leaf(tree.mesh, base, direction, side, length, 0.54f * length, first_tone + tree.draws.below(leaf_tones));
    }
}

/// Height of the rolling ground, m.
float ground_height(vec2 place) {
    return 0.9f * std::sin(0.11f * place.x + 0.7f) * std::cos(0.13f * place.y - 0.4f) +
           0.35f * std::sin(0.31f * place.x - 0.22f * place.y) + 0.10f * std::sin(0.9f * place.x + 1.1f * place.y) +
           0.05f * std::sin(1.9f * place.x - 1.3f * place.y + 1.0f);
}

/// Distance from the middle of the footpath that winds across, m.
float distance_from_path(vec2 place) { return std::abs(place.y - 3.0f * std::sin(0.16f * place.x) - 0.06f * place.x); }

vec3 on_ground(vec2 place) { return {place.x, ground_height(place), place.y}; }

Mesh ground_mesh() {
    constexpr int cells = 140;
    Mesh mesh;
    add_surface(
        mesh, {cells, cells}, false,
        [](vec2 uv) {
            return on_ground({ground_half * (2.0f * uv.y - 1.0f), ground_half * (2.0f * uv.x - 1.0f)});
        },
        grass);
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const vec3 corner = mesh.positions[mesh.triangles[i].x];
        const float ragged = random_unit(21, static_cast<std::uint32_t>(i / 2), 0);
        if (distance_from_path({corner.x, corner.z}) < 0.75f + 0.35f * ragged)
            mesh.materials[i] = earth;
        else
            mesh.materials[i] = ragged < 0.6f ? grass : ragged < 0.8f ? grass_dry : grass_dark;
    }
    return mesh;
}

Mesh grass_mesh(int tufts) {
    Mesh mesh;
    Draws draws{31};
    for (int i = 0; i < tufts; ++i) {
        const vec2 place(draws.between(-0.98f, 0.98f) * ground_half, draws.between(-0.98f, 0.98f) * ground_half);
        if (distance_from_path(place) < 1.1f) continue;
        for (int k = 0; k < 4; ++k) {
            const float azimuth = 2.0f * pi * draws.unit(), lean = draws.between(0.1f, 0.6f);
            const vec3 outward(std::cos(azimuth), 0.0f, std::sin(azimuth));
            const vec3 direction = glm::normalize(vec3(0.0f, 1.0f, 0.0f) + lean * outward);
            const vec3 base = on_ground(place) + 0.05f * outward - vec3(0.0f, 0.02f, 0.0f);
            add_leaf(mesh, base, direction, {-outward.z, 0.0f, outward.x}, draws.between(0.16f, 0.34f), 0.035f, blade);
        }
    }
    return mesh;
}

Mesh stone_mesh(std::uint32_t seed) {
    Mesh mesh;
    add_surface(
        mesh, {18, 10}, true,
        [seed](vec2 uv) {
            const float azimuth = -2.0f * pi * uv.x, height = pi * (uv.y - 0.5f);
            const vec3 unit(std::cos(height) * std::cos(azimuth), std::sin(height),
                            std::cos(height) * std::sin(azimuth));
            const float phase = 2.0f * static_cast<float>(seed);
            const float bumps = 1.0f + 0.14f * std::sin(3.1f * unit.x + phase) * std::cos(2.7f * unit.z - phase) +
                                0.08f * std::sin(6.3f * unit.y + 4.1f * unit.x + phase);
            return bumps * unit * vec3(1.0f, 0.62f, 0.8f);
        },
        stone);
    return mesh;
}

/// Sixteen places on a loose grid, off the path; row by row, the kinds in turn.
std::vector<vec2> tree_places() {
    std::vector<vec2> places;
    Draws draws{41};
    for (int row = 0; row < 4; ++row) {
        for (int column = 0; column < 4; ++column) {
            vec2 place(-16.5f + 11.0f * static_cast<float>(column) + draws.between(-2.0f, 2.0f),
                       -17.0f + 11.3f * static_cast<float>(row) + draws.between(-1.8f, 1.8f));
            if (distance_from_path(place) < 2.4f) place.y += place.y > 0.0f ? 2.4f : -2.4f;
            places.push_back(place);
        }
    }
    return places;
}

void add_trees(Scene& scene, std::uint32_t first_mesh) {
    const std::vector<vec2> places = tree_places();
    const auto already = static_cast<std::uint32_t>(scene.triangles.size());
    const std::uint32_t triangles_each = (triangles_in_all - already) / static_cast<std::uint32_t>(places.size());
    for (std::uint32_t k = 0; k < kinds.size(); ++k) {
        const Kind& kind = kinds[k];
        Growth tree{{}, Draws{51 + k}, kind, {}};
        grow(tree, vec3(0.0f, -0.25f, 0.0f), vec3(0.0f, 1.0f, 0.0f), kind.trunk_length, kind.trunk_radius, 0);
        const auto wood = static_cast<std::uint32_t>(tree.mesh.triangles.size());
        add_leaves(tree, (triangles_each - std::min(wood, triangles_each)) / 2, first_leaf + leaf_tones * k);
        for (std::uint32_t i = 0; i < places.size(); ++i) {
            if ((i + i / 4) % kinds.size() != k) continue;
            const float scale = 0.88f + 0.24f * random_unit(61, i, 0), turn_deg = 360.0f * random_unit(61, i, 1);
            add_part(scene, tree.mesh, kind.name, first_mesh + k, placed(on_ground(places[i]), turn_deg, scale));
        }
    }
}

std::vector<Camera> cameras() {
    Camera path{"default", CameraKind::perspective, {-24.0f, 2.4f, -3.6f}, {0.0f, 4.2f, 0.6f}};
    path.vertical_field_of_view_deg = 56.0f;
    Camera canopy{"canopy", CameraKind::perspective, {-24.0f, 13.5f, 22.0f}, {1.0f, 4.0f, -2.0f}};
    canopy.vertical_field_of_view_deg = 50.0f;
    return {path, canopy};
}

Scene trees_at(double time_s) {
    Scene scene;
    scene.name = "trees";
    scene.time_s = time_s;
    scene.materials = materials();
    add_part(scene, ground_mesh(), "ground", 0, mat4(1.0f));
    add_part(scene, grass_mesh(4200), "grass", 1, mat4(1.0f));
    constexpr std::uint32_t stones = 14, first_stone = 2;
    for (std::uint32_t i = 0; i < stones; ++i) {
        const vec2 place((2.0f * random_unit(71, i, 0) - 1.0f) * 22.0f, (2.0f * random_unit(71, i, 1) - 1.0f) * 22.0f);
        const float scale = 0.25f + 0.6f * random_unit(71, i, 2) * random_unit(71, i, 3);
        add_part(scene, stone_mesh(i % 3), "stone", first_stone + i % 3,
                 placed(on_ground(place), 360.0f * random_unit(71, i, 4), scale));
    }
    add_trees(scene, first_stone + 3);
    scene.cameras = cameras();
    SunArc arc;
    arc.first_azimuth_deg = 205.0f;
    arc.last_azimuth_deg = 335.0f;
    arc.lowest_elevation_deg = 34.0f;
    arc.highest_elevation_deg = 58.0f;
    arc.irradiance = {6.8f, 5.8f, 4.4f};
    scene.lights = {sun_light(arc, time_s)};
    const std::vector<Light> sky = sky_lights(32, {1.3f, 1.6f, 2.1f});
    scene.lights.insert(scene.lights.end(), sky.begin(), sky.end());
    scene.bounds = scene.motion_bounds = tight_bounds(scene);
    // Between the trees and just above them.
    scene.light_volume = {{-22.0f, 1.8f, -22.0f}, {22.0f, scene.bounds.highest.y + 1.0f, 22.0f}};
    return scene;
}

}  // namespace

SceneModel trees_model() {
    return {"trees", "Sixteen broad-leaved trees of four kinds on rolling ground, under a moving sun.",
            SunArc{}.duration_s, trees_at};
}

}  // namespace sightlines
