#include "techniques/scene/builtin_scenes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_set>

#include <gtest/gtest.h>

#include "techniques/base/error.h"
#include "techniques/base/random.h"

namespace sightlines {
namespace {

const SceneModel& model_called(const std::string& name) {
    const auto& models = builtin_scenes();
    return *std::find_if(models.begin(), models.end(), [&](const SceneModel& model) { return model.name == name; });
}

dvec3 face(const Scene& scene, std::size_t triangle) {
    const uvec3 vertices = scene.triangles[triangle];
    const dvec3 a(scene.positions[vertices.x]);
    return glm::cross(dvec3(scene.positions[vertices.y]) - a, dvec3(scene.positions[vertices.z]) - a);
}

vec3 middle(const Scene& scene, std::size_t triangle) {
    const uvec3 vertices = scene.triangles[triangle];
    return (scene.positions[vertices.x] + scene.positions[vertices.y] + scene.positions[vertices.z]) / 3.0f;
}

/// Whether the ray straight up from `point` meets a triangle.
bool covered_from_above(const Scene& scene, vec3 point) {
    for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
        const uvec3 vertices = scene.triangles[i];
        const vec3 a = scene.positions[vertices.x] - point, b = scene.positions[vertices.y] - point,
                   c = scene.positions[vertices.z] - point;
        const float ab = a.x * b.z - a.z * b.x, bc = b.x * c.z - b.z * c.x, ca = c.x * a.z - c.z * a.x;
        const bool inside = (ab > 0 && bc > 0 && ca > 0) || (ab < 0 && bc < 0 && ca < 0);
        if (inside && (bc * a.y + ca * b.y + ab * c.y) / (ab + bc + ca) > 0.0f) return true;
    }
    return false;
}

}  // namespace

/// What holds for every built-in scene.
struct BuiltinScene : testing::TestWithParam<const char*> {
    const SceneModel& model = model_called(GetParam());
    const Scene scene = model.at(0.0);
};

TEST_P(BuiltinScene, HasConsistentArrays) {
    EXPECT_EQ(scene.name, GetParam());
    EXPECT_EQ(scene.normals.size(), scene.positions.size());
    EXPECT_EQ(scene.triangle_materials.size(), scene.triangles.size());
    EXPECT_FALSE(model.about.empty());
    ASSERT_FALSE(scene.cameras.empty());
    EXPECT_EQ(scene.cameras[0].name, "default");
    EXPECT_FALSE(scene.lights.empty());
    EXPECT_TRUE(scene.notes.empty());
    std::vector<bool> used(scene.positions.size(), false);
    for (const uvec3 vertices : scene.triangles) {
        for (int i = 0; i < 3; ++i) {
            ASSERT_LT(vertices[i], scene.positions.size());
            used[vertices[i]] = true;
        }
    }
    for (const std::uint32_t material : scene.triangle_materials) ASSERT_LT(material, scene.materials.size());
    for (const Material& material : scene.materials) {
        for (int i = 0; i < 3; ++i) EXPECT_TRUE(material.base_color[i] >= 0.0f && material.base_color[i] <= 1.0f);
    }
}

TEST_P(BuiltinScene, HasUnitNormalsAndNoTriangleWithoutArea) {
    for (std::size_t i = 0; i < scene.positions.size(); ++i) {
        const vec3 p = scene.positions[i];
        ASSERT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
        ASSERT_NEAR(glm::length(scene.normals[i]), 1.0f, 1e-4f) << "vertex " << i;
    }
    for (std::size_t i = 0; i < scene.triangles.size(); ++i)
        ASSERT_GT(glm::length(face(scene, i)), 1e-9) << "triangle " << i;
}

TEST_P(BuiltinScene, IsWoundAsItsNormalsPoint) {
    for (const Part& part : scene.parts) {
        std::uint32_t wrong = 0;
        for (std::uint32_t i = part.first_triangle; i < part.first_triangle + part.triangle_count; ++i) {
            const uvec3 vertices = scene.triangles[i];
            const dvec3 normal = glm::normalize(face(scene, i));
            const vec3 sum = scene.normals[vertices.x] + scene.normals[vertices.y] + scene.normals[vertices.z];
            if (glm::dot(normal, dvec3(sum)) <= 0.0) ++wrong;
        }
        // Where a body bends, a few triangles in the fold turn over.
        EXPECT_LE(wrong, part.deforms ? part.triangle_count / 500 : 0) << part.name;
    }
}

