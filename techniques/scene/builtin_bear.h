// The built-in bear: its body, the bones under it and how they run; builtin_bear.cpp puts it on its meadow.
#pragma once

#include <array>

#include "techniques/scene/builtin_blob.h"

namespace sightlines::bear {

/// Indices into materials().
enum MaterialIndex : std::uint32_t {
    skin,
    fur_dark,
    fur_mid,
    fur_light,
    fur_muzzle,
    nose_black,
    eye_black,
    claw,
    meadow,
    meadow_dark,
    meadow_light,
    earth,
    blade_dark,
    blade_mid,
    blade_light,
    blade_dry,
    rock,
    bark,
    needle_dark,
    needle_mid,
    needle_light,
    flower_white,
    flower_yellow,
};

std::vector<Material> materials();

/// The trunk's five bones, and three for each of four legs: front left, front right, hind left, hind right.
enum Bone : std::uint32_t { pelvis, lumbar, thorax, neck, head, first_leg };
constexpr std::size_t bone_count = first_leg + 4 * 3;

/// Where each bone's matrix takes the body's points as they stand at rest. The bear looks along +x, stands on y = 0.
using Skeleton = std::array<mat4, bone_count>;

/// The gait: gallop, one stride as `stride` goes from 0 to 1 and round.
Skeleton running(float stride);
/// How far one stride carries, m: planted feet do not slide.
constexpr float stride_m = 3.1416f;

/// A body bound to its bones. Its vertices come in runs that move with one mixture of bones: a run of one on the skin,
/// of five in a hair.
struct Body {
    Mesh mesh;  ///< at rest
    struct Binding {
        std::uint32_t first_vertex = 0, vertex_count = 1;
        std::array<std::uint32_t, 3> bones{};
        std::array<float, 3> weights{};
    };
    std::vector<Binding> bindings;
};

/// `cell_m`: the skin's resolution; `hairs`: three triangles each.
Body body(float cell_m, std::uint32_t hairs);

/// The body in a pose: positions and normals of all its vertices, to world space.
void pose_body(const Body& body, const Skeleton& skeleton, const mat4& world_from_bear, vec3* positions, vec3* normals);

}  // namespace sightlines::bear
