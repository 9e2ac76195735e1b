// Where rays first hit: analytic walls, the naive walk along the row, and the two compilations against each other.
#include "techniques/voxel_rows/first_hits.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include <gtest/gtest.h>

#include "shaders/voxel_rows_first_hit.h"
#include "techniques/compute/device.h"
#include "techniques/voxel_rows/dictionary.h"
#include "techniques/voxel_rows/hit_effects.h"
#include "techniques/voxel_rows/query.h"
#include "techniques/voxel_rows/voxel_rows.h"
#include "techniques/voxel_rows/vulkan_first_hits.h"
#include "tests/voxel_rows/scenes.h"

namespace sightlines::voxel_rows {
namespace {

BuildOptions small_build() {
    BuildOptions options;
    options.resolution = 64;
    options.angle_step_deg = 3.0;
    options.threads = 2;
    return options;
}

void add_square(Scene& scene, vec3 corner, vec3 along, vec3 across) {
    testing::add_triangle(scene, corner, corner + along, corner + along + across);
    testing::add_triangle(scene, corner, corner + along + across, corner + across);
}

/// Two walls across x, at 0 and at 8 m, 6 m high and wide.
Scene two_walls() {
    Scene scene;
    add_square(scene, {0.0f, 0.0f, 0.0f}, {0.0f, 6.0f, 0.0f}, {0.0f, 0.0f, 6.0f});
    add_square(scene, {8.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 6.0f}, {0.0f, 6.0f, 0.0f});
    Scene whole = testing::finished(scene);
    whole.materials[0].double_sided = true;
    whole.materials[0].base_color = {0.2f, 0.4f, 0.8f};
    return whole;
}

/// The same as the kernel, voxel after voxel instead of by halves.
float walked(const RowArray& array, const RowShape& query, const Segment& segment, vec3 normal) {
    namespace kernel = scalar_kernel;
    const vec3 origin = kernel::ray_origin(query, segment.origin, normal);
    vec3 a = origin, b = segment.target;
    const kernel::Direction direction = kernel::discretize_direction(query, b - a);
    kernel::clip_to_bounds(query, a, b);
    const DirectionFrame& frame = array.grid.frames[static_cast<std::size_t>(kernel::frame_index(query, direction))];
    const kernel::RowSpan span =
        kernel::locate_span(query, frame, direction, a, b, query.start_offset, -kernel::beyond_end);
    const auto words = row_words(array, span.row);
    const float from = voxel_coordinates(query, frame, origin).x;
    const float to = voxel_coordinates(query, frame, segment.target).x;
    const bool forward = to > from;
    for (int k = 0; k <= span.last - span.first; ++k) {
        const int u = forward ? span.first + k : span.last - k;
        if ((words[static_cast<std::size_t>(u / 32)] >> (u % 32) & 1u) == 0) continue;
        const float share = (static_cast<float>(u) + 0.5f - from) / (to - from);
        return std::clamp(share, 0.0f, 1.0f) * glm::distance(segment.origin, segment.target);
    }
    return std::numeric_limits<float>::infinity();
}

std::vector<Segment> random_segments(const Box3& bounds, std::size_t count) {
    std::vector<Segment> segments;
    for (std::uint32_t k = 0; k < count; ++k) {
        const auto point = [&](std::uint32_t first) {
            return bounds.lowest + bounds.size() * vec3(random_unit(7, k, first), random_unit(7, k, first + 1),
                                                        random_unit(7, k, first + 2));
        };
        segments.push_back({point(0), point(3)});
    }
    return segments;
}

TEST(FirstHits, AWallIsWhereItIs) {
    Progress progress;
    const Scene scene = two_walls();
    const RowArray array = build_from_fragments(scene, small_build(), progress);
    const RowShape query = make_query(array, {}, {});
    const float voxel_m = 8.0f / 64.0f;
    for (const float angle : {-0.5f, -0.3f, 0.0f, 0.2f, 0.45f}) {
        const vec3 direction(std::cos(angle), std::sin(angle), 0.0f);
        const Segment ray{{0.0f, 3.0f, 3.0f}, vec3(0.0f, 3.0f, 3.0f) + 20.0f * direction};
        if (std::abs(std::tan(angle)) * 8.0f > 2.8f) {
            EXPECT_TRUE(std::isinf(first_hit(array, query, ray, {1.0f, 0.0f, 0.0f}))) << angle;
            continue;
        }
        // Half a voxel for the voxel's middle, and what the row turns away from the ray over its half.
        EXPECT_NEAR(first_hit(array, query, ray, {1.0f, 0.0f, 0.0f}), 8.0f / std::cos(angle), 1.5f * voxel_m) << angle;
        const Segment back{{8.0f, 3.0f, 3.0f}, vec3(8.0f, 3.0f, 3.0f) - 20.0f * direction};
        EXPECT_NEAR(first_hit(array, query, back, {-1.0f, 0.0f, 0.0f}), 8.0f / std::cos(angle), 1.5f * voxel_m);
    }
}

TEST(FirstHits, BinarySearchFindsWhatWalkingFinds) {
    Progress progress;
    const Scene scene = testing::scattered_triangles(60, 3);
    for (const int resolution : {32, 48, 64, 130}) {
        BuildOptions options = small_build();
        options.resolution = resolution;
        options.angle_step_deg = 6.0;
        const RowArray array = build_from_fragments(scene, options, progress);
        const RowShape query = make_query(array, {}, {});
        const std::vector<Segment> segments = random_segments(scene.bounds, 501);
        const std::vector<vec3> normals(segments.size(), vec3(0.0f, 1.0f, 0.0f));
        std::vector<float> wide(segments.size());
        first_hits(array, query, segments, normals, wide);
        std::size_t hits = 0;
        for (std::size_t k = 0; k < segments.size(); ++k) {
            const float expected = walked(array, query, segments[k], normals[k]);
            EXPECT_FLOAT_EQ(first_hit(array, query, segments[k], normals[k]), expected) << k;
            EXPECT_FLOAT_EQ(wide[k], expected) << k;
            hits += std::isfinite(expected);
        }
        EXPECT_GT(hits, 50u);
        EXPECT_LT(hits, 480u);
    }
}

TEST(FirstHits, ARayHitsSomethingExactlyWhereItIsBlocked) {
    Progress progress;
    const Scene scene = testing::scattered_triangles(60, 3);
    const RowArray array = build_from_fragments(scene, small_build(), progress);
    RowShape query = make_query(array, {}, {});
    query.clip_to_bounds = 1;
    query.light_offset = -scalar_kernel::beyond_end;
    for (const Segment& segment : random_segments(scene.bounds, 500)) {
        const vec3 up(0.0f, 1.0f, 0.0f);
        EXPECT_EQ(std::isfinite(first_hit(array, query, segment, up)), is_blocked(array, query, segment, up));
    }
}

TEST(SurfaceVoxels, HoldTheColourAndTheNormalOfWhatIsThere) {
    Progress progress;
    const Scene scene = two_walls();
    const SurfaceVoxels voxels = voxelize_surface(scene, 64, 2, progress);
    const auto wall = surface_at(voxels, {7.95f, 3.0f, 3.0f});
    ASSERT_TRUE(wall);
    EXPECT_LT(glm::distance(wall->albedo, vec3(0.2f, 0.4f, 0.8f)), 0.01f);
    EXPECT_NEAR(std::abs(wall->normal.x), 1.0f, 0.01f);
    EXPECT_TRUE(surface_at(voxels, {7.8f, 3.0f, 3.0f}));   // the next voxel's
    EXPECT_FALSE(surface_at(voxels, {4.0f, 3.0f, 3.0f}));  // between the walls
}

/// One pixel: the middle of the wall at 0, seen from between the walls.
SurfaceBuffer one_pixel() {
    SurfaceBuffer surfaces;
    surfaces.size = {1, 1};
    surfaces.camera.position = {4.0f, 3.0f, 3.0f};
    surfaces.camera.target = {0.0f, 3.0f, 3.0f};
    surfaces.position = {{0.0f, 3.0f, 3.0f}};
    surfaces.normal = surfaces.shading_normal = {{1.0f, 0.0f, 0.0f}};
    surfaces.albedo = {vec3(0.5f)};
    surfaces.emission = {vec3(0.0f)};
    surfaces.triangle = {0};
    return surfaces;
}

TEST(HitEffects, AMirrorShowsTheWallBehindTheCamera) {
    Progress progress;
    const Scene scene = two_walls();
    const RowArray array = build_from_fragments(scene, small_build(), progress);
    const SurfaceBuffer mirrored = mirrored_surfaces(
        {array, make_query(array, {}, {})}, voxelize_surface(scene, 64, 2, progress), one_pixel(), 1, progress);
    ASSERT_EQ(mirrored.triangle[0], 0u);
    EXPECT_LT(glm::distance(mirrored.position[0], vec3(8.0f, 3.0f, 3.0f)), 0.25f);
    EXPECT_LT(glm::distance(mirrored.albedo[0], vec3(0.2f, 0.4f, 0.8f)), 0.01f);
    EXPECT_LT(mirrored.normal[0].x, -0.99f);
}

TEST(HitEffects, OcclusionCountsHitsByTheirDistance) {
    Progress progress;
    Scene scene;  // the wall opposite alone: a surface's own voxels would darken it a little
    add_square(scene, {8.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 6.0f}, {0.0f, 6.0f, 0.0f});
    scene.bounds.add(vec3(0.0f));
    scene = testing::finished(scene);
    const RowArray array = build_from_fragments(scene, small_build(), progress);
    const auto openness = [&](float reach_m) {
        const OcclusionOptions options{.rays = 256, .reach_m = reach_m};
        return ambient_openness({array, make_query(array, {}, {})}, one_pixel(), options, progress).pixels[0];
    };
    EXPECT_EQ(openness(4.0f), 1.0f);  // the wall is 8 m away
    // What it hides of the hemisphere: the form factor of a parallel rectangle, 6 m x 6 m at 8 m.
    EXPECT_NEAR(openness(10000.0f), 1.0f - 0.15096f, 0.02f);
    EXPECT_GT(openness(16.0f), openness(10000.0f) + 0.03f);
}

#define NEEDS_VULKAN                                                                       \
    if (compute::list_devices().empty() || !compute::list_devices().front().lacks.empty()) \
    GTEST_SKIP() << "no usable Vulkan device"

/// The array as it is, and with a dictionary whose indices take 20 and 32 bits.
std::vector<RowArray> arrays_to_ask(const Scene& scene, int resolution) {
    Progress progress;
    BuildOptions options = small_build();
    options.resolution = resolution;
    options.angle_step_deg = 6.0;
    const RowArray array = build_from_fragments(scene, options, progress);
    std::vector<RowArray> arrays{array};
    for (const bool packed : {true, false})
        arrays.push_back(compress(array, {.rows = 5000, .packed = packed}, progress));
    return arrays;
}

/// How many distances differ by more than rounding: at another voxel, or on one side alone.
std::ptrdiff_t other_hits(std::span<const float> here, std::span<const float> there) {
    std::ptrdiff_t others = 0;
    for (std::size_t k = 0; k < here.size(); ++k)
        others += here[k] != there[k] && !(std::abs(here[k] - there[k]) <= 1e-4f * here[k]);
    return others;
}

TEST(FirstHitsOnVulkan, AreThoseOfTheCpuButForRounding) {
    NEEDS_VULKAN;
    const Progress progress;
    Progress of_building;
    const Scene scene = testing::scattered_triangles(60, 3);
    const std::vector<Segment> segments = random_segments(scene.bounds, 20001);  // not whole workgroups
    const std::vector<vec3> normals(segments.size(), vec3(0.0f, 1.0f, 0.0f));
    for (const int resolution : {32, 64, 128})  // by words, and by texels where the device is the CPU
        for (const RowArray& array : arrays_to_ask(scene, resolution)) {
            const RowShape query = make_query(array, {}, {});
            std::vector<float> here(segments.size()), there(segments.size(), -1.0f);
            first_hits(array, query, segments, normals, here);
            first_hits_on_vulkan(*give_to_vulkan(array, of_building), query, segments, normals, there, progress);
            EXPECT_EQ(other_hits(here, there), 0)
                << resolution << " voxels, indices of " << query.index_bits << " bits";
            EXPECT_GT(std::ranges::count_if(there, [](float distance) { return std::isfinite(distance); }), 1000);
        }
}

TEST(FirstHitsOnVulkan, StopWhenCancelled) {
    NEEDS_VULKAN;
    Progress progress;
    const Scene scene = two_walls();
    const RowArray array = build_from_fragments(scene, small_build(), progress);
    const auto on_device = give_to_vulkan(array, progress);
    const std::vector<Segment> segments = random_segments(scene.bounds, 10);
    const std::vector<vec3> normals(segments.size(), vec3(1.0f, 0.0f, 0.0f));
    std::vector<float> distances(segments.size());
    progress.cancel();
    EXPECT_THROW(first_hits_on_vulkan(*on_device, make_query(array, {}, {}), segments, normals, distances, progress),
                 Cancelled);
}

/// Both walls of two_walls() as a camera between them sees them, in no order; every 40th pixel shows the background.
SurfaceBuffer small_picture() {
    SurfaceBuffer surfaces;
    surfaces.size = {61, 37};  // not whole groups of lines
    surfaces.camera.position = {4.0f, 3.0f, 3.0f};
    surfaces.camera.target = {0.0f, 3.0f, 3.0f};
    for (std::uint32_t k = 0; k < surfaces.size.pixels(); ++k) {
        const bool far = k % 2 != 0;
        const vec2 at = 0.5f + 5.0f * vec2(random_unit(21, k, 0), random_unit(21, k, 1));
        surfaces.position.push_back({far ? 8.0f : 0.0f, at.x, at.y});
        surfaces.normal.push_back({far ? -1.0f : 1.0f, 0.0f, 0.0f});
        surfaces.albedo.push_back(vec3(0.5f));
        surfaces.emission.push_back(vec3(0.0f));
        surfaces.triangle.push_back(k % 40 == 0 ? no_triangle : 0);
    }
    surfaces.shading_normal = surfaces.normal;
    return surfaces;
}

TEST(HitEffectsOnVulkan, AreThoseOfTheCpuAtEveryPixel) {
    NEEDS_VULKAN;
    Progress progress;
    const Scene scene = two_walls();
    const RowArray array = build_from_fragments(scene, small_build(), progress);
    const auto on_device = give_to_vulkan(array, progress);
    const HitQuery by_cpu{array, make_query(array, {}, {})}, by_device{array, by_cpu.shape, on_device.get()};
    const SurfaceBuffer surfaces = small_picture();
    const OcclusionOptions options{.rays = 64, .reach_m = 16.0f};
    const ImageScalar open = ambient_openness(by_cpu, surfaces, options, progress);
    const ImageScalar open_there = ambient_openness(by_device, surfaces, options, progress);
    for (std::size_t p = 0; p < open.pixels.size(); ++p) ASSERT_NEAR(open.pixels[p], open_there.pixels[p], 1e-5f) << p;
    EXPECT_LT(*std::ranges::min_element(open.pixels), 0.95f);
    const SurfaceVoxels voxels = voxelize_surface(scene, 64, 2, progress);
    const SurfaceBuffer here = mirrored_surfaces(by_cpu, voxels, surfaces, 1, progress);
    const SurfaceBuffer there = mirrored_surfaces(by_device, voxels, surfaces, 1, progress);
    EXPECT_EQ(here.triangle, there.triangle);
    EXPECT_EQ(here.albedo, there.albedo);
    for (std::size_t p = 0; p < here.position.size(); ++p)
        ASSERT_LT(glm::distance(here.position[p], there.position[p]), 1e-4f) << p;
    EXPECT_GT(std::ranges::count(here.triangle, 0u), 300);
}

/// A picture with ambient occlusion (1) or mirrors (2), the structure made for one backend and asked by another.
ImageRgb with_effect(double effect, Backend built_for, Backend backend) {
    const Scene scene = two_walls();
    Progress progress;
    BuildRequest build;
    build.scene = &scene;
    build.backend = built_for;
    build.parameters = {{"resolution", 64.0}, {"angle_step", 6.0}, {"first_hits", effect}};
    const Structure structure = technique().build(build, progress);
    const SurfaceBuffer surfaces = small_picture();
    std::vector<Light> lights(2);
    lights[0].position = {4.0f, 5.0f, 1.0f};
    lights[1].position = {3.0f, 1.0f, 5.0f};
    RenderRequest request;
    request.surfaces = &surfaces;
    request.lights = lights;
    request.parameters = build.parameters;
    request.backend = backend;
    return technique().render(structure, request, progress).radiance;
}

TEST(HitEffectsOnVulkan, ArePartOfThePictureWhateverTheStructureWasBuiltFor) {
    NEEDS_VULKAN;
    for (const double effect : {1.0, 2.0}) {
        const ImageRgb here = with_effect(effect, Backend::cpu, Backend::cpu);
        const ImageRgb plain = with_effect(0.0, Backend::cpu, Backend::cpu);
        for (const Backend built_for : {Backend::vulkan, Backend::cpu}) {
            const ImageRgb there = with_effect(effect, built_for, Backend::vulkan);
            std::size_t changed = 0;
            for (std::size_t p = 0; p < here.pixels.size(); ++p) {
                ASSERT_LE(glm::distance(here.pixels[p], there.pixels[p]), 1e-4f * glm::length(here.pixels[p]) + 1e-6f)
                    << p;
                changed += glm::distance(there.pixels[p], plain.pixels[p]) > 0.02f * glm::length(plain.pixels[p]);
            }
            EXPECT_GT(changed, here.pixels.size() / 3);
        }
    }
}

TEST(HitEffects, DirectionsFollowTheCosine) {
    const vec3 normal = glm::normalize(vec3(0.3f, -0.8f, 0.5f));
    vec3 mean(0.0f);
    double cosine = 0.0, squared = 0.0;
    constexpr int side = 64;
    for (int i = 0; i < side * side; ++i) {
        const float u = (static_cast<float>(i % side) + 0.5f) / side, v = (static_cast<float>(i / side) + 0.5f) / side;
        const vec3 direction = cosine_direction(normal, u, v);
        EXPECT_NEAR(glm::length(direction), 1.0f, 1e-4f);
        mean += direction / static_cast<float>(side * side);
        cosine += glm::dot(direction, normal) / (side * side);
        squared += std::pow(glm::dot(direction, normal), 2.0) / (side * side);
    }
    // Of the density cos / pi: E[cos] = 2/3, E[cos^2] = 1/2, and no side is preferred.
    EXPECT_NEAR(cosine, 2.0 / 3.0, 1e-3);
    EXPECT_NEAR(squared, 0.5, 1e-3);
    EXPECT_LT(glm::distance(mean, 2.0f / 3.0f * normal), 1e-2f);
}

}  // namespace
}  // namespace sightlines::voxel_rows
