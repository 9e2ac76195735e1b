// Rays against the array: wide against scalar, pictures against single rays, parameters, threads and tiles.
#include <gtest/gtest.h>

#include "techniques/base/error.h"
#include "techniques/voxel_rows/query.h"
#include "techniques/voxel_rows/voxel_rows.h"
#include "tests/voxel_rows/scenes.h"

namespace sightlines::voxel_rows {
namespace {

RowArray small_array(const Scene& scene, int resolution = 64) {
    BuildOptions options;
    options.resolution = resolution;
    options.angle_step_deg = 6.0;
    Progress progress;
    return build_from_fragments(scene, options, progress);
}

/// A picture-sized sheet of surface points inside the scene with random normals; some pixels show nothing.
SurfaceBuffer random_surfaces(const Box3& box, ImageSize size) {
    SurfaceBuffer surfaces;
    surfaces.size = size;
    for (std::uint32_t k = 0; k < size.pixels(); ++k) {
        const bool background = random_unit(11, k, 9) < 0.1f;
        surfaces.position.push_back(background ? vec3(0.0f) : testing::random_point(box, 11, k));
        surfaces.normal.push_back(background ? vec3(0.0f)
                                             : sphere_direction(random_unit(12, k, 0), random_unit(12, k, 1)));
        surfaces.shading_normal.push_back(surfaces.normal.back());
        surfaces.albedo.push_back(background ? vec3(0.0f) : vec3(0.5f));
        surfaces.emission.push_back(vec3(0.0f));
        surfaces.triangle.push_back(background ? no_triangle : 0u);
    }
    return surfaces;
}

std::vector<Light> random_lights(const Box3& box, std::uint32_t count) {
    std::vector<Light> lights(count);
    for (std::uint32_t k = 0; k < count; ++k) lights[k].position = testing::random_point(box, 13, k);
    return lights;
}

class VoxelRowsWide : public ::testing::TestWithParam<int> {};

TEST_P(VoxelRowsWide, AgreesWithTheScalarKernelOnEveryOneOfAMillionRays) {
    const Scene scene = testing::scattered_triangles(150, 5);
    const RowArray array = small_array(scene, GetParam());
    constexpr std::uint32_t count = 1'000'003;  // not a multiple of the width
    std::vector<Segment> segments(count);
    std::vector<vec3> normals(count);
    std::vector<std::uint8_t> wide(count);
    for (std::uint32_t k = 0; k < count; ++k) {
        segments[k] = {testing::random_point(scene.bounds, 14, k), testing::random_point(scene.bounds, 15, k)};
        if (k % 5 == 0) segments[k].target += vec3(30.0f, -20.0f, 10.0f);  // outside the bounds
        normals[k] = sphere_direction(random_unit(16, k, 0), random_unit(16, k, 1));
    }
    for (const double subrays : {1.0, 2.0}) {
        const Light outside{.position = vec3(100.0f)};
        const RowShape query = make_query(array, {{"subrays", subrays}}, std::span(&outside, 1));
        ASSERT_EQ(query.clip_to_bounds, 1);
        are_blocked(array, query, segments, normals, wide);
        std::uint32_t blocked = 0;
        for (std::uint32_t k = 0; k < count; ++k) {
            ASSERT_EQ(wide[k] != 0, is_blocked(array, query, segments[k], normals[k])) << "ray " << k;
            blocked += wide[k];
        }
        EXPECT_GT(blocked, count / 10);
        EXPECT_LT(blocked, count - count / 10);
    }
}

INSTANTIATE_TEST_SUITE_P(RowLengths, VoxelRowsWide, ::testing::Values(32, 50, 100, 150));

TEST(VoxelRowsQuery, BlocksRaysThroughAWallAndPassesThoseBesideIt) {
    const Scene scene = testing::wall_in_a_box(2.0f);
    const RowArray array = small_array(scene);
    const RowShape query = make_query(array, {}, {});
    for (std::uint32_t k = 0; k < 5000; ++k) {
        const vec3 from(-1.8f, 1.4f * random_unit(1, k, 0) - 0.7f, 1.4f * random_unit(1, k, 1) - 0.7f);
        const vec3 to(1.8f, 1.4f * random_unit(1, k, 2) - 0.7f, 1.4f * random_unit(1, k, 3) - 0.7f);
        ASSERT_TRUE(is_blocked(array, query, {from, to}, vec3(1, 0, 0)));
        const vec3 beside(1.8f, 1.8f, to.z);
        ASSERT_FALSE(is_blocked(array, query, {vec3(-1.8f, 1.8f, from.z), beside}, vec3(1, 0, 0)));
        ASSERT_FALSE(is_blocked(array, query, {from, vec3(-1.0f, to.y, to.z)}, vec3(1, 0, 0))) << "stops short of it";
    }
}

TEST(VoxelRowsQuery, LeavesOutTheVoxelsOfTheOffsets) {
    const Scene scene = testing::wall_in_a_box(2.0f);
    const RowArray array = small_array(scene);
    const Segment through{vec3(-0.3f, 0.0f, 0.0f), vec3(1.5f, 0.0f, 0.0f)};  // voxels are about 0.06 m wide
    const auto blocked = [&](double start, double light, Segment ray) {
        const RowShape query =
            make_query(array, {{"start_offset", start}, {"light_offset", light}, {"normal_offset", 0.0}}, {});
        return is_blocked(array, query, ray, vec3(1, 0, 0));
    };
    EXPECT_TRUE(blocked(0.0, 0.0, through));
    EXPECT_TRUE(blocked(2.0, 0.0, through));
    EXPECT_FALSE(blocked(8.0, 0.0, through));
    const Segment backwards{through.target, through.origin};
    EXPECT_TRUE(blocked(8.0, 2.0, backwards));
    EXPECT_FALSE(blocked(0.0, 8.0, backwards));
}

TEST(VoxelRowsQuery, LooksUpARowForEachHalfWhereTwoAreAsked) {
    const Scene scene = testing::scattered_triangles(150, 6);
    const RowArray array = small_array(scene);
    const RowShape one = make_query(array, {}, {});
    const RowShape two = make_query(array, {{"subrays", 2.0}}, {});
    int different = 0;
    for (std::uint32_t k = 0; k < 20000; ++k) {
        const Segment ray{testing::random_point(scene.bounds, 21, k), testing::random_point(scene.bounds, 22, k)};
        const vec3 normal = sphere_direction(random_unit(23, k, 0), random_unit(23, k, 1));
        const vec3 a = ray.origin + normal * two.normal_offset_m, middle = 0.5f * (a + ray.target);
        // Each half by hand, in the direction of the whole ray.
        const scalar_kernel::Direction direction = scalar_kernel::discretize_direction(two, ray.target - a);
        const DirectionFrame& frame =
            array.grid.frames[static_cast<std::size_t>(scalar_kernel::frame_index(two, direction))];
        const scalar_kernel::Rows rows{array.words.words.data()};
        const bool halves =
            scalar_kernel::span_is_blocked(
                two, rows, scalar_kernel::locate_span(two, frame, direction, a, middle, two.start_offset, 0.0f)) ||
            scalar_kernel::span_is_blocked(
                two, rows,
                scalar_kernel::locate_span(two, frame, direction, middle, ray.target, 0.0f, two.light_offset));
        ASSERT_EQ(is_blocked(array, two, ray, normal), halves);
        different += halves != is_blocked(array, one, ray, normal);
    }
    EXPECT_GT(different, 100);
}

struct Picture {
    Scene scene = testing::scattered_triangles(150, 7);
    RowArray array = small_array(scene);
    SurfaceBuffer surfaces = random_surfaces(scene.bounds, {77, 45});
    std::vector<Light> lights = random_lights(scene.bounds, 37);

