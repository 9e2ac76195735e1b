// Light of surfaces that shine, against closed forms and one segment after the other.
#include "techniques/visibility_field/area_lights.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include <gtest/gtest.h>

#include "shaders/area_light.h"
#include "techniques/base/hammersley.h"
#include "techniques/visibility_field/area_sight.h"
#include "techniques/visibility_field/glossy.h"
#include "techniques/visibility_field/ray_order.h"
#include "techniques/visibility_field/visibility_field.h"
#include "tests/visibility_field/scenes.h"

namespace sightlines::visibility_field {
namespace {

constexpr float pi = std::numbers::pi_v<float>;
constexpr ImageSize size{40, 24};

/// Materials: 0 is lit and does not shine, 1 shines to its front only, 2 to both sides.
Scene scene_with_lamps(vec3 emission) {
    Scene scene = testing::one_sided_scene();
    Material lamp;
    lamp.emissive = emission;
    lamp.double_sided = false;
    scene.materials.push_back(lamp);
    lamp.double_sided = true;
    scene.materials.push_back(lamp);
    return scene;
}

void add_floor(Scene& scene) { test::add_quad(scene, {-4, 0, -4}, {0, 0, 8}, {8, 0, 0}); }

/// A square of 1.5 m at height 2 that faces down, or up.
void add_square(Scene& scene, std::uint32_t material, bool down = true) {
    const vec3 x(1.5f, 0, 0), z(0, 0, 1.5f);
    test::add_quad(scene, {-0.75f, 2.0f, -0.75f}, down ? x : z, down ? z : x, material);
}

Camera over_the_floor() { return test::camera_at({0.5f, 1.6f, 5.0f}, {0.0f, 0.3f, 0.0f}); }

/// A picture with area lights alone: the surroundings are black.
struct Asked {
    Scene scene;
    Camera camera;
    std::shared_ptr<const EmbreeScene> embree = test::built(scene);
    SurfaceBuffer surfaces = test::seen(scene, *embree, camera, size);
    SamplePattern pattern = make_pattern(16, 1);
    EnvironmentRequest request{};
    int samples = 64;
    const VisibilityField* field = nullptr;
    const AreaSight* sight = nullptr;
    Progress progress{};

