#include "techniques/scene/builtin_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include <gtest/gtest.h>

#include "techniques/scene/builtin_blob.h"

namespace sightlines {
namespace {

/// By the divergence theorem, m^3; that of the enclosed space where the mesh is closed and faces outwards.
double volume(const Mesh& mesh) {
    double sum = 0.0;
    for (const uvec3 t : mesh.triangles)
        sum += glm::dot(dvec3(mesh.positions[t.x]), glm::cross(dvec3(mesh.positions[t.y]), dvec3(mesh.positions[t.z])));
    return sum / 6.0;
}

double area(const Mesh& mesh) {
    double sum = 0.0;
    for (const uvec3 t : mesh.triangles) {
        const dvec3 a(mesh.positions[t.x]);
        sum += 0.5 * glm::length(glm::cross(dvec3(mesh.positions[t.y]) - a, dvec3(mesh.positions[t.z]) - a));
    }
    return sum;
}

/// Whether each edge between places is passed as often one way as the other.
bool is_closed(const Mesh& mesh) {
    const auto place = [&](std::uint32_t vertex) {
        const vec3 p = glm::round(1e4f * mesh.positions[vertex]);
        return std::array<float, 3>{p.x + 0.0f, p.y + 0.0f, p.z + 0.0f};
    };
    std::map<std::pair<std::array<float, 3>, std::array<float, 3>>, int> passes;
    for (const uvec3 t : mesh.triangles)
        for (int i = 0; i < 3; ++i) {
            const auto a = place(t[i]), b = place(t[(i + 1) % 3]);
            if (a != b) a < b ? ++passes[{a, b}] : --passes[{b, a}];
        }
    return std::ranges::all_of(passes, [](const auto& edge) { return edge.second == 0; });
}

}  // namespace

TEST(Shapes, ABeamIsAClosedBoxOfItsSize) {
    Mesh mesh;
    add_beam(mesh, {1, 2, 3}, {4, 2, 7}, 0.5f, 0.25f, 0);
    EXPECT_TRUE(is_closed(mesh));
    EXPECT_NEAR(volume(mesh), 5.0 * 0.5 * 0.25, 1e-4);
}

TEST(Shapes, RodsBallsAndBulbsAreClosedAndFaceOutwards) {
    Mesh rod, ball, bulb;
    add_rod(rod, {0, 1, 0}, {0, 3, 2}, 0.5f, 24, 0);
    add_ball(ball, {1, 2, 3}, {1, 2, 0.5f}, 48, 0);
    add_octahedron(bulb, {5, 5, 5}, 1.0f, 0);
    for (const Mesh* mesh : {&rod, &ball, &bulb}) EXPECT_TRUE(is_closed(*mesh));
    EXPECT_NEAR(volume(rod), std::numbers::pi * 0.25 * std::sqrt(8.0), 0.03 * volume(rod));
    EXPECT_NEAR(volume(ball), 4.0 / 3.0 * std::numbers::pi, 0.03 * volume(ball));
    EXPECT_NEAR(volume(bulb), 4.0 / 3.0, 1e-4);
}

TEST(Shapes, ACushionIsABoxWithoutItsEdges) {
    Mesh mesh;
    add_cushion(mesh, {{-1, 0, -1}, {1, 1, 1}}, 0.2f, 6, 0);
    EXPECT_TRUE(is_closed(mesh));
    Box3 box;
    for (const vec3 position : mesh.positions) box.add(position);
    EXPECT_LT(glm::distance(box.lowest, vec3(-1, 0, -1)) + glm::distance(box.highest, vec3(1)), 1e-5f);
    // A box, its twelve edges rounded: quarter cylinders along them and one ball in the corners.
    const double r = 0.2, core = 1.6 * 1.6 * 0.6, slabs = 2 * r * (1.6 * 1.6 + 2 * 1.6 * 0.6);
    const double expected =
        core + slabs + std::numbers::pi * r * r * (1.6 + 1.6 + 0.6) + 4.0 / 3.0 * std::numbers::pi * r * r * r;
    EXPECT_NEAR(volume(mesh), expected, 0.01 * expected);
}

TEST(Shapes, ASweepAlongALineIsAPrismWithItsProfilesArea) {
    const std::array<vec3, 3> path = {vec3(0, 0, 0), vec3(1, 0, 0), vec3(3, 0, 0)};
    const std::array<vec2, 6> corner = {vec2(0, 0), vec2(2, 0), vec2(2, 1),
                                        vec2(1, 1), vec2(1, 2), vec2(0, 2)};  // an L
    Mesh mesh;
    add_sweep(mesh, path, {0, 1, 0}, corner, false, 0);
    EXPECT_TRUE(is_closed(mesh));
    EXPECT_NEAR(volume(mesh), 3.0 * 3.0, 1e-4);
}

TEST(Shapes, AnOutlineOfAnyShapeIsFilledOnce) {
    const std::array<vec3, 8> star = {vec3(0, 3, 0),  vec3(-0.5f, 0.5f, 0), vec3(-3, 0, 0), vec3(-0.5f, -0.5f, 0),
                                      vec3(0, -3, 0), vec3(0.5f, -0.5f, 0), vec3(3, 0, 0),  vec3(0.5f, 0.5f, 0)};
    Mesh mesh;
    add_outline(mesh, star, 0);
    EXPECT_EQ(mesh.triangles.size(), 6u);
    EXPECT_NEAR(area(mesh), 6.0, 1e-5);
    for (const vec3 normal : mesh.normals) EXPECT_EQ(normal, vec3(0, 0, 1));
}

TEST(Shapes, ABlobOfOneBallIsThatBall) {
    const std::array<RoundCone, 1> ball = {RoundCone{{0.3f, 0.1f, 0}, {0.3f, 0.1f, 0}, 0.5f, 0.5f, 0}};
    const Mesh mesh = blob_mesh(ball, 0.05f, 0.04f, [](vec3) { return 3u; });
    EXPECT_TRUE(is_closed(mesh));
    EXPECT_NEAR(volume(mesh), 4.0 / 3.0 * std::numbers::pi * 0.125, 0.02);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const vec3 out = mesh.positions[i] - vec3(0.3f, 0.1f, 0);
        ASSERT_NEAR(glm::length(out), 0.5f, 0.01f);
        ASSERT_GT(glm::dot(glm::normalize(out), mesh.normals[i]), 0.95f);
    }
    for (const std::uint32_t material : mesh.materials) ASSERT_EQ(material, 3u);
}

