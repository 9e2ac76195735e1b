#include <algorithm>
#include <cmath>
#include <numbers>

#include "techniques/base/parallel.h"
#include "techniques/scene/builtin_bear.h"
#include "techniques/scene/builtin_shapes.h"

namespace sightlines::bear {
namespace {

constexpr float pi = std::numbers::pi_v<float>;

/// The joints of one leg at rest, in the plane of its side.
struct Leg {
    vec2 root, middle, end;
    float side;           ///< z, m
    std::uint32_t hangs;  ///< the bone of the trunk that carries it
    float bend;           ///< the middle joint points forwards (1) or backwards (-1)
    float touch;          ///< when its foot comes down, in strides
    float reach_m;        ///< how far before and behind its rest place the foot goes
};

constexpr std::array<Leg, 4> legs = {{
    {{0.48f, 0.88f}, {0.40f, 0.50f}, {0.46f, 0.13f}, -0.20f, thorax, -1.0f, 0.42f, 0.36f},
    {{0.48f, 0.88f}, {0.40f, 0.50f}, {0.46f, 0.13f}, 0.20f, thorax, -1.0f, 0.53f, 0.36f},
    {{-0.58f, 0.88f}, {-0.40f, 0.50f}, {-0.63f, 0.14f}, -0.18f, pelvis, 1.0f, 0.00f, 0.36f},
    {{-0.58f, 0.88f}, {-0.40f, 0.50f}, {-0.63f, 0.14f}, 0.18f, pelvis, 1.0f, 0.11f, 0.36f},
}};
constexpr float on_ground = 2.0f * 0.36f / stride_m;  ///< share of a stride

mat4 moved(vec3 by) { return framed({1, 0, 0}, {0, 1, 0}, {0, 0, 1}, by); }

/// Turned by `angle` in the plane of the picture (x towards y) about a joint at rest, which goes to `to`.
mat4 hinged(vec2 rest, vec2 to, float angle) {
    return moved({to.x, to.y, 0.0f}) * turned_about({0, 0, 1}, angle) * moved({-rest.x, -rest.y, 0.0f});
}

float angle_of(vec2 direction) { return std::atan2(direction.y, direction.x); }

vec2 applied(const mat4& matrix, vec2 point) { return vec2(matrix * vec4(point, 0.0f, 1.0f)); }

/// Where the ankle is, from its rest place, and how far the foot is turned, along the stride since it touched.
struct Step {
    vec2 offset;
    float turn;
};

Step step_at(const Leg& leg, float since) {
    if (since < on_ground) {
        const float t = since / on_ground;
        const float roll = std::max(t - 0.6f, 0.0f) / 0.4f;  // the heel lifts before the toes leave
        return {{leg.reach_m * (1.0f - 2.0f * t), 0.05f * roll}, -0.5f * roll};
    }
    const float t = (since - on_ground) / (1.0f - on_ground);
    const float eased = t * t * (3.0f - 2.0f * t);
    const float lift = std::max(std::sin(pi * t), 0.0f);  // t may be rounded to a little more than 1
    return {{leg.reach_m * (2.0f * eased - 1.0f) - 0.06f * std::sin(2.0f * pi * t),
             0.27f * std::pow(lift, 1.3f) + 0.05f * (1.0f - t) * (1.0f - t)},
            -0.5f * (1.0f - t) - 0.75f * lift * (1.0f - t) + 0.25f * lift * t};
}

/// Two bones from `root` that reach `end`, bent to the leg's side: where the middle joint goes.
vec2 middle_joint(const Leg& leg, vec2 root, vec2& end) {
    const float upper = glm::distance(leg.root, leg.middle), lower = glm::distance(leg.middle, leg.end);
    vec2 way = end - root;
    const float distance = std::clamp(glm::length(way), std::abs(upper - lower) + 0.02f, 0.995f * (upper + lower));
    way = glm::normalize(way);
    end = root + distance * way;
    const float along = (upper * upper - lower * lower + distance * distance) / (2.0f * distance);
    const float out = std::sqrt(std::max(upper * upper - along * along, 0.0f));
    // Downwards along the leg, its forward side is to the left.
    return root + along * way + leg.bend * out * vec2(-way.y, way.x);
}

std::vector<RoundCone> cones() {
    std::vector<RoundCone> all = {
        {{-0.60f, 0.93f, 0}, {-0.20f, 0.97f, 0}, 0.285f, 0.295f, pelvis},
        {{-0.72f, 0.93f, -0.08f}, {-0.67f, 0.80f, -0.09f}, 0.21f, 0.17f, pelvis},
        {{-0.72f, 0.93f, 0.08f}, {-0.67f, 0.80f, 0.09f}, 0.21f, 0.17f, pelvis},
        {{-0.25f, 0.96f, 0}, {0.15f, 0.98f, 0}, 0.300f, 0.325f, lumbar},
        {{-0.22f, 0.86f, 0}, {0.20f, 0.84f, 0}, 0.235f, 0.255f, lumbar},
        {{0.12f, 0.98f, 0}, {0.48f, 1.00f, 0}, 0.325f, 0.300f, thorax},
        {{0.34f, 1.17f, 0}, {0.50f, 1.15f, 0}, 0.175f, 0.165f, thorax},
        {{0.38f, 0.88f, 0}, {0.57f, 0.92f, 0}, 0.255f, 0.225f, thorax},
        {{0.56f, 1.04f, 0}, {0.92f, 1.08f, 0}, 0.240f, 0.180f, neck},
        {{1.02f, 1.10f, 0}, {1.10f, 1.09f, 0}, 0.165f, 0.140f, head},
        {{1.06f, 1.02f, -0.07f}, {1.14f, 1.02f, -0.05f}, 0.095f, 0.078f, head},
        {{1.06f, 1.02f, 0.07f}, {1.14f, 1.02f, 0.05f}, 0.095f, 0.078f, head},
        {{1.16f, 1.03f, 0}, {1.36f, 0.995f, 0}, 0.090f, 0.060f, head},
        {{1.18f, 0.970f, 0}, {1.33f, 0.950f, 0}, 0.064f, 0.046f, head},
        {{1.400f, 1.012f, 0}, {1.400f, 1.012f, 0}, 0.032f, 0.032f, head},
        {{0.98f, 1.22f, -0.115f}, {0.965f, 1.285f, -0.140f}, 0.055f, 0.048f, head},
        {{0.98f, 1.22f, 0.115f}, {0.965f, 1.285f, 0.140f}, 0.055f, 0.048f, head},
        {{-0.90f, 1.00f, 0}, {-0.97f, 0.93f, 0}, 0.065f, 0.050f, pelvis},
    };
    for (std::uint32_t k = 0; k < legs.size(); ++k) {
        const Leg& leg = legs[k];
        const std::uint32_t bone = first_leg + 3 * k;
        const bool front = k < 2;
        const auto at = [&](float x, float y) { return vec3(x, y, leg.side); };
        const vec3 root(leg.root, 0.85f * leg.side), middle(leg.middle, leg.side), end(leg.end, leg.side);
        all.push_back({root, middle, front ? 0.185f : 0.225f, front ? 0.120f : 0.135f, bone});
        all.push_back({middle, end, front ? 0.120f : 0.125f, front ? 0.086f : 0.080f, bone + 1});
        const float foot = leg.end.x;
        all.push_back({at(foot - 0.02f, 0.085f), at(foot + (front ? 0.12f : 0.16f), 0.065f), 0.084f, 0.070f, bone + 2});
    }
    return all;
}

Body::Binding bound(std::span<const RoundCone> all, vec3 point, std::uint32_t first, std::uint32_t count) {
    std::array<float, bone_count> nearest;
    nearest.fill(10.0f);
    for (const RoundCone& cone : all) nearest[cone.bone] = std::min(nearest[cone.bone], distance_to(cone, point));
    const float closest = *std::ranges::min_element(nearest);
    Body::Binding binding{first, count, {}, {}};
    float sum = 0.0f;
    for (std::size_t k = 0; k < binding.bones.size(); ++k) {
        const auto best = static_cast<std::size_t>(std::ranges::min_element(nearest) - nearest.begin());
        binding.bones[k] = static_cast<std::uint32_t>(best);
        binding.weights[k] = std::exp(-(nearest[best] - closest) / 0.05f);
        nearest[best] = 10.0f;
        sum += binding.weights[k];
    }
    for (float& weight : binding.weights) weight /= sum;
    return binding;
}

std::uint32_t tone_at(vec3 place, float draw) {
    if (place.x > 1.17f) return fur_muzzle;
    const float patch = smooth_noise(vec2(3.0f * place.x + place.z, 4.0f * place.y), 55) + 0.22f * (draw - 0.5f);
    const float dark = place.y < 0.55f ? 0.30f : 0.0f;  // legs are darker
    return patch - dark < 0.33f ? fur_dark : patch - dark < 0.66f ? fur_mid : fur_light;
}

/// How long the hair is, m.
float hair_length(vec3 place) {
    if (place.x > 1.17f) return 0.022f;
    if (place.x > 0.95f) return 0.045f;
    if (place.y < 0.16f) return 0.03f;
    if (place.y < 0.5f) return 0.04f;
    return place.y > 1.12f ? 0.085f : 0.07f;
}

/// A blade of three triangles that bends along the body.
void add_hair(Mesh& mesh, vec3 root, vec3 normal, float width, Draws& draws) {
    const vec3 random = sphere_direction(draws.unit(), draws.unit());
    const vec3 comb = vec3(-1.0f, root.y < 0.6f ? -1.2f : -0.45f, 0.0f) + 0.45f * random;
    vec3 flat = comb - normal * glm::dot(comb, normal);
    flat = glm::dot(flat, flat) > 1e-3f ? glm::normalize(flat)
                                        : glm::normalize(glm::cross(normal, vec3(0.3f, 0.2f, 1.0f)));
    const float length = hair_length(root) * draws.between(0.7f, 1.2f);
    const vec3 rising = glm::normalize(flat + draws.between(0.35f, 0.75f) * normal);
    const vec3 lying = glm::normalize(flat + 0.12f * normal - vec3(0.0f, 0.12f, 0.0f));
    const vec3 side = glm::normalize(glm::cross(rising, normal));
    const vec3 base = root - 0.004f * normal, bend = base + 0.5f * length * rising;
    const std::uint32_t tone = tone_at(root, draws.unit());
    const std::uint32_t a = add_vertex(mesh, base - 0.5f * width * side, normal);
    const std::uint32_t b = add_vertex(mesh, base + 0.5f * width * side, normal);
    const std::uint32_t c = add_vertex(mesh, bend - 0.4f * width * side, normal);
    const std::uint32_t d = add_vertex(mesh, bend + 0.4f * width * side, normal);
    const std::uint32_t e = add_vertex(mesh, bend + 0.5f * length * lying, normal);
    for (const uvec3 triangle : {uvec3(a, b, d), uvec3(a, d, c), uvec3(c, d, e)}) {
        mesh.triangles.push_back(triangle);
        mesh.materials.push_back(tone);
    }
}

/// Hairs spread evenly over the skin's area.
void add_fur(Body& result, std::span<const RoundCone> all, std::uint32_t hairs) {
    Mesh& mesh = result.mesh;
    const std::size_t skin_triangles = mesh.triangles.size();
    std::vector<float> area_up_to;
    float area = 0.0f;
    for (const uvec3 t : mesh.triangles) {
        const vec3 a = mesh.positions[t.x];
        area += glm::length(glm::cross(mesh.positions[t.y] - a, mesh.positions[t.z] - a));
        area_up_to.push_back(area);
    }
    const float width = std::clamp(1.15f * std::sqrt(0.5f * area / static_cast<float>(hairs)), 0.003f, 0.015f);
    Draws draws{501};
    for (std::uint32_t i = 0; i < hairs; ++i) {
        const float at = area * (static_cast<float>(i) + draws.unit()) / static_cast<float>(hairs);
        const auto index =
            std::min(static_cast<std::size_t>(std::ranges::upper_bound(area_up_to, at) - area_up_to.begin()),
                     skin_triangles - 1);
        if (mesh.materials[index] != skin) continue;
        const uvec3 t = mesh.triangles[index];
        float u = draws.unit(), v = draws.unit();
        if (u + v > 1.0f) u = 1.0f - u, v = 1.0f - v;
        const auto mixed = [&](const std::vector<vec3>& of) {
            return (1.0f - u - v) * of[t.x] + u * of[t.y] + v * of[t.z];
        };
        const vec3 root = mixed(mesh.positions), normal = glm::normalize(mixed(mesh.normals));
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        add_hair(mesh, root, normal, width * draws.between(0.8f, 1.2f), draws);
        result.bindings.push_back(bound(all, root, first, 5));
    }
}

/// Eyes and claws: rigid on one bone.
void add_features(Body& result) {
    Mesh& mesh = result.mesh;
    const auto rigid = [&](std::uint32_t bone, std::size_t first) {
        result.bindings.push_back({static_cast<std::uint32_t>(first),
                                   static_cast<std::uint32_t>(mesh.positions.size() - first),
                                   {bone, bone, bone},
                                   {1, 0, 0}});
    };
    for (const float side : {-1.0f, 1.0f}) {
        const std::size_t first = mesh.positions.size();
        add_ball(mesh, {1.200f, 1.118f, side * 0.082f}, vec3(0.019f), 12, eye_black);
        rigid(head, first);
    }
    for (std::uint32_t k = 0; k < legs.size(); ++k)
        for (int toe = -2; toe <= 2; ++toe) {
            const std::size_t first = mesh.positions.size();
            const vec3 root(legs[k].end.x + (k < 2 ? 0.165f : 0.205f), 0.05f,
                            legs[k].side + 0.026f * static_cast<float>(toe));
            const std::array<TubeRing, 3> rings = {TubeRing{root, 0.011f},
                                                   TubeRing{root + vec3(0.03f, -0.008f, 0), 0.008f},
                                                   TubeRing{root + vec3(0.055f, -0.032f, 0), 0.002f}};
            add_tube(mesh, rings, 6, claw);
            rigid(first_leg + 3 * k + 2, first);
        }
}

}  // namespace

Skeleton running(float stride) {
    const auto wave = [&](float at) { return std::cos(2.0f * pi * (stride - at)); };
    const float gathered = wave(0.97f);  // the hind feet come forwards under the belly
    Skeleton skeleton;
    const vec2 hip(-0.55f, 0.94f);
    const mat4 whole =
        moved({0.0f, -0.075f + 0.055f * wave(0.30f), 0.0f}) * hinged({0.0f, 0.9f}, {0.0f, 0.9f}, 0.075f * wave(0.28f));
    const auto joint = [&](std::uint32_t parent, vec2 rest, float angle) {
        return skeleton[parent] * hinged(rest, rest, angle);
    };
    skeleton[pelvis] = whole * hinged(hip, hip, 0.20f * gathered);
    skeleton[lumbar] = joint(pelvis, {-0.22f, 0.92f}, -0.22f * gathered);
    skeleton[thorax] = joint(lumbar, {0.14f, 0.94f}, -0.13f * gathered);
    skeleton[neck] = joint(thorax, {0.60f, 0.98f}, 0.12f * gathered + 0.06f + 0.05f * wave(0.1f));
    skeleton[head] = joint(neck, {0.96f, 1.08f}, 0.05f * gathered - 0.10f);
    for (std::uint32_t k = 0; k < legs.size(); ++k) {
        const Leg& leg = legs[k];
        const float since = stride - leg.touch - std::floor(stride - leg.touch);
        const Step step = step_at(leg, since);
        const vec2 root = applied(skeleton[leg.hangs], leg.root);
        vec2 end = leg.end + step.offset;
        const vec2 middle = middle_joint(leg, root, end);
        const std::uint32_t bone = first_leg + 3 * k;
        skeleton[bone] = hinged(leg.root, root, angle_of(middle - root) - angle_of(leg.middle - leg.root));
        skeleton[bone + 1] = hinged(leg.middle, middle, angle_of(end - middle) - angle_of(leg.end - leg.middle));
        skeleton[bone + 2] = hinged(leg.end, end, step.turn);
    }
    return skeleton;
}

Body body(float cell_m, std::uint32_t hairs) {
    const std::vector<RoundCone> all = cones();
    Body result;
    result.mesh = blob_mesh(all, 0.10f, cell_m, [](vec3 middle) {
        return middle.x > 1.38f ? static_cast<std::uint32_t>(nose_black) : static_cast<std::uint32_t>(skin);
    });
    for (std::uint32_t i = 0; i < result.mesh.positions.size(); ++i)
        result.bindings.push_back(bound(all, result.mesh.positions[i], i, 1));
    add_fur(result, all, hairs);
    add_features(result);
    return result;
}

void pose_body(const Body& body, const Skeleton& skeleton, const mat4& world_from_bear, vec3* positions,
               vec3* normals) {
    Skeleton world;
    for (std::size_t i = 0; i < bone_count; ++i) world[i] = world_from_bear * skeleton[i];
    constexpr std::size_t grain = 8192;
    const std::size_t grains = (body.bindings.size() + grain - 1) / grain;
    parallel_for(static_cast<std::int64_t>(grains), 0, [&](std::int64_t part) {
        const std::size_t first = static_cast<std::size_t>(part) * grain;
        for (std::size_t k = first; k < std::min(first + grain, body.bindings.size()); ++k) {
            const Body::Binding& binding = body.bindings[k];
            const mat4 matrix = binding.weights[0] * world[binding.bones[0]] +
                                binding.weights[1] * world[binding.bones[1]] +
                                binding.weights[2] * world[binding.bones[2]];
            const mat3 linear(matrix);
            const vec3 offset(matrix[3]);
            for (std::uint32_t i = binding.first_vertex; i < binding.first_vertex + binding.vertex_count; ++i) {
                positions[i] = linear * body.mesh.positions[i] + offset;
                normals[i] = glm::normalize(linear * body.mesh.normals[i]);
            }
        }
    });
}

}  // namespace sightlines::bear