    Asked(Scene made, const Camera& seen_by) : scene(std::move(made)), camera(seen_by) {
        request.surfaces = &surfaces;
        request.pattern = &pattern;
        request.threads = 2;
    }
    EnvironmentResult picture() {
        EnvironmentResult result = blank_environment(request);
        add_area_lights(field, sight, *embree, scene, find_area_lights(scene), request, samples, result, progress);
        return result;
    }
    bool shows(std::size_t pixel) const { return surfaces.triangle[pixel] != no_triangle; }
    bool shows_dark(std::size_t pixel) const { return shows(pixel) && surfaces.emission[pixel] == vec3(0.0f); }
};

/// Lambert 1760: what a polygon of radiance 1 brings to a surface that it is wholly in front of. Its corners go round
/// so that it faces the surface.
float lambert(const std::vector<vec3>& corners, vec3 position, vec3 normal) {
    vec3 sum(0.0f);
    for (std::size_t k = 0; k < corners.size(); ++k) {
        const vec3 a = glm::normalize(corners[k] - position);
        const vec3 b = glm::normalize(corners[(k + 1) % corners.size()] - position);
        sum += std::acos(glm::clamp(glm::dot(a, b), -1.0f, 1.0f)) * glm::normalize(glm::cross(a, b));
    }
    return std::fabs(0.5f * glm::dot(sum, normal));
}

std::vector<vec3> square_corners(float from_x = -0.75f) {
    return {{from_x, 2, -0.75f}, {0.75f, 2, -0.75f}, {0.75f, 2, 0.75f}, {from_x, 2, 0.75f}};
}

TEST(AreaLights, ASquareBringsWhatLambertsFormulaSays) {
    Scene scene = scene_with_lamps(vec3(2.0f, 1.0f, 0.5f));
    add_floor(scene);
    add_square(scene, 1);
    Asked asked(scene, over_the_floor());
    asked.samples = 256;
    const EnvironmentResult result = asked.picture();
    int compared = 0;
    double sum = 0.0, sum_expected = 0.0;
    for (std::size_t p = 0; p < size.pixels(); ++p) {
        if (!asked.shows_dark(p)) continue;
        const float expected = lambert(square_corners(), asked.surfaces.position[p], vec3(0, 1, 0));
        const vec3 found = result.irradiance.pixels[p];
        ASSERT_NEAR(found.y, expected, 0.03f * expected) << p;
        ASSERT_NEAR(found.x, 2.0f * found.y, 1e-4f);
        ASSERT_NEAR(found.z, 0.5f * found.y, 1e-4f);
        ASSERT_LT(glm::distance(result.radiance.pixels[p], found * asked.surfaces.albedo[p] / pi), 1e-5f);
        sum += found.y;
        sum_expected += expected;
        ++compared;
    }
    EXPECT_GT(compared, 300);
    EXPECT_NEAR(sum, sum_expected, 0.001 * sum_expected);
}

TEST(AreaLights, NoPointBringsMoreThanAQuarterOfLightAllAround) {
    const auto adds = [](float distance_m) {
        return scalar_kernel::segment_adds(vec3(2.0f), 0.8f, 0.5f, distance_m, 4.0f).x;
    };
    EXPECT_FLOAT_EQ(adds(1.0f), 0.2f);
    EXPECT_FLOAT_EQ(adds(0.01f), 2.0f * pi / 4.0f);
}

TEST(AreaLights, InABoxWhoseWallsAllShineTheIrradianceIsPi) {
    for (const std::uint32_t material : {1u, 2u}) {
        Scene scene = scene_with_lamps(vec3(1.0f));
        test::add_box(scene, vec3(-1.0f), vec3(1.0f), material);
        if (material == 1)  // boxes face outwards
            for (uvec3& triangle : scene.triangles) std::swap(triangle.y, triangle.z);
        Asked asked(scene, test::camera_at({0.9f, 0.8f, 0.9f}, vec3(-0.2f)));
        asked.samples = 2048;  // so many that few are near enough to be bounded
        const EnvironmentResult result = asked.picture();
        double sum = 0.0;
        for (std::size_t p = 0; p < size.pixels(); ++p) {
            ASSERT_TRUE(asked.shows(p));
            sum += result.irradiance.pixels[p].x;
            EXPECT_NEAR(result.radiance.pixels[p].x,
                        1.0f + asked.surfaces.albedo[p].x / pi * result.irradiance.pixels[p].x, 1e-4f);
        }
        EXPECT_NEAR(sum / static_cast<double>(size.pixels()), pi, 0.01 * pi);
    }
}

TEST(AreaLights, ThatAreNotDoubleSidedShineToTheirFrontOnly) {
    for (const std::uint32_t material : {1u, 2u}) {
        Scene scene = scene_with_lamps(vec3(1.0f));
        add_floor(scene);
        add_square(scene, material, false);
        Asked asked(scene, over_the_floor());
        asked.samples = 256;
        const EnvironmentResult result = asked.picture();
        for (std::size_t p = 0; p < size.pixels(); ++p) {
            if (!asked.shows_dark(p)) continue;
            const float expected = lambert(square_corners(), asked.surfaces.position[p], vec3(0, 1, 0));
            ASSERT_NEAR(result.irradiance.pixels[p].x, material == 2 ? expected : 0.0f, 0.03f * expected) << p;
        }
        EXPECT_EQ(result.area_rays.traced > 0, material == 2);
        EXPECT_EQ(result.area_rays.samples - result.area_rays.below, result.area_rays.traced);
    }
}

Scene shadowed_scene() {
    Scene scene = scene_with_lamps(vec3(3.0f, 2.0f, 1.0f));
    add_floor(scene);
    add_square(scene, 1);
    test::add_box(scene, {-2.0f, 0.0f, -1.5f}, {-1.2f, 1.4f, -0.5f});
    test::add_sphere(scene, {0.6f, 0.9f, 0.4f}, 0.4f, 16);
    scene.texture_coordinates[0].clear();
    return scene;
}

/// The same points one by one, each asked by the reference's own segment, in double precision.
dvec3 irradiance_one_by_one(const Asked& asked, const AreaLights& lights, std::size_t p) {
    const SurfaceBuffer& surfaces = asked.surfaces;
    const vec3 here = surfaces.position[p], up = surfaces.shading_normal[p];
    dvec3 sum(0.0);
    for (int k = 0; k < asked.samples; ++k) {
        const vec2 even = hammersley(static_cast<std::uint32_t>(k), static_cast<std::uint32_t>(asked.samples));
        const AreaPoint point = draw_point(lights, glm::fract(even + point_shift(asked.request, p)));
        const AreaTriangle& light = lights.triangles[point.at];
        const vec3 towards = point.position - here;
        const double distance = glm::length(towards);
        const vec3 direction = towards / static_cast<float>(distance);
        const double there = -glm::dot(light.normal, direction), cosine = glm::dot(up, direction);
        if (there <= 0.0 || cosine <= 0.0 || glm::dot(surfaces.normal[p], direction) <= 0.0f) continue;
        if (occluded(*asked.embree, {here, point.position + 1e-4f * light.normal}, surfaces.normal[p])) continue;
        vec3 share(1.0f);
        if (asked.request.glossy) {
            const vec3 side = glm::normalize(glm::cross(up, std::fabs(up.x) < 0.9f ? vec3(1, 0, 0) : vec3(0, 1, 0)));
            const mat3 frame(side, glm::cross(up, side), up);
            const vec3 to_eye = glm::normalize(asked.camera.position - here) * frame;
            share = pi * reflected_share(make_gloss(surfaces.albedo[p], asked.request.roughness, 0.0f), to_eye,
                                         direction * frame);
        }
        sum += dvec3(share * emission_at(asked.scene, light.triangle, point.barycentric)) * cosine * there /
               (distance * distance * double{light.per_m2} * asked.samples);
    }
    return sum;
}

TEST(AreaLights, CastTheShadowsThatSegmentsOneByOneFind) {
    for (const bool glossy : {false, true}) {
        Asked asked(shadowed_scene(), over_the_floor());
        asked.request.glossy = glossy;
        asked.request.roughness = glossy ? 0.3f : 0.0f;
        asked.samples = 32;
        const EnvironmentResult result = asked.picture();
        const AreaLights lights = find_area_lights(asked.scene);
        int differ = 0, compared = 0;
        for (std::size_t p = 0; p < size.pixels(); ++p) {
            if (!asked.shows_dark(p)) continue;
            const vec3 expected(irradiance_one_by_one(asked, lights, p));
            differ += glm::distance(result.irradiance.pixels[p], expected) > 1e-3f * glm::length(expected) + 1e-6f;
            ++compared;
        }
        EXPECT_GT(compared, 300);
        EXPECT_LE(differ, 4) << glossy;  // segments that graze an edge
        EXPECT_GT(result.area_rays.traced_blocked, 1000u);
        EXPECT_LT(result.area_rays.traced_blocked, result.area_rays.traced / 2);
    }
}

/// The courtyard under the sky, with a lamp at a wall and a small one over the ground.
Scene lit_courtyard() {
    Scene scene = testing::courtyard();
    Material lamp;
    lamp.emissive = vec3(5.0f, 4.0f, 3.0f);
    lamp.double_sided = false;
    scene.materials.push_back(lamp);
    const auto shines = static_cast<std::uint32_t>(scene.materials.size() - 1);
    test::add_quad(scene, {-1.0f, 1.8f, -3.98f}, {1.0f, 0.0f, 0.0f}, {0.0f, 0.6f, 0.0f}, shines);
    test::add_quad(scene, {2.4f, 1.5f, 1.0f}, {0.3f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.3f}, shines);
    scene.texture_coordinates[0].clear();
    return scene;
}

struct Baked {
    CellPoints points;
    VisibilityField field;
    AreaSight sight;