TEST(Shapes, ABlobOfTwoBallsMeltsWhereTheyMeet) {
    const std::array<RoundCone, 2> balls = {RoundCone{{-0.4f, 0, 0}, {-0.4f, 0, 0}, 0.45f, 0.45f, 0},
                                            RoundCone{{0.4f, 0, 0}, {0.4f, 0, 0}, 0.45f, 0.45f, 1}};
    const auto waist = [&](float blend_m) {
        const Mesh mesh = blob_mesh(balls, blend_m, 0.04f, [](vec3) { return 0u; });
        EXPECT_TRUE(is_closed(mesh));
        float thinnest = 1.0f;
        for (const vec3 p : mesh.positions)
            if (std::abs(p.x) < 0.03f) thinnest = std::min(thinnest, glm::length(vec2(p.y, p.z)));
        return thinnest;
    };
    EXPECT_NEAR(waist(0.02f), std::sqrt(0.45f * 0.45f - 0.16f), 0.05f);
    EXPECT_GT(waist(0.4f), waist(0.02f) + 0.08f);
}

TEST(Shapes, SmoothNoiseHasNoJumps) {
    float lowest = 1.0f, highest = 0.0f;
    for (int i = 0; i < 4000; ++i) {
        const vec2 place(-7.0f + 0.0035f * static_cast<float>(i), 2.3f);
        const float here = smooth_noise(place, 5), near = smooth_noise(place + vec2(0.0035f, 0), 5);
        ASSERT_NEAR(here, near, 0.01f) << place.x;
        lowest = std::min(lowest, here);
        highest = std::max(highest, here);
    }
    EXPECT_GE(lowest, 0.0f);
    EXPECT_LE(highest, 1.0f);
    EXPECT_GT(highest - lowest, 0.4f);
}

}  // namespace sightlines