TEST_P(BuiltinScene, GoesOnceAlongEachSideOfAnEdge) {
    // Two triangles that share an edge of the same vertices and are wound alike pass it in opposite directions.
    std::unordered_set<std::uint64_t> edges;
    edges.reserve(scene.triangles.size() * 3);
    for (const uvec3 vertices : scene.triangles) {
        for (int i = 0; i < 3; ++i) {
            const std::uint64_t edge = (std::uint64_t{vertices[i]} << 32u) | vertices[(i + 1) % 3];
            ASSERT_TRUE(edges.insert(edge).second) << vertices[i] << " to " << vertices[(i + 1) % 3];
        }
    }
}

TEST_P(BuiltinScene, HasTightBoundsWithItsLightsAndCamerasInReach) {
    Box3 bounds;
    for (const uvec3 vertices : scene.triangles) {
        for (int i = 0; i < 3; ++i) bounds.add(scene.positions[vertices[i]]);
    }
    EXPECT_EQ(scene.bounds, bounds);
    const bool moves = std::ranges::any_of(scene.parts, [](const Part& part) { return part.moves || part.deforms; });
    EXPECT_TRUE(moves || scene.motion_bounds == bounds);
    for (const double time_s : {0.0, 0.31 * model.duration_s, 0.77 * model.duration_s}) {
        if (!moves && time_s > 0.0) continue;
        const Scene at_time = model.at(time_s);
        EXPECT_TRUE(glm::all(glm::greaterThanEqual(at_time.bounds.lowest, scene.motion_bounds.lowest))) << time_s;
        EXPECT_TRUE(glm::all(glm::lessThanEqual(at_time.bounds.highest, scene.motion_bounds.highest))) << time_s;
    }
    EXPECT_FALSE(scene.light_volume.empty());
    EXPECT_LT(scene.light_volume.diagonal(), bounds.diagonal());
    for (const Camera& camera : scene.cameras) {
        EXPECT_GT(glm::distance(camera.position, camera.target), 1.0f);
        EXPECT_LT(glm::distance(camera.position, bounds.centre()), 2.0f * bounds.diagonal());
    }
}

TEST_P(BuiltinScene, IsCoveredByItsPartsInOrder) {
    std::uint32_t next = 0;
    for (const Part& part : scene.parts) {
        EXPECT_EQ(part.first_triangle, next) << part.name;
        EXPECT_GT(part.triangle_count, 0u) << part.name;
        EXPECT_FALSE(part.name.empty());
        next += part.triangle_count;
    }
    EXPECT_EQ(next, scene.triangles.size());
}

TEST_P(BuiltinScene, RepeatsEachMeshExactlyInItsInstances) {
    const Scene later = model.at(0.4 * model.duration_s);
    std::map<std::uint32_t, const Part*> first_of_mesh;
    for (const Part& part : later.parts) {
        const Part& first = *first_of_mesh.try_emplace(part.mesh, &part).first->second;
        ASSERT_EQ(part.triangle_count, first.triangle_count) << part.name;
        const mat4 part_from_world = glm::inverse(part.world_from_part),
                   first_from_world = glm::inverse(first.world_from_part);
        for (std::uint32_t i = 0; i < part.triangle_count; i += 7) {
            const vec3 here = later.positions[later.triangles[part.first_triangle + i].x];
            const vec3 there = later.positions[later.triangles[first.first_triangle + i].x];
            ASSERT_LT(glm::distance(vec3(part_from_world * vec4(here, 1)), vec3(first_from_world * vec4(there, 1))),
                      1e-4f)
                << part.name << ", triangle " << i;
        }
    }
}

TEST_P(BuiltinScene, IsTheSameEachTimeAndMovesOnlyThePartsThatSaySo) {
    const Scene again = model.at(0.0), later = model.at(0.2 * model.duration_s);
    EXPECT_EQ(scene.positions, again.positions);
    EXPECT_EQ(scene.lights, again.lights);
    EXPECT_EQ(scene.triangles, later.triangles);
    EXPECT_EQ(later.time_s, 0.2 * model.duration_s);
    ASSERT_EQ(scene.parts.size(), later.parts.size());
    for (std::size_t i = 0; i < scene.parts.size(); ++i) {
        const Part& part = scene.parts[i];
        EXPECT_EQ(part.moves, later.parts[i].moves);
        EXPECT_EQ(part.deforms, later.parts[i].deforms);
        EXPECT_FALSE(part.moves && part.deforms);
        EXPECT_EQ(part.world_from_part == later.parts[i].world_from_part, !part.moves) << part.name;
        bool same = true;
        for (std::uint32_t k = part.first_triangle; k < part.first_triangle + part.triangle_count; ++k)
            same = same && scene.positions[scene.triangles[k].x] == later.positions[scene.triangles[k].x];
        EXPECT_EQ(same, !part.moves && !part.deforms) << part.name;
    }
}

