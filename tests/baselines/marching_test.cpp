// The voxelization and the two marches through it, against tiny steps, each other and Embree.
#include <gtest/gtest.h>

#include "techniques/baselines/marching/voxel_grid.h"
#include "tests/baselines/pictures.h"

namespace sightlines::baselines {
namespace {

Voxelization voxelized(const Scene& scene, int resolution, VoxelShape shape = VoxelShape::fitted) {
    VoxelOptions options;
    options.resolution = resolution;
    options.shape = shape;
    options.distances = true;
    Progress progress;
    return voxelize(scene, options, progress);
}

TEST(RowDistances, CountTheVoxelsToTheNextOccupiedOne) {
    const std::vector<bool> row{false, false, true, false, true, true, false};
    std::vector<std::uint8_t> distances(row.size());
    row_distances(row, 1, distances);
    EXPECT_EQ(distances, (std::vector<std::uint8_t>{2, 1, 0, 1, 0, 0, 255}));
    row_distances(row, -1, distances);
    EXPECT_EQ(distances, (std::vector<std::uint8_t>{255, 255, 0, 1, 0, 0, 1}));
}

TEST(RowDistances, TellTheFarEndOfARowOf256FromNothing) {
    std::vector<bool> row(256, false);
    std::vector<std::uint8_t> distances(row.size());
    row_distances(row, 1, distances);
    EXPECT_EQ(distances[0], 255);
    row[255] = true;
    row_distances(row, 1, distances);
    EXPECT_EQ(distances[0], 254);
    EXPECT_EQ(distances[1], 254);
    EXPECT_EQ(distances[100], 155);
}

TEST(Voxelization, SetsTheVoxelsOfAWallAndNoOthers) {
    const Scene scene = testing::wall_in_a_box(2.0f);
    for (const VoxelShape shape : {VoxelShape::fitted, VoxelShape::cubes}) {
        const Voxelization voxels = voxelized(scene, 40, shape);
        ASSERT_EQ(voxels.cells, ivec3(40));
        for (int x = 0; x < 40; ++x)
            for (int y = 0; y < 40; ++y)
                for (int z = 0; z < 40; ++z) {
                    // The wall at x = 0 lies on the face between voxels 19 and 20, from 10 to 30 along y and z.
                    const bool inside = y >= 10 && y < 30 && z >= 10 && z < 30;
                    if (voxels.at({x, y, z})) {
                        ASSERT_TRUE(x == 19 || x == 20) << x;
                    }
                    if (inside && x == 20) {
                        ASSERT_TRUE(voxels.at({19, y, z}) || voxels.at({20, y, z})) << y << ' ' << z;
                    }
                }
        EXPECT_GE(voxels.occupied, 400u);
        EXPECT_LE(voxels.occupied, 500u);
    }
}

TEST(Voxelization, MakesCubesOrFitsTheBounds) {
    Scene scene = testing::scattered_triangles(50, 1);
    scene.bounds = {vec3(0.0f), vec3(8.0f, 4.0f, 1.0f)};
    const Voxelization cubes = voxelized(scene, 64, VoxelShape::cubes), fitted = voxelized(scene, 64);
    EXPECT_EQ(cubes.cells, ivec3(64, 32, 8));
    EXPECT_EQ(fitted.cells, ivec3(64));
    const vec3 side = cubes.box.size() / vec3(cubes.cells);
    EXPECT_NEAR(side.x, side.y, 1e-5f);
    EXPECT_NEAR(side.x, side.z, 1e-5f);
    EXPECT_NEAR(fitted.box.size().z, 1.0f, 1e-5f);
}

TEST(Voxelization, GivesAFlatSceneALayer) {
    Scene scene;
    testing::add_quad(scene, {0, 0, 0}, {4, 0, 0}, {0, 0, 4});
    for (const VoxelShape shape : {VoxelShape::fitted, VoxelShape::cubes}) {
        const Voxelization voxels = voxelized(testing::finished(scene), 32, shape);
        EXPECT_GE(voxels.occupied, 32u * 32u);
        const VoxelGrid query = make_query(voxels, {{"start_offset", 0.0}, {"light_offset", 0.0}});
        EXPECT_TRUE(is_blocked_by_voxels(voxels, query, {{1, 1, 1}, {1.2f, -1, 1.1f}}, vec3(0, 1, 0)));
    }
}

struct Rays {
    std::vector<Segment> segments;
    std::vector<vec3> normals;

