// Wang 2017, Algorithm 5: rays among objects that move rigidly, by every compilation of the kernel.
#include <algorithm>
#include <bit>
#include <fstream>

#include <gtest/gtest.h>

#include "techniques/compute/device.h"
#include "techniques/voxel_rows/query.h"
#include "techniques/voxel_rows/voxel_rows.h"
#include "tests/voxel_rows/moving_boxes.h"

namespace sightlines::voxel_rows {
namespace {

using testing::boxes_over_a_floor;
using testing::scattered_places;
using testing::small_parameters;

/// A built scene with boxes at `places`, and what is asked of it.
struct Fixture {
    std::vector<mat4> places;
    Scene scene;
    ParameterValues parameters;
    Structure structure;
    SurfaceBuffer surfaces = testing::surfaces_all_over({70, 50});
    std::vector<Light> lights;

    explicit Fixture(std::vector<mat4> places_, const ParameterValues& changed = {}, std::uint32_t light_count = 37,
                     bool of_all_kinds = false)
        : places(std::move(places_)),
          scene(boxes_over_a_floor(places)),
          parameters(small_parameters()),
          lights(testing::lights_above(light_count, of_all_kinds)) {
        for (const auto& [name, value] : changed) parameters[name] = value;
        BuildRequest request;
        request.scene = &scene;
        request.parameters = parameters;
        Progress progress;
        structure = technique().build(request, progress);
    }
    RenderRequest request(Backend backend = Backend::cpu) const {
        RenderRequest request;
        request.surfaces = &surfaces;
        request.lights = lights;
        request.parameters = parameters;
        request.backend = backend;
        request.keep_verdicts = true;
        return request;
    }
    RenderResult render(Backend backend = Backend::cpu) const {
        Progress progress;
        return technique().render(structure, request(backend), progress);
    }
    bool blocked_by_objects(const Segment& ray, vec3 normal) const {
        return is_blocked(object_instances(objects(structure), parameters), ray, normal);
    }
};

/// Rays from the floor that pass the boxes by `margin_m` must pass, and of those that meet them that far inside, all
/// but a few between two voxels must not.
void expect_true_shadows(const Fixture& fixture, float margin_m) {
    int inside = 0, leaking = 0, outside = 0;
    for (std::uint32_t k = 0; k < 20000; ++k) {
        const auto unit = [&](std::uint32_t sample) { return random_unit(90, k, sample); };
        const Segment ray{vec3(8.0f * unit(0) - 4.0f, 0.0f, 8.0f * unit(1) - 4.0f),
                          vec3(8.0f * unit(2) - 4.0f, 5.0f, 8.0f * unit(3) - 4.0f)};
        const auto meets_any = [&](float margin) {
            return std::ranges::any_of(fixture.places,
                                       [&](const mat4& place) { return testing::meets(place, ray, margin); });
        };
        const bool blocked = fixture.blocked_by_objects(ray, vec3(0, 1, 0));
        if (meets_any(-margin_m)) {
            leaking += !blocked;
            ++inside;
        } else if (!meets_any(margin_m)) {
            ASSERT_FALSE(blocked) << "ray " << k;
            ++outside;
        }
    }
    EXPECT_GT(inside, 100);
    EXPECT_LE(leaking, inside / 100);
    EXPECT_GT(outside, 10000);
}

TEST(ObjectsQuery, AShadowFollowsItsObject) {
    for (const float x_m : {-2.0f, 0.0f, 2.0f}) expect_true_shadows(Fixture({placed({x_m, 2.0f, 0.5f}, 0.0f)}), 0.11f);
}

TEST(ObjectsQuery, AnObjectMayTurn) {
    for (const float turn_deg : {90.0f, 35.0f, 180.0f, -120.0f})
        expect_true_shadows(Fixture({placed({0.0f, 2.0f, 0.5f}, turn_deg)}), 0.11f);
}

TEST(ObjectsQuery, AnObjectMayBeScaledUnevenlyAndMirrored) {
    const mat4 uneven(vec4(0, 1.4f, 0, 0), vec4(-0.8f, 0, 0, 0), vec4(0, 0, 1.1f, 0), vec4(0, 2, 0, 1));
    mat4 mirrored = placed({1.0f, 2.0f, 0.5f}, 20.0f);
    mirrored[0] = -mirrored[0];
    expect_true_shadows(Fixture({uneven, mirrored}), 0.13f);
}

TEST(ObjectsQuery, EachInstanceHasAShadowOfItsOwn) { expect_true_shadows(Fixture(scattered_places(8, 3)), 0.11f); }

TEST(ObjectsQuery, RaysThatEndBeforeAnObjectOrStartBehindItPass) {
    const Fixture fixture({placed({0, 2, 0}, 0.0f)});
    const vec3 up(0, 1, 0);
    EXPECT_TRUE(fixture.blocked_by_objects({vec3(0.1f, 0, 0), vec3(0.12f, 4, 0.1f)}, up));
    EXPECT_FALSE(fixture.blocked_by_objects({vec3(0.1f, 0, 0), vec3(0.12f, 1.5f, 0.1f)}, up));
    EXPECT_FALSE(fixture.blocked_by_objects({vec3(0.1f, 2.5f, 0), vec3(0.12f, 4, 0.1f)}, up));
}

TEST(ObjectsQuery, AnObjectShadowsItselfNoMoreThanWhatStandsStillDoes) {
    // The same box alone, as an object and as an array of the same resolution.
    const mat4 place = placed({0.3f, 2.0f, 0.2f}, 30.0f);
    const Fixture fixture({place}, {{"object_resolution", 32.0}});
    const RowArray& alone = objects(fixture.structure).types[0];
    const RowShape query = make_query(alone, fixture.parameters, fixture.lights);
    int asked = 0, by_object = 0, by_array = 0;
    for (std::uint32_t k = 0; k < 20000; ++k) {
        const auto unit = [&](std::uint32_t sample) { return random_unit(91, k, sample); };
        vec3 at = testing::moving_box.lowest + testing::moving_box.size() * vec3(unit(0), unit(1), unit(2));
        const int axis = static_cast<int>(k % 3);
        vec3 normal(0.0f);
        normal[axis] = k % 2 == 0 ? 1.0f : -1.0f;
        at[axis] = k % 2 == 0 ? testing::moving_box.highest[axis] : testing::moving_box.lowest[axis];
        const vec3 away = sphere_direction(unit(3), unit(4));
        if (glm::dot(away, normal) < 0.1f) continue;
        const Segment own{at, at + 3.0f * away};
        const Segment ray{vec3(place * vec4(own.origin, 1.0f)), vec3(place * vec4(own.target, 1.0f))};
        ++asked;
        by_object += fixture.blocked_by_objects(ray, vec3(place * vec4(normal, 0.0f)));
        by_array += is_blocked(alone, query, own, normal);
    }
    EXPECT_GT(asked, 5000);
    EXPECT_LT(by_object, asked / 10);
    EXPECT_LE(by_object, by_array + asked / 200);
}

/// Every pixel and light of the CPU's picture as the scalar kernel answers.
void expect_scalar_answers(const Fixture& fixture) {
    const RenderResult result = fixture.render();
    const RowArray& array = row_array(fixture.structure);
    const RowShape query = make_query(array, fixture.parameters, fixture.lights);
    std::uint64_t blocked_in_all = 0, by_objects = 0;
    for (std::size_t pixel = 0; pixel < fixture.surfaces.size.pixels(); ++pixel) {
        const vec3 position = fixture.surfaces.position[pixel], normal = fixture.surfaces.normal[pixel];
        for (std::uint32_t k = 0; k < fixture.lights.size(); ++k) {
            const Light& light = fixture.lights[k];
            const vec3 end =
                light.kind == LightKind::directional ? position - light.direction * query.reach_m : light.position;
            const vec3 to_light =
                light.kind == LightKind::directional ? light.direction * -query.reach_m : end - position;
            const bool asked = fixture.surfaces.triangle[pixel] != no_triangle && glm::dot(normal, to_light) > 0.0f;
            const bool by_array = asked && is_blocked(array, query, {position, end}, normal);
            const bool by_object = asked && !by_array && fixture.blocked_by_objects({position, end}, normal);
            ASSERT_EQ(result.verdicts.blocked(pixel, k), by_array || by_object) << pixel << ' ' << k;
            blocked_in_all += by_array || by_object;
            by_objects += by_object;
        }
    }
    EXPECT_GT(by_objects, 1000u);
    EXPECT_EQ(count_blocked(fixture.structure, fixture.request()).blocked, blocked_in_all);
}

TEST(ObjectsQuery, TheCpusPictureHoldsTheScalarKernelsAnswers) {
    expect_scalar_answers(Fixture(scattered_places(3, 4)));
    expect_scalar_answers(Fixture(scattered_places(20, 4), {{"subrays", 2.0}}));
}

TEST(ObjectsQuery, TheCpusPictureHoldsTheScalarKernelsAnswersForLightsOfAllKindsAndLongerRows) {
    expect_scalar_answers(Fixture(scattered_places(4, 5), {{"object_resolution", 100.0}}, 20, true));
    expect_scalar_answers(Fixture(scattered_places(4, 5), {{"object_resolution", 50.0}}, 20, true));
    expect_scalar_answers(Fixture(scattered_places(4, 5), {{"object_resolution", 16.0}}, 20, true));
}

TEST(ObjectsQuery, ObjectsStandBesideAnArrayWithADictionary) {
    expect_scalar_answers(Fixture(scattered_places(3, 6), {{"compression", 1.0}, {"dictionary_rows", 2000.0}}, 10));
}

TEST(ObjectsQuery, ThePictureIsTheSameForAnyThreadsTilesAndRefinement) {
    const Fixture fixture(scattered_places(6, 4));
    Progress progress;
    const RenderResult once = fixture.render();
    RenderRequest request = fixture.request();
    request.threads = 1;
    request.reverse_tiles = true;
    int regions = 0;
    request.on_region = [&](const RenderResult&, PixelRect) { ++regions; };
    const RenderResult again = technique().render(fixture.structure, request, progress);
    EXPECT_GT(regions, 1);
    EXPECT_EQ(again.radiance, once.radiance);
    EXPECT_EQ(again.verdicts.words, once.verdicts.words);
}

/// Share of the rays from the floor that are judged otherwise than the boxes truly stand.
double error_share(const Fixture& fixture) {
    const RenderResult result = fixture.render();
    std::uint64_t asked = 0, wrong = 0;
    for (std::size_t pixel = 0; pixel < fixture.surfaces.size.pixels(); pixel += 2) {
        if (fixture.surfaces.triangle[pixel] == no_triangle) continue;
        for (std::uint32_t k = 0; k < fixture.lights.size(); ++k) {
            const Segment ray{fixture.surfaces.position[pixel], fixture.lights[k].position};
            const bool truly = std::ranges::any_of(fixture.places,
                                                   [&](const mat4& place) { return testing::meets(place, ray, 0.0f); });
            ++asked;
            wrong += result.verdicts.blocked(pixel, k) != truly;
        }
    }
    return static_cast<double>(wrong) / static_cast<double>(asked);
}

TEST(ObjectsQuery, ErrsNoMoreThanVoxelisingTheWholeSceneAnew) {
    const double by_objects = error_share(Fixture(scattered_places(6, 7)));
    const double as_a_whole = error_share(Fixture(scattered_places(6, 7), {{"motion", 1.0}}));
    EXPECT_LT(by_objects, as_a_whole + 0.002);
    EXPECT_LT(by_objects, 0.05);
    EXPECT_LT(as_a_whole, 0.10);
}

#define NEEDS_VULKAN                                                                       \
    if (compute::list_devices().empty() || !compute::list_devices().front().lacks.empty()) \
    GTEST_SKIP() << "no usable Vulkan device"

/// At least 99.9 % of the rays judged alike, and pictures that differ by no more than those rays and rounding.
void expect_backends_alike(const Fixture& fixture) {
    const RenderResult cpu = fixture.render(), vulkan = fixture.render(Backend::vulkan);
    EXPECT_EQ(vulkan.rays_asked, cpu.rays_asked);
    std::uint64_t differing = 0, blocked = 0;
    for (std::size_t k = 0; k < cpu.verdicts.words.size(); ++k) {
        differing += static_cast<std::uint64_t>(std::popcount(cpu.verdicts.words[k] ^ vulkan.verdicts.words[k]));
        blocked += static_cast<std::uint64_t>(std::popcount(vulkan.verdicts.words[k]));
    }
    EXPECT_LE(differing, cpu.rays / 1000);
    for (std::size_t pixel = 0; pixel < cpu.radiance.pixels.size(); ++pixel) {
        if (cpu.shadow.pixels[pixel] != vulkan.shadow.pixels[pixel]) continue;
        const vec3 expected = cpu.radiance.pixels[pixel], got = vulkan.radiance.pixels[pixel];
        ASSERT_LE(glm::length(got - expected), 1e-4f * glm::length(expected) + 1e-6f) << "pixel " << pixel;
    }
    EXPECT_EQ(count_blocked(fixture.structure, fixture.request(Backend::vulkan)).blocked, blocked);
    RenderRequest without = fixture.request(Backend::vulkan);
    without.keep_verdicts = false;
    Progress progress;
    const RenderResult again = technique().render(fixture.structure, without, progress);
    EXPECT_TRUE(again.verdicts.words.empty());
    EXPECT_EQ(again.radiance, vulkan.radiance);
}

TEST(ObjectsQuery, TheBackendsAgree) {
    NEEDS_VULKAN;
    expect_backends_alike(Fixture(scattered_places(3, 4), {}, 70));
    expect_backends_alike(Fixture(scattered_places(20, 4), {{"subrays", 2.0}, {"resolution", 128.0}}, 40));
    expect_backends_alike(Fixture(scattered_places(4, 5), {{"object_resolution", 100.0}}, 33, true));
    expect_backends_alike(Fixture(scattered_places(4, 5), {{"object_resolution", 50.0}}, 33, true));
}

TraceRequest trace_request(const Fixture& fixture, std::uint32_t k) {
    TraceRequest request;
    request.position = fixture.surfaces.position[2 * k + 2];
    request.normal = vec3(0, 1, 0);
    request.light = fixture.lights[k % fixture.lights.size()];
    request.parameters = fixture.parameters;
    return request;
}

TEST(ObjectsTrace, AsksOneObjectAfterTheOtherUntilOneIsInTheWay) {
    const Fixture fixture(scattered_places(5, 8));
    int blocked = 0;
    for (std::uint32_t k = 0; k < 1500; ++k) {
        const TraceRequest request = trace_request(fixture, k);
        const Trace recorded = technique().trace(fixture.structure, request);
        const Segment ray{request.position, request.light.position};
        const RowArray& array = row_array(fixture.structure);
        const bool by_array =
            is_blocked(array, make_query(array, request.parameters, std::span(&request.light, 1)), ray, request.normal);
        ASSERT_EQ(recorded.blocked, by_array || fixture.blocked_by_objects(ray, request.normal));
        const auto asked = std::ranges::count(recorded.steps, "Algorithm 5, line 4", &TraceStep::paper);
        ASSERT_EQ(std::ranges::count(recorded.steps, "Algorithm 5, line 6", &TraceStep::paper), asked);
        if (by_array || !recorded.blocked) {
            ASSERT_EQ(asked, by_array ? 0 : 5);
        }
        blocked += recorded.blocked && !by_array;
        const std::vector<AskedObject> objects_asked = asked_objects(objects(fixture.structure), recorded);
        ASSERT_EQ(static_cast<std::ptrdiff_t>(objects_asked.size()), asked);
        for (std::size_t i = 0; i < objects_asked.size(); ++i) {
            ASSERT_EQ(objects_asked[i].instance, i);
            ASSERT_EQ(objects_asked[i].blocked(), recorded.blocked && i + 1 == objects_asked.size());
            ASSERT_TRUE(objects_asked[i].met || objects_asked[i].rows.empty());
        }
    }
    EXPECT_GT(blocked, 100);
}

TEST(ObjectsTrace, ShowsTheObjectAndItsRowWhereTheyAreInTheWorld) {
    const Fixture fixture({placed({1.0f, 2.0f, 0.5f}, 30.0f)});
    int rows = 0;
    for (std::uint32_t k = 0; k < 1500; ++k) {
        const Trace recorded = technique().trace(fixture.structure, trace_request(fixture, k));
        const auto first = std::ranges::find(recorded.steps, "Algorithm 5, line 4", &TraceStep::paper);
        for (auto step = first; step != recorded.steps.end(); ++step) {
            for (const TraceGeometry& shape : step->geometry) {
                if (shape.shape == TraceShape::segment) {
                    const vec3 along = glm::normalize(trace_request(fixture, k).light.position - recorded.ray.origin);
                    EXPECT_GT(glm::dot(glm::normalize(shape.points[1] - shape.points[0]), along), 0.999f);
                }
                if (shape.name != "object" && shape.name != "row") continue;
                vec3 middle = shape.points[0];
                for (std::size_t edge = 1; edge <= 3; ++edge) middle += 0.5f * shape.points[edge];
                EXPECT_LT(glm::length(middle - vec3(1.0f, 2.0f, 0.5f)), shape.name == "row" ? 1.2f : 1e-3f);
                rows += shape.name == "row";
            }
        }
    }
    EXPECT_GT(rows, 50);
}

TEST(ObjectsTrace, TheRowThatIsReadOutOfTheStepsIsTheOneThatBlocks) {
    for (const double subrays : {1.0, 2.0}) {
        const Fixture fixture(scattered_places(5, 8), {{"subrays", subrays}});
        const RowArray& type = objects(fixture.structure).types[0];
        int rows = 0;
        for (std::uint32_t k = 0; k < 600; ++k) {
            const Trace recorded = technique().trace(fixture.structure, trace_request(fixture, k));
            for (const AskedObject& asked : asked_objects(objects(fixture.structure), recorded)) {
                if (asked.rows.empty()) continue;
                ASSERT_EQ(asked.rows.size(), static_cast<std::size_t>(subrays));
                const std::vector<std::uint8_t> occupied = unpack_voxelization(type, asked.direction);
                const auto n = static_cast<std::size_t>(type.grid.resolution);
                for (const AskedRow& row : asked.rows) {
                    const auto first = (static_cast<std::size_t>(row.w) * n + static_cast<std::size_t>(row.v)) * n;
                    bool set = false;
                    for (int u = row.first; u <= row.last; ++u)
                        set = set || occupied[first + static_cast<std::size_t>(u)] != 0;
                    ASSERT_EQ(row.blocked, set);
                    ++rows;
                }
            }
        }
        EXPECT_GT(rows, 100);
    }
}

TEST(ObjectsTrace, NamesTheKernelsOwnLines) {
    const Fixture fixture({placed({0.0f, 2.0f, 0.0f}, 30.0f)});
    std::vector<std::string> source;
    std::ifstream stream(std::string(SIGHTLINES_SOURCE_FOLDER) + "/shaders/voxel_row_objects.h");
    for (std::string line; std::getline(stream, line);) source.push_back(line);
    std::size_t seen = 0;
    for (std::uint32_t k = 0; k < 200; ++k) {
        for (const TraceStep& step : technique().trace(fixture.structure, trace_request(fixture, k)).steps) {
            if (step.file != "shaders/voxel_row_objects.h") continue;
            ASSERT_NE(source.at(static_cast<std::size_t>(step.line) - 1).find("NOTE(\"" + step.paper),
                      std::string::npos);
            ++seen;
        }
    }
    EXPECT_GT(seen, 200u);
}

}  // namespace
}  // namespace sightlines::voxel_rows