TEST_P(BuiltinScene, LoopsAfterItsDuration) {
    if (model.duration_s == 0.0) {
        EXPECT_EQ(model.at(5.0).lights, scene.lights);
        return;
    }
    const double time_s = 0.3 * model.duration_s;
    const Scene once = model.at(time_s), twice = model.at(time_s + model.duration_s);
    ASSERT_EQ(once.positions.size(), twice.positions.size());
    for (std::size_t i = 0; i < once.positions.size(); ++i)
        ASSERT_LT(glm::distance(once.positions[i], twice.positions[i]), 1e-3f) << "vertex " << i;
    ASSERT_EQ(once.lights.size(), twice.lights.size());
    bool changes = scene.positions != once.positions;
    for (std::size_t i = 0; i < once.lights.size(); ++i) {
        EXPECT_NEAR(glm::length(once.lights[i].direction), 1.0f, 1e-5f);
        EXPECT_LT(glm::distance(once.lights[i].direction, twice.lights[i].direction), 1e-5f);
        EXPECT_LT(glm::distance(once.lights[i].position, twice.lights[i].position), 1e-3f);
        EXPECT_LT(glm::distance(once.lights[i].intensity, twice.lights[i].intensity), 1e-2f);
        changes = changes || once.lights[i] != scene.lights[i];
    }
    EXPECT_TRUE(changes);
}

INSTANTIATE_TEST_SUITE_P(Scenes, BuiltinScene,
                         testing::Values("cornell", "atrium", "trees", "garden", "cathedral", "planes", "bear",
                                         "bear_full", "park", "tv", "street"),
                         [](const auto& test) { return std::string(test.param); });

/// Outdoors by day: the first light is the sun, which moves and stays up; nothing else does.
struct SunnyScene : testing::TestWithParam<const char*> {};

TEST_P(SunnyScene, HasASunThatMovesAndStaysUp) {
    const SceneModel& model = model_called(GetParam());
    const Scene scene = model.at(0.0), later = model.at(5.0);
    EXPECT_GT(glm::distance(scene.lights[0].direction, later.lights[0].direction), 0.05f);
    EXPECT_LT(later.lights[0].direction.y, -0.3f);
    for (std::size_t i = 1; i < scene.lights.size(); ++i) EXPECT_EQ(scene.lights[i], later.lights[i]) << "light " << i;
}

INSTANTIATE_TEST_SUITE_P(Scenes, SunnyScene, testing::Values("atrium", "trees", "garden", "street"),
                         [](const auto& test) { return std::string(test.param); });

TEST(BuiltinScenes, HaveTheTriangleCountsThatTheyAreKnownBy) {
    EXPECT_EQ(model_called("cornell").at(0.0).triangles.size(), 38u);
    const std::vector<std::pair<const char*, double>> known = {
        {"atrium", 260000.0},     {"trees", 626000.0},  {"garden", 416000.0},
        {"cathedral", 456000.0},  {"planes", 982000.0}, {"bear", 152000.0},
        {"bear_full", 1486000.0}, {"park", 499000.0},   {"street", 2800000.0},
    };
    for (const auto& [name, count] : known)
        EXPECT_NEAR(static_cast<double>(model_called(name).at(0.0).triangles.size()), count, 0.03 * count) << name;
}

TEST(BuiltinScenes, AreListedInOrder) {
    std::vector<std::string> names;
    for (const SceneModel& model : builtin_scenes()) names.push_back(model.name);
    EXPECT_EQ(names, (std::vector<std::string>{"cornell", "atrium", "trees", "garden", "cathedral", "planes", "bear",
                                               "bear_full", "park", "tv", "street"}));
}

TEST(BuiltinScenes, AreFoundByName) {
    Progress progress;
    EXPECT_EQ(find_scene("trees", progress).name, "trees");
}

TEST(BuiltinScenes, OfferTheNearestNameForAnUnknownOne) {
    Progress progress;
    try {
        find_scene("atrum", progress);
        FAIL() << "accepted";
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("did you mean atrium?"), std::string::npos) << error.what();
    }
    try {
        find_scene("something/else.obj", progress);
        FAIL() << "accepted";
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("built in are cornell, atrium, trees"), std::string::npos)
            << error.what();
    }
}

TEST(BuiltinScenes, TakeAPathWithAGltfEndingAsAFile) {
    Progress progress;
    EXPECT_THROW(find_scene("no such folder/scene.GLB", progress), InputError);
    try {
        find_scene("no such folder/scene.gltf", progress);
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("scene.gltf"), std::string::npos) << error.what();
    }
}