    RenderRequest request() const {
        RenderRequest request;
        request.surfaces = &surfaces;
        request.lights = lights;
        request.keep_verdicts = true;
        return request;
    }
    RenderResult render(const RenderRequest& request) const {
        Progress progress;
        return render_on_cpu(array, request, progress);
    }
};

TEST(VoxelRowsPicture, HoldsTheScalarKernelsAnswerForEveryPixelAndLight) {
    const Picture picture;
    const RenderResult result = picture.render(picture.request());
    const RowShape query = make_query(picture.array, {}, picture.lights);
    std::uint64_t asked_in_all = 0;
    for (std::size_t pixel = 0; pixel < picture.surfaces.size.pixels(); ++pixel) {
        std::uint32_t asked = 0, blocked = 0;
        for (std::uint32_t light = 0; light < picture.lights.size(); ++light) {
            const Segment ray{picture.surfaces.position[pixel], picture.lights[light].position};
            const bool in_front = picture.surfaces.triangle[pixel] != no_triangle &&
                                  glm::dot(picture.surfaces.normal[pixel], ray.target - ray.origin) > 0.0f;
            const bool expected = in_front && is_blocked(picture.array, query, ray, picture.surfaces.normal[pixel]);
            ASSERT_EQ(result.verdicts.blocked(pixel, light), expected) << pixel << ' ' << light;
            asked += in_front;
            blocked += expected;
        }
        ASSERT_EQ(result.rays_asked.pixels[pixel], asked);
        const float share = asked == 0 ? 0.0f : static_cast<float>(blocked) / static_cast<float>(asked);
        ASSERT_FLOAT_EQ(result.shadow.pixels[pixel], share);
        asked_in_all += asked;
    }
    EXPECT_EQ(result.rays, asked_in_all);
    EXPECT_EQ(count_blocked_on_cpu(picture.array, picture.request()).rays, asked_in_all);
}

TEST(VoxelRowsPicture, IsTheSameForAnyThreadsTilesAndRefinement) {
    const Picture picture;
    RenderRequest request = picture.request();
    request.threads = 2;
    const RenderResult two = picture.render(request);
    request.threads = 1;
    const RenderResult one = picture.render(request);
    request.reverse_tiles = true;
    const RenderResult reversed = picture.render(request);
    int regions = 0;
    request.on_region = [&](const RenderResult&, PixelRect) { ++regions; };
    const RenderResult refined = picture.render(request);
    EXPECT_GT(regions, 1);
    for (const RenderResult* other : {&one, &reversed, &refined}) {
        EXPECT_EQ(two.radiance, other->radiance);
        EXPECT_EQ(two.shadow, other->shadow);
        EXPECT_EQ(two.verdicts.words, other->verdicts.words);
    }
}

TEST(VoxelRowsPicture, LightsASurfaceInTheOpenAsTheInverseSquareLawSays) {
    Picture picture;
    picture.scene = testing::wall_in_a_box(0.5f);
    picture.array = small_array(picture.scene);
    picture.surfaces = random_surfaces(picture.scene.bounds, {1, 1});
    picture.surfaces.triangle[0] = 0;
    picture.surfaces.position[0] = vec3(1.0f, -1.0f, 0.0f);
    picture.surfaces.normal[0] = picture.surfaces.shading_normal[0] = vec3(0.0f, 1.0f, 0.0f);
    picture.surfaces.albedo[0] = vec3(0.5f, 0.25f, 1.0f);
    picture.lights = {Light{.position = vec3(1.0f, 1.0f, 0.0f), .intensity = vec3(8.0f)}};
    const vec3 radiance = picture.render(picture.request()).radiance.pixels[0];
    const float irradiance = 8.0f / 4.0f;  // I cos / d^2
    EXPECT_NEAR(radiance.r, 0.5f * irradiance / 3.14159265f, 1e-5f);
    EXPECT_NEAR(radiance.g, 0.25f * irradiance / 3.14159265f, 1e-5f);
    EXPECT_NEAR(radiance.b, 1.0f * irradiance / 3.14159265f, 1e-5f);
}

TEST(VoxelRowsPicture, IsDarkWithoutLights) {
    Picture picture;
    picture.lights.clear();
    const RenderResult result = picture.render(picture.request());
    EXPECT_EQ(result.rays, 0u);
    for (const vec3& radiance : result.radiance.pixels) ASSERT_EQ(radiance, vec3(0.0f));
}

TEST(VoxelRowsPicture, StopsWhenCancelled) {
    const Picture picture;
    Progress progress;
    progress.cancel();
    EXPECT_THROW(render_on_cpu(picture.array, picture.request(), progress), Cancelled);
}

}  // namespace
}  // namespace sightlines::voxel_rows