    Rays(const Box3& box, std::uint32_t count) : segments(count), normals(count) {
        for (std::uint32_t k = 0; k < count; ++k) {
            segments[k] = {testing::random_point(box, 14, k), testing::random_point(box, 15, k)};
            if (k % 5 == 0) segments[k].target += vec3(30.0f, -20.0f, 10.0f);  // outside the bounds
            if (k % 7 == 0) segments[k].target.y = segments[k].origin.y;       // within a layer
            if (k % 11 == 0) segments[k].target.x = segments[k].origin.x;
            normals[k] = sphere_direction(random_unit(16, k, 0), random_unit(16, k, 1));
            if (k % 7 == 0 || k % 11 == 0) normals[k] = vec3(0, 0, 1);
        }
    }
};

constexpr std::uint32_t ray_count = 100'003;  // not a multiple of the width

class Marches : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Resolutions, Marches, ::testing::Values(32, 45, 128, 256));

TEST_P(Marches, AnswerWideAsScalarOnEveryOfAHundredThousandRays) {
    const Scene scene = testing::scattered_triangles(150, 5);
    const Voxelization voxels = voxelized(scene, GetParam());
    const VoxelGrid query = make_query(voxels, {});
    const Rays rays(scene.bounds, ray_count);
    std::vector<std::uint8_t> wide(ray_count);
    for (const March march : {March::voxels, March::rows}) {
        are_blocked(voxels, query, march, rays.segments, rays.normals, wide);
        std::uint32_t blocked = 0;
        for (std::uint32_t k = 0; k < ray_count; ++k) {
            const bool scalar = march == March::voxels
                                    ? is_blocked_by_voxels(voxels, query, rays.segments[k], rays.normals[k])
                                    : is_blocked_by_rows(voxels, query, rays.segments[k], rays.normals[k]);
            ASSERT_EQ(wide[k] != 0, scalar) << "ray " << k;
            blocked += wide[k];
        }
        EXPECT_GT(blocked, ray_count / 10);
        EXPECT_LT(blocked, ray_count - ray_count / 10);
    }
}

TEST_P(Marches, AgreeWithEachOtherButForRoundingAtCorners) {
    const Scene scene = testing::scattered_triangles(150, 6);
    const Voxelization voxels = voxelized(scene, GetParam());
    const VoxelGrid query = make_query(voxels, {});
    const Rays rays(scene.bounds, ray_count);
    std::uint32_t different = 0;
    for (std::uint32_t k = 0; k < ray_count; ++k)
        different += is_blocked_by_voxels(voxels, query, rays.segments[k], rays.normals[k]) !=
                     is_blocked_by_rows(voxels, query, rays.segments[k], rays.normals[k]);
    EXPECT_LE(different, 20u);
}

/// The voxels that thousands of tiny steps along the segment fall into.
bool is_blocked_by_tiny_steps(const Voxelization& voxels, const Segment& segment) {
    constexpr int steps = 4000;
    const dvec3 size = dvec3(voxels.box.size()) / dvec3(voxels.cells);
    for (int i = 0; i <= steps; ++i) {
        const dvec3 point = glm::mix(dvec3(segment.origin), dvec3(segment.target), static_cast<double>(i) / steps);
        const dvec3 place = (point - dvec3(voxels.box.lowest)) / size;
        const ivec3 voxel(glm::floor(place));
        if (glm::any(glm::lessThan(voxel, ivec3(0))) || glm::any(glm::greaterThanEqual(voxel, voxels.cells))) continue;
        if (voxels.at(voxel)) return true;
    }
    return false;
}

TEST(Marching, VisitsTheVoxelsThatTinyStepsVisit) {
    const Scene scene = testing::scattered_triangles(150, 9);
    const Voxelization voxels = voxelized(scene, 64);
    const VoxelGrid query = make_query(voxels, {{"start_offset", 0.0}, {"light_offset", 0.0}, {"normal_offset", 0.0}});
    constexpr std::uint32_t count = 3000;
    const Rays rays(scene.bounds, count);
    std::uint32_t missed = 0, more = 0;
    for (std::uint32_t k = 0; k < count; ++k) {
        const bool expected = is_blocked_by_tiny_steps(voxels, rays.segments[k]);
        const bool marched = is_blocked_by_voxels(voxels, query, rays.segments[k], vec3(0, 1, 0));
        missed += expected && !marched;
        more += marched && !expected;
    }
    EXPECT_LE(missed, 1u);  // by rounding
    EXPECT_LE(more, 6u);    // a voxel whose corner is cut by less than a tiny step
}

TEST(Marching, LeavesOutTheVoxelsOfTheOffsets) {
    const Scene scene = testing::wall_in_a_box(2.0f);
    const Voxelization voxels = voxelized(scene, 64);
    const auto blocked = [&](double start, double light, Segment ray) {
        const VoxelGrid query =
            make_query(voxels, {{"start_offset", start}, {"light_offset", light}, {"normal_offset", 0.0}});
        EXPECT_EQ(is_blocked_by_voxels(voxels, query, ray, vec3(1, 0, 0)),
                  is_blocked_by_rows(voxels, query, ray, vec3(1, 0, 0)));
        return is_blocked_by_voxels(voxels, query, ray, vec3(1, 0, 0));
    };
    const Segment through{vec3(-0.3f, 0.0f, 0.0f), vec3(1.5f, 0.0f, 0.0f)};  // voxels are about 0.06 m wide
    EXPECT_TRUE(blocked(0.0, 0.0, through));
    EXPECT_TRUE(blocked(2.0, 0.0, through));
    EXPECT_FALSE(blocked(8.0, 0.0, through));
    const Segment backwards{through.target, through.origin};
    EXPECT_TRUE(blocked(8.0, 2.0, backwards));
    EXPECT_FALSE(blocked(0.0, 8.0, backwards));
    EXPECT_FALSE(blocked(8.0, 8.0, {vec3(-0.3f, 0, 0), vec3(0.3f, 0, 0)})) << "the offsets leave nothing";
}

TEST(Marching, ErrsLessTheFinerTheVoxels) {
    const Scene scene = testing::scattered_triangles(60, 3);
    const SurfaceBuffer surfaces = testing::seen_surfaces(scene, {80, 60});
    const std::vector<Light> lights = testing::random_lights(scene.bounds, 40);
    for (const Technique* technique : {&voxel_marching(), &row_marching()}) {
        double coarser = 100.0;
        for (const double resolution : {32.0, 64.0, 128.0, 256.0}) {
            const double error =
                testing::visibility_error(*technique, scene, surfaces, lights, {{"resolution", resolution}});
            EXPECT_LT(error, 0.8 * coarser) << resolution;
            coarser = error;
        }
        EXPECT_LT(coarser, 6.0);
    }
}

TEST(MarchingTrace, WalksFromVoxelToNeighbouringVoxel) {
    const Scene scene = testing::wall_in_a_box(2.0f);
    const Voxelization voxels = voxelized(scene, 32);
    const Light light{.position = {1.5f, 0.7f, -0.9f}};
    const Trace trace = trace_march(voxels, March::voxels, {{-1.5f, 0.0f, 0.0f}, {1, 0, 0}, light, {}});
    ASSERT_TRUE(trace.blocked);
    std::vector<vec3> places;
    for (const TraceStep& step : trace.steps)
        for (const TraceValue& value : step.values)
            if (value.name == "place") places.push_back(std::get<vec3>(value.value));
    ASSERT_GT(places.size(), 8u);
    for (std::size_t k = 1; k < places.size(); ++k) {
        const vec3 step = glm::abs(places[k] - places[k - 1]);
        EXPECT_EQ(step.x + step.y + step.z, 1.0f) << "step " << k;
    }
    EXPECT_TRUE(voxels.at(ivec3(places.back()))) << "it ends in the wall";
}

TEST(MarchingTrace, ShowsThePartOfEachRowThatTheRayPasses) {
    const Scene scene = testing::wall_in_a_box(2.0f);
    const Voxelization voxels = voxelized(scene, 32);
    const Light light{.position = {-1.0f, 1.7f, -0.9f}};
    const Trace trace = trace_march(voxels, March::rows, {{-1.5f, 0.0f, 0.0f}, {1, 0, 0}, light, {}});
    EXPECT_FALSE(trace.blocked);
    int rows = 0;
    for (const TraceStep& step : trace.steps) {
        for (const TraceGeometry& shape : step.geometry) {
            if (shape.name != "part of the row") continue;
            ++rows;
            for (const vec3 corner : {shape.points[0], shape.points[0] + shape.points[1]})
                EXPECT_TRUE(corner.x >= -2.001f && corner.x <= 2.001f);
        }
    }
    // 1.7 m along y and 0.9 m along z in voxels of 0.125 m, less the offsets.
    EXPECT_GE(rows, 17);
    EXPECT_LE(rows, 23);
}

}  // namespace
}  // namespace sightlines::baselines