TEST(Cornell, HasTheMeasuredRoomWithTheRedWallOnTheLeft) {
    const Scene scene = model_called("cornell").at(0.0);
    EXPECT_EQ(scene.bounds.lowest, vec3(0.0f));
    EXPECT_LT(glm::distance(scene.bounds.highest, vec3(5.56f, 5.488f, 5.592f)), 1e-4f);
    const Camera& camera = scene.cameras[0];
    EXPECT_NEAR(camera.vertical_field_of_view_deg, 39.31f, 0.01f);
    const vec3 right = glm::cross(camera.target - camera.position, camera.up);
    for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
        const std::string& name = scene.materials[scene.triangle_materials[i]].name;
        const float side = glm::dot(middle(scene, i) - scene.bounds.centre(), right);
        EXPECT_TRUE(name != "red" || side < 0.0f);
        EXPECT_TRUE(name != "green" || side > 0.0f);
    }
}

TEST(Cornell, FacesIntoTheRoomAndOutOfTheBlocks) {
    const Scene scene = model_called("cornell").at(0.0);
    for (const Part& part : scene.parts) {
        const bool block = part.name == "short block" || part.name == "tall block";
        Box3 box;
        for (std::uint32_t i = 0; i < part.triangle_count; ++i) box.add(middle(scene, part.first_triangle + i));
        const vec3 centre = block ? vec3(box.centre().x, 0.5f * box.highest.y, box.centre().z) : scene.bounds.centre();
        for (std::uint32_t i = part.first_triangle; i < part.first_triangle + part.triangle_count; ++i) {
            const double outwards = glm::dot(face(scene, i), dvec3(middle(scene, i) - centre));
            EXPECT_EQ(outwards > 0.0, block) << part.name << ", triangle " << i;
        }
    }
}

TEST(Cornell, ShinesFromUnderItsLamp) {
    const Scene scene = model_called("cornell").at(0.0);
    for (const Light& light : scene.lights) {
        EXPECT_EQ(light.kind, LightKind::spot);
        EXPECT_EQ(light.direction, vec3(0.0f, -1.0f, 0.0f));
        EXPECT_TRUE(light.position.x > 2.13f && light.position.x < 3.43f);
        EXPECT_TRUE(light.position.z > 2.27f && light.position.z < 3.32f);
        EXPECT_TRUE(light.position.y < 5.488f && light.position.y > 5.4f);
    }
}

TEST(Atrium, HasColumnsThatFaceOutwards) {
    const Scene scene = model_called("atrium").at(0.0);
    int columns = 0;
    for (const Part& part : scene.parts) {
        if (part.name != "column") continue;
        ++columns;
        const vec3 axis(part.world_from_part[3]);
        for (std::uint32_t i = part.first_triangle; i < part.first_triangle + part.triangle_count; ++i) {
            const vec3 from_axis = middle(scene, i) - axis;
            const dvec3 normal = glm::normalize(face(scene, i));
            ASSERT_GT(glm::dot(normal, dvec3(from_axis.x, 0.0, from_axis.z)), -1e-3) << "triangle " << i;
        }
    }
    EXPECT_EQ(columns, 36);
}

TEST(Atrium, HasItsLightVolumeUnderTheOpenSky) {
    const Scene scene = model_called("atrium").at(0.0);
    for (std::uint32_t i = 0; i < 24; ++i) {
        const vec3 unit(random_unit(9, i, 0), random_unit(9, i, 1), random_unit(9, i, 2));
        const vec3 point = scene.light_volume.lowest + unit * scene.light_volume.size();
        EXPECT_FALSE(covered_from_above(scene, point)) << point.x << " " << point.y << " " << point.z;
    }
    EXPECT_TRUE(covered_from_above(scene, {0.0f, 1.0f, 7.0f}));  // the galleries are roofed
}

TEST(Trees, AreADozenOrMoreStandingOnTheGround) {
    const Scene scene = model_called("trees").at(0.0);
    const Part& ground = scene.parts.front();
    ASSERT_EQ(ground.name, "ground");
    int trees = 0;
    for (const Part& part : scene.parts) {
        if (part.name == "ground" || part.name == "grass" || part.name == "stone") continue;
        ++trees;
        Box3 box;
        for (std::uint32_t i = part.first_triangle; i < part.first_triangle + part.triangle_count; ++i)
            box.add(middle(scene, i));
        EXPECT_GT(box.size().y, 6.0f) << part.name;
        // The foot of the trunk is a little below the ground right there.
        const vec3 foot(part.world_from_part[3]);
        EXPECT_TRUE(covered_from_above(scene, foot - vec3(0.001f, 0.1f, 0.001f)));
        EXPECT_LT(box.lowest.y, foot.y + 0.1f) << part.name;
    }
    EXPECT_GE(trees, 12);
}

}  // namespace sightlines
