// The recorded sample is the rendered sample.
#include "techniques/visibility_field/trace.h"

#include <algorithm>
#include <fstream>
#include <map>

#include <gtest/gtest.h>

#include "techniques/visibility_field/moving_bake.h"
#include "tests/visibility_field/scenes.h"

namespace sightlines::visibility_field {
namespace {

struct Prepared {
    Scene scene = testing::courtyard();
    std::shared_ptr<const EmbreeScene> embree = test::built(scene);
    SurfaceBuffer surfaces = test::seen(scene, *embree, testing::courtyard_camera(), {40, 24});
    SamplePattern pattern = make_pattern(32, 1);
    BakeOptions options = testing::small_bake();
    VisibilityField field;
    CellPoints points;
    EnvironmentRequest request;
    Progress progress;

    explicit Prepared(std::uint32_t count = 1500, int probes = BakeOptions().probes) {
        options.points = count;
        options.probes = probes;
        field = bake(scene, *embree, options, progress, &points);
        request.surfaces = &surfaces;
        request.pattern = &pattern;
        request.light.coefficient[0] = vec3(2.0f, 3.0f, 4.0f);
        request.light.coefficient[1] = vec3(0.5f);
        request.unshadowed = Unshadowed::sampled;
    }
    SampleTrace trace(int x, int y, int sample) const { return trace_sample(field, *embree, request, x, y, sample); }
};

TEST(FieldTrace, ItsSamplesAddUpToThePixel) {
    for (const Culling culling : {Culling::label, Culling::visible, Culling::both}) {
        Prepared prepared;
        prepared.request.culling = culling;
        const EnvironmentResult result =
            render_environment(&prepared.field, *prepared.embree, prepared.request, prepared.progress);
        std::map<Fate, int> fates;
        for (int y = 0; y < 24; ++y) {
            for (int x = 0; x < 40; ++x) {
                const auto p = static_cast<std::size_t>(y * 40 + x);
                if (prepared.surfaces.triangle[p] == no_triangle) continue;
                vec3 sum(0.0f), unshadowed(0.0f);
                std::uint32_t traced_rays = 0;
                bool subtracts = false;
                for (int sample = 0; sample < 32; ++sample) {
                    const SampleTrace traced = prepared.trace(x, y, sample);
                    ++fates[traced.fate];
                    traced_rays += traced.fate == Fate::traced || traced.fate == Fate::outside_cells;
                    sum += traced.adds;
                    const vec3 direction = glm::normalize(traced.trace.ray.target - traced.trace.ray.origin);
                    unshadowed += std::numbers::pi_v<float> / 32.0f * radiance(prepared.request.light, direction);
                    subtracts = culling == Culling::label && traced.label == 0 && traced.cell_index != 0xffffffffu;
                }
                if (subtracts) sum += unshadowed;
                ASSERT_EQ(traced_rays, result.rays_traced.pixels[p]);
                ASSERT_LT(glm::distance(sum, result.irradiance.pixels[p]), 1e-4f) << x << " " << y;
            }
        }
        EXPECT_GT(fates[Fate::traced], 1000);
        EXPECT_GT(fates[Fate::taken_for_blocked], 1000);
        EXPECT_EQ(fates[Fate::taken_for_open] > 1000, culling != Culling::visible);
    }
}

TEST(FieldTrace, CallsWrongWhatTheListOfWrongRaysHolds) {
    Prepared prepared;
    const WrongRays wrong =
        find_wrong_rays(prepared.field, *prepared.embree, prepared.request, 1000, prepared.progress);
    ASSERT_FALSE(wrong.first.empty());
    for (const WrongRay& ray : wrong.first) {
        const SampleTrace traced = prepared.trace(static_cast<int>(ray.pixel) % 40, static_cast<int>(ray.pixel) / 40,
                                                  static_cast<int>(ray.sample));
        ASSERT_TRUE(traced.is_wrong());
        ASSERT_EQ(traced.fate == Fate::taken_for_blocked, ray.taken_for_blocked);
    }
}

TEST(FieldTrace, NamesTheKernelsOwnLinesAndShowsTheCell) {
    const Prepared prepared;
    const SampleTrace traced = prepared.trace(20, 18, 5);
    ASSERT_GE(traced.trace.steps.size(), 5u);
    std::map<std::string, std::vector<std::string>> sources;
    for (const TraceStep& step : traced.trace.steps) {
        std::vector<std::string>& lines = sources[step.file];
        if (lines.empty()) {
            std::ifstream stream(std::string(SIGHTLINES_SOURCE_FOLDER) + "/" + step.file);
            for (std::string line; std::getline(stream, line);) lines.push_back(line);
        }
        ASSERT_LE(static_cast<std::size_t>(step.line), lines.size());
        // A NOTE of several lines is counted at its first or its last.
        bool found = false;
        for (int line = std::max(1, step.line - 3); line <= step.line; ++line)
            found =
                found || lines[static_cast<std::size_t>(line - 1)].find("NOTE(\"" + step.paper) != std::string::npos;
        EXPECT_TRUE(found) << step.file << ":" << step.line << " " << step.paper;
        EXPECT_FALSE(step.sentence.empty());
    }
    const auto cell = std::ranges::find(traced.trace.steps, std::string("Algorithm 2, line 3"), &TraceStep::paper);
    ASSERT_NE(cell, traced.trace.steps.end());
    EXPECT_TRUE(std::ranges::any_of(cell->geometry, [](const TraceGeometry& g) { return g.name == "cell"; }));
    EXPECT_TRUE(std::ranges::any_of(cell->geometry, [](const TraceGeometry& g) { return g.name == "ray"; }));
}

TEST(FieldTrace, FindsTheSampleThatShouldHaveSeenAWrongRay) {
    Prepared prepared(1500, 0);
    const WrongRays wrong = find_wrong_rays(prepared.field, *prepared.embree, prepared.request, 40, prepared.progress);
    int seen = 0;
    for (const WrongRay& ray : wrong.first) {
        const SampleTrace traced = prepared.trace(static_cast<int>(ray.pixel) % 40, static_cast<int>(ray.pixel) / 40,
                                                  static_cast<int>(ray.sample));
        const NearestSamples nearest = nearest_samples(
            samples_in(prepared.field.shape, traced.cell, prepared.points, nullptr), *prepared.embree, traced);
        ASSERT_GT(nearest.points, 0u);
        ASSERT_LE(nearest.facing, nearest.points);
        ASSERT_LE(nearest.nearest_m, 0.87f);
        if (!nearest.should_have_seen) continue;
        ++seen;
        EXPECT_GE(nearest.should_have_seen_m, nearest.nearest_m);
    }
    EXPECT_GT(seen, 0);
}

}  // namespace
}  // namespace sightlines::visibility_field