    Baked(const Scene& scene, const EmbreeScene& embree, int rays, int threads = 2) {
        Progress progress;
        field = bake(scene, embree, testing::small_bake(), progress, &points);
        sight = bake_area_sight(scene, field, embree, points, {.rays = rays, .threads = threads}, progress);
    }
};

double rmse(const EnvironmentResult& a, const EnvironmentResult& b) {
    double squares = 0.0;
    for (std::size_t p = 0; p < size.pixels(); ++p) {
        const vec3 apart = a.irradiance.pixels[p] - b.irradiance.pixels[p];
        squares += double{glm::dot(apart, apart)} / 3.0;
    }
    return std::sqrt(squares / static_cast<double>(size.pixels()));
}

double mean(const EnvironmentResult& result) {
    double sum = 0.0;
    for (const vec3 each : result.irradiance.pixels) sum += double{each.x + each.y + each.z} / 3.0;
    return sum / static_cast<double>(size.pixels());
}

TEST(AreaLights, NeedFewerRaysByWhatCellsKnowAndLookAlmostTheSame) {
    Asked asked(lit_courtyard(), testing::courtyard_camera());
    const EnvironmentResult all = asked.picture();
    const Baked baked(asked.scene, *asked.embree, 64);
    asked.field = &baked.field;
    asked.sight = &baked.sight;
    const EnvironmentResult some = asked.picture();
    EXPECT_EQ(all.area_rays.samples, size.pixels() * 64 - 64 * static_cast<std::uint64_t>(std::ranges::count(
                                                                   asked.surfaces.triangle, no_triangle)));
    EXPECT_EQ(some.area_rays.samples, all.area_rays.samples);
    EXPECT_EQ(some.area_rays.below, all.area_rays.below);
    EXPECT_EQ(all.area_rays.discarded(), 0u);
    EXPECT_LT(some.area_rays.traced, all.area_rays.traced / 2);
    EXPECT_GT(some.area_rays.traced_blocked, 100u);
    EXPECT_LT(rmse(some, all), 0.03 * mean(all));
    std::uint64_t traced = 0;
    for (const std::uint32_t each : some.rays_traced.pixels) traced += each;
    EXPECT_EQ(traced, some.area_rays.traced);
}

TEST(AreaLights, AreAsWithoutAFieldWhereCellsKnowNothing) {
    Asked asked(lit_courtyard(), testing::courtyard_camera());
    const EnvironmentResult all = asked.picture();
    const Baked baked(asked.scene, *asked.embree, 0);
    EXPECT_EQ(baked.sight.words, 0u);
    EXPECT_EQ(baked.sight.bytes(), 0u);
    asked.field = &baked.field;
    asked.sight = &baked.sight;
    const EnvironmentResult some = asked.picture();
    EXPECT_EQ(some.irradiance, all.irradiance);
    EXPECT_EQ(some.area_rays, all.area_rays);
}

TEST(AreaSight, SaysOfACellWhatItsPointsSee) {
    const Scene scene = lit_courtyard();
    const auto embree = test::built(scene);
    const Baked baked(scene, *embree, 64);
    const AreaLights lights = find_area_lights(scene);
    ASSERT_EQ(lights.parts.size(), 4u);
    int known = 0, wrong = 0;
    for (std::size_t k = 0; k < baked.points.cells.size(); ++k) {
        const SurfacePoint& point = baked.points.points[baked.points.first[k]];
        const std::uint32_t cell =
            scalar_kernel::locate_cell(baked.field.shape, {baked.field.bricks.data()}, point.position, point.normal)
                .index;
        const std::size_t place = baked.sight.place(cell, side_of(point.normal));
        for (std::uint32_t part = 0; part < 4; ++part) {
            const bool seen = baked.sight.seen(place, part), hidden = baked.sight.hidden(place, part);
            if (seen == hidden) continue;
            const vec2 range = lights.parts[part];
            const AreaPoint there = draw_point(lights, {0.5f * (range.x + range.y), 0.4f});
            if (!segment_to(lights, there, point.position, point.normal, lift_m(*embree)).faces) continue;
            const vec3 end = there.position + 1e-4f * lights.triangles[there.at].normal;
            wrong += occluded(*embree, {point.position, end}, point.normal) != hidden;
            ++known;
        }
    }
    EXPECT_GT(known, 200);
    EXPECT_LE(wrong, known / 100);
}

TEST(AreaSight, IsTheSameOnAnyNumberOfThreads) {
    const Scene scene = lit_courtyard();
    const auto embree = test::built(scene);
    const Baked one(scene, *embree, 48, 1), four(scene, *embree, 48, 4);
    EXPECT_GT(one.sight.rays, 1000u);
    EXPECT_EQ(one.sight.rays, four.sight.rays);
    EXPECT_EQ(one.sight.bits, four.sight.bits);
    EXPECT_EQ(one.sight.rows, four.sight.rows);
}

TEST(AreaLights, AreDrawnByTheirPowerAndEvenlyOverEach) {
    Scene scene = scene_with_lamps(vec3(1.0f));
    Material bright = scene.materials[1];
    bright.emissive = vec3(6.0f, 0.0f, 0.0f);
    scene.materials.push_back(bright);
    test::add_triangle(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1);  // power 1, for half a square metre
    test::add_triangle(scene, {5, 0, 0}, {7, 0, 0}, {5, 1, 0}, 3);  // twice the area, twice the mean
    test::add_triangle(scene, {0, 5, 0}, {1, 5, 0}, {0, 6, 0}, 2);  // both sides
    test::add_triangle(scene, {0, 5, 9}, {1, 5, 9}, {0, 6, 9}, 0);  // does not shine
    test::add_triangle(scene, {0, 0, 9}, {1, 0, 9}, {2, 0, 9}, 1);  // no area
    const AreaLights lights = find_area_lights(scene);
    ASSERT_EQ(lights.triangles.size(), 3u);
    const std::array<double, 3> expected{1.0 / 7.0, 4.0 / 7.0, 2.0 / 7.0};
    const std::array<float, 3> area{0.5f, 1.0f, 0.5f};
    constexpr int draws = 20'000;
    std::array<int, 3> drawn{};
    std::array<std::array<int, 4>, 3> quarters{};  // of each triangle, cut through the middles of its edges
    for (std::uint32_t k = 0; k < draws; ++k) {
        const AreaPoint point = draw_point(lights, {random_unit(5, k, 0), random_unit(5, k, 1)});
        const vec2 at = point.barycentric;
        ASSERT_TRUE(at.x >= 0.0f && at.y >= 0.0f && at.x + at.y <= 1.0f);
        const AreaTriangle& light = lights.triangles[point.at];
        ASSERT_LT(glm::distance(point.position, light.corner + at.x * light.u + at.y * light.v), 1e-6f);
        ++drawn[point.at];
        ++quarters[point.at][at.x > 0.5f ? 1 : at.y > 0.5f ? 2 : at.x + at.y < 0.5f ? 3 : 0];
    }
    double chi_square = 0.0;
    for (std::size_t t = 0; t < 3; ++t) {
        EXPECT_NEAR(lights.triangles[t].per_m2 * area[t], expected[t], 1e-5);
        for (const int count : quarters[t]) {
            const double wanted = draws * expected[t] / 4.0;
            chi_square += (count - wanted) * (count - wanted) / wanted;
        }
    }
    EXPECT_LT(chi_square, 31.3);  // 11 degrees of freedom, a thousandth
}

/// White where u is less than a half.
void give_half_picture(Scene& scene, std::uint32_t material) {
    Texture texture;
    texture.texels = ImageRgba8({64, 64}, glm::u8vec4(255));
    for (int y = 0; y < 64; ++y)
        for (int x = 32; x < 64; ++x) texture.texels.at(x, y) = glm::u8vec4(0, 0, 0, 255);
    texture.wrap_u = texture.wrap_v = Wrap::clamp;
    scene.textures.push_back(texture);
    scene.materials[material].emissive_texture = TextureLookup{};
}

TEST(AreaLights, ShineAsTheirTextureDoes) {
    Scene scene = scene_with_lamps(vec3(1.0f));
    add_floor(scene);
    add_square(scene, 1);  // u runs along +x
    give_half_picture(scene, 1);
    Asked asked(scene, over_the_floor());
    asked.samples = 256;
    const EnvironmentResult result = asked.picture();
    double found = 0.0, expected = 0.0, of_all = 0.0;
    for (std::size_t p = 0; p < size.pixels(); ++p) {
        if (!asked.shows(p) || asked.surfaces.position[p].y > 0.01f) continue;
        const vec3 here = asked.surfaces.position[p];
        const float whole = lambert(square_corners(), here, vec3(0, 1, 0));
        const float half = whole - lambert(square_corners(0.0f), here, vec3(0, 1, 0));
        found += result.irradiance.pixels[p].x;
        expected += half;
        of_all += whole;
        ASSERT_NEAR(result.irradiance.pixels[p].x, half, 0.08f * half + 1e-3f) << p;
    }
    EXPECT_NEAR(found, expected, 0.01 * expected);
    EXPECT_LT(expected, 0.9 * of_all);
}

TEST(AreaLights, TrianglesWhoseTextureIsBlackAreNotDrawn) {
    Scene scene = scene_with_lamps(vec3(1.0f));
    add_square(scene, 1);
    give_half_picture(scene, 1);
    for (vec2& at : scene.texture_coordinates[0]) at.x = 0.6f + 0.3f * at.x;  // in the black half
    EXPECT_TRUE(find_area_lights(scene).triangles.empty());
    scene.texture_coordinates[0][0].x = 0.4f;
    EXPECT_EQ(find_area_lights(scene).triangles.size(), 1u);
}

TEST(AreaLights, DoNotShineInTheHolesOfAMaskedMaterial) {
    Scene scene = test::scene_with_square(AlphaMode::mask);
    scene.materials[0].emissive = vec3(1.0f);
    EXPECT_EQ(emission_at(scene, 0, {0.9f, 0.0f}), vec3(0.0f));
    EXPECT_EQ(emission_at(scene, 0, {0.1f, 0.0f}), vec3(1.0f));
    scene.materials[0].alpha_mode = AlphaMode::opaque;
    EXPECT_EQ(emission_at(scene, 0, {0.9f, 0.0f}), vec3(1.0f));
}

TEST(AreaLights, WithoutAnyNothingIsAddedOrAsked) {
    Asked asked(testing::courtyard(), testing::courtyard_camera());
    EnvironmentResult result = blank_environment(asked.request);
    for (vec3& pixel : result.irradiance.pixels) pixel = vec3(0.5f);
    const EnvironmentResult before = result;
    add_area_lights(nullptr, nullptr, *asked.embree, asked.scene, find_area_lights(asked.scene), asked.request, 64,
                    result, asked.progress);
    EXPECT_EQ(result.irradiance, before.irradiance);
    EXPECT_EQ(result.radiance, before.radiance);
    EXPECT_EQ(result.area_rays, SampleCounts{});
    EXPECT_EQ(result.seconds, before.seconds);
}

TEST(AreaLights, PaintTheSameOnAnyNumberOfThreadsAndInAnyOrder) {
    Asked asked(lit_courtyard(), testing::courtyard_camera());
    const Baked baked(asked.scene, *asked.embree, 64);
    asked.field = &baked.field;
    asked.sight = &baked.sight;
    const EnvironmentResult first = asked.picture();
    asked.request.threads = 1;
    EXPECT_EQ(asked.picture().irradiance, first.irradiance);
    asked.request.threads = 4;
    asked.request.reverse_tiles = true;
    const EnvironmentResult turned = asked.picture();
    EXPECT_EQ(turned.irradiance, first.irradiance);
    EXPECT_EQ(turned.rays_traced, first.rays_traced);
    asked.request.order = RayOrder::pixel;  // only who is asked first
    const EnvironmentResult unsorted = asked.picture();
    EXPECT_EQ(unsorted.area_rays, first.area_rays);
    EXPECT_EQ(unsorted.irradiance, first.irradiance);
}

TEST(AreaLights, ComeOnTopOfTheSurroundingsThroughTheTechnique) {
    const Scene scene = lit_courtyard();
    const auto embree = test::built(scene);
    const SurfaceBuffer surfaces = test::seen(scene, *embree, testing::courtyard_camera(), size);
    const EnvironmentLight light = make_environment_light(procedural_sky({}));
    ParameterValues parameters{{"points", 6000.0}, {"rays_per_point", 64.0}, {"samples", 16.0}, {"area_rays", 64.0}};
    Progress progress;
    const Structure structure = technique().build({.scene = &scene, .parameters = parameters, .threads = 2}, progress);
    RenderRequest request;
    request.surfaces = &surfaces;
    request.scene = &scene;
    request.environment = &light;
    request.parameters = parameters;
    request.threads = 2;
    const RenderResult without = technique().render(structure, request, progress);
    request.parameters["area_samples"] = 32.0;
    const RenderResult with = technique().render(structure, request, progress);
    const RenderResult truth = technique().environment->reference(*embree, request, progress);
    double added = 0.0, apart = 0.0, sum = 0.0;
    for (std::size_t p = 0; p < size.pixels(); ++p) {
        if (surfaces.triangle[p] == no_triangle) {
            ASSERT_EQ(with.radiance.pixels[p], without.radiance.pixels[p]);
            continue;
        }
        ASSERT_GE(with.radiance.pixels[p].x, without.radiance.pixels[p].x - 1e-5f);
        added += with.radiance.pixels[p].x - without.radiance.pixels[p].x;
        apart += std::fabs(with.radiance.pixels[p].x - truth.radiance.pixels[p].x);
        sum += truth.radiance.pixels[p].x;
    }
    EXPECT_GT(added, 0.01 * sum);
    EXPECT_LT(apart, 0.05 * sum);
    EXPECT_GT(with.rays, without.rays);
    EXPECT_GT(with.rays_traced, without.rays_traced);
    EXPECT_EQ(with.rays, truth.rays);
    EXPECT_EQ(truth.rays_traced, truth.rays);
    EXPECT_LT(with.rays_traced, truth.rays_traced);
}

}  // namespace
}  // namespace sightlines::visibility_field
