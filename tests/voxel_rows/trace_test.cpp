// The recorded ray is the rendered ray.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "techniques/voxel_rows/dictionary.h"
#include "techniques/voxel_rows/first_hits.h"
#include "techniques/voxel_rows/query.h"
#include "techniques/voxel_rows/voxel_rows.h"
#include "tests/voxel_rows/scenes.h"

namespace sightlines::voxel_rows {
namespace {

struct Fixture {
    Scene scene = testing::scattered_triangles(150, 8);
    RowArray array;

    Fixture() {
        BuildOptions options;
        options.resolution = 100;
        options.angle_step_deg = 6.0;
        Progress progress;
        array = build_from_fragments(scene, options, progress);
    }
    TraceRequest request(std::uint32_t k) const {
        TraceRequest request;
        request.position = testing::random_point(scene.bounds, 31, k);
        request.normal = sphere_direction(random_unit(32, k, 0), random_unit(32, k, 1));
        request.light.position = testing::random_point(scene.bounds, 33, k);
        request.parameters = {{"subrays", k % 2 == 0 ? 1.0 : 2.0}};
        return request;
    }
};

template <class T>
T value_of(const Trace& trace, std::string_view paper, std::string_view name) {
    for (const TraceStep& step : trace.steps)
        for (const TraceValue& value : step.values)
            if (step.paper == paper && value.name == name) return std::get<T>(value.value);
    ADD_FAILURE() << "no " << name << " in " << paper;
    return {};
}

TEST(VoxelRowsTrace, ShowsTheSearchForTheFirstHitWhereFirstHitsAreAsked) {
    const Fixture fixture;
    int found = 0;
    for (std::uint32_t k = 0; k < 300; ++k) {
        TraceRequest request = fixture.request(k);
        const Trace plain = trace(fixture.array, request);
        request.parameters["first_hits"] = 1.0;
        const Trace searched = trace(fixture.array, request);
        EXPECT_EQ(searched.blocked, plain.blocked);
        const RowShape query = make_query(fixture.array, request.parameters, std::span(&request.light, 1));
        const float distance_m =
            first_hit(fixture.array, query, {request.position, request.light.position}, request.normal);
        if (std::isinf(distance_m)) {
            EXPECT_EQ(searched.steps.size(), plain.steps.size());
            continue;
        }
        ++found;
        EXPECT_NEAR(value_of<double>(searched, "Section 7, distance", "distance"), distance_m, 1e-5f);
        // Each part that is searched lies in the one before; the last is one voxel, and the hit its middle.
        std::int64_t low = 0, high = 99;
        for (const TraceStep& step : searched.steps) {
            if (step.paper != "Section 7, binary search") continue;
            const auto bound = [&](std::string_view name) {
                return std::get<std::int64_t>(std::ranges::find(step.values, name, &TraceValue::name)->value);
            };
            EXPECT_TRUE(low <= bound("low") && bound("low") <= bound("high") && bound("high") <= high);
            low = bound("low");
            high = bound("high");
            EXPECT_EQ(step.geometry.back().name, "searched");
        }
        EXPECT_EQ(low, high);
        EXPECT_EQ(searched.steps.back().geometry.back().name, "first hit");
    }
    EXPECT_GT(found, 30);
    EXPECT_LT(found, 290);
}

TEST(VoxelRowsTrace, EndsWithTheVerdictOfTheRenderingKernel) {
    const Fixture fixture;
    int blocked = 0;
    for (std::uint32_t k = 0; k < 2000; ++k) {
        const TraceRequest request = fixture.request(k);
        const RowShape query = make_query(fixture.array, request.parameters, std::span(&request.light, 1));
        const Trace recorded = trace(fixture.array, request);
        ASSERT_EQ(recorded.blocked,
                  is_blocked(fixture.array, query, {request.position, request.light.position}, request.normal));
        ASSERT_EQ(recorded.blocked, serve(fixture.array, request).blocked);
        blocked += recorded.blocked;
    }
    EXPECT_GT(blocked, 200);
    EXPECT_LT(blocked, 1800);
}

TEST(VoxelRowsTrace, RecordsTheRowsBitsAndWhatIsLeftOfThem) {
    const Fixture fixture;
    const TraceRequest request = fixture.request(4);
    const Trace recorded = trace(fixture.array, request);
    const ServedRay served = serve(fixture.array, request);
    std::string row = value_of<std::string>(recorded, "Algorithm 3, lines 5 to 7", "row");
    std::string clipped = value_of<std::string>(recorded, "Algorithm 3, lines 5 to 7", "clipped");
    std::erase(row, ' ');
    std::erase(clipped, ' ');
    ASSERT_EQ(row.size(), 128u);
    for (int u = 0; u < 100; ++u) {
        const auto place = static_cast<std::size_t>(u);
        EXPECT_EQ(row[place] == '1', served.bits[place]);
        EXPECT_EQ(clipped[place] == '1', served.bits[place] && u >= served.first && u <= served.last);
    }
    EXPECT_EQ(clipped.find('1') != std::string::npos, recorded.blocked);
}

TEST(VoxelRowsTrace, RecordsTheLookUpInTheDictionaryWhereThereIsOne) {
    const Fixture fixture;
    Progress progress;
    const RowArray made = compress(fixture.array, {.rows = 4000}, progress);
    for (std::uint32_t k = 0; k < 200; k += 2) {
        const TraceRequest request = fixture.request(k);
        const Trace recorded = trace(made, request), uncompressed = trace(fixture.array, request);
        ASSERT_EQ(recorded.steps.size(), uncompressed.steps.size() + 1);
        const auto row = value_of<std::int64_t>(recorded, "Algorithm 3, line 3", "row");
        const auto index = value_of<std::int64_t>(recorded, "Algorithm 3, line 3", "index");
        EXPECT_EQ(index, dictionary_entry(made, static_cast<std::uint32_t>(row)).index);
        const ServedRay served = serve(made, request);
        EXPECT_EQ(served.blocked, recorded.blocked);
        std::string bits = value_of<std::string>(recorded, "Algorithm 3, lines 5 to 7", "row");
        std::erase(bits, ' ');
        const auto words = row_words(made, static_cast<std::uint32_t>(row));
        for (std::size_t u = 0; u < 100; ++u) {
            ASSERT_EQ(bits[u] == '1', (words[u / 32] >> (u % 32) & 1u) != 0);
            ASSERT_EQ(bits[u] == '1', served.bits[u]);
        }
    }
}

TEST(VoxelRowsTrace, NamesTheKernelsOwnLines) {
    const Fixture fixture;
    std::vector<std::string> source;
    std::ifstream stream(std::string(SIGHTLINES_SOURCE_FOLDER) + "/shaders/voxel_rows.h");
    for (std::string line; std::getline(stream, line);) source.push_back(line);
    const Trace recorded = trace(fixture.array, fixture.request(0));
    ASSERT_GE(recorded.steps.size(), 6u);
    for (const TraceStep& step : recorded.steps) {
        EXPECT_EQ(step.file, "shaders/voxel_rows.h");
        ASSERT_LE(static_cast<std::size_t>(step.line), source.size());
        EXPECT_NE(source[static_cast<std::size_t>(step.line) - 1].find("NOTE(\"" + step.paper), std::string::npos)
            << step.line;
        EXPECT_FALSE(step.sentence.empty());
    }
}

TEST(VoxelRowsTrace, PutsTheRowRoundTheMiddleOfTheRay) {
    const Fixture fixture;
    for (std::uint32_t k = 0; k < 200; k += 2) {
        const TraceRequest request = fixture.request(k);
        const Trace recorded = trace(fixture.array, request);
        const ServedRay served = serve(fixture.array, request);
        const vec3 middle = 0.5f * (served.ray.origin + served.ray.target);
        for (const TraceStep& step : recorded.steps) {
            for (const TraceGeometry& shape : step.geometry) {
                if (shape.name != "row") continue;
                for (int edge = 1; edge <= 3; ++edge) {
                    const vec3 side = shape.points[static_cast<std::size_t>(edge)];
                    const float share = glm::dot(middle - shape.points[0], side) / glm::dot(side, side);
                    EXPECT_GE(share, -1e-3f);
                    EXPECT_LE(share, 1.001f);
                }
            }
        }
        EXPECT_LE(served.angular_error_deg, 3.0f * 1.4143f);
    }
}

TEST(VoxelRowsTrace, RecordsNothingOutsideARecording) {
    const Fixture fixture;
    const Trace first = trace(fixture.array, fixture.request(0));
    const Trace second = trace(fixture.array, fixture.request(0));
    EXPECT_EQ(first.steps.size(), second.steps.size());
}

}  // namespace
}  // namespace sightlines::voxel_rows
