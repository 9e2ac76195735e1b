// What a bake takes, and how it is refused.
#include "techniques/visibility_field/memory_need.h"

#include <gtest/gtest.h>

#include "techniques/base/error.h"
#include "techniques/visibility_field/surface_cells.h"
#include "tests/visibility_field/scenes.h"

namespace sightlines::visibility_field {
namespace {

const Box3 hall{vec3(0.0f), vec3(40.0f, 20.0f, 20.0f)};

std::string refusal(const BakeOptions& options, std::uint64_t available_bytes) {
    try {
        require_memory({hall, 5000.0, 200'000}, options, available_bytes);
    } catch (const EnvironmentError& error) {
        return error.what();
    }
    return "accepted";
}

TEST(MemoryNeed, IsNoLessThanWhatABakeHolds) {
    const Scene scene = testing::courtyard();
    for (const float cell_m : {0.1f, 0.5f, 3.0f}) {
        BakeOptions options = testing::small_bake();
        options.cell_m = cell_m;
        const VisibilityField field = testing::baked(scene, *test::built(scene), options);
        const double held =
            static_cast<double>(field.bytes()) + static_cast<double>(field.points * sizeof(SurfacePoint));
        EXPECT_GE(bake_bytes({scene.bounds, sampled_area(scene), scene.triangles.size()}, options), held) << cell_m;
    }
}

TEST(MemoryNeed, GrowsByTheTreeOfEachTriangleAndOfWhatStandsStill) {
    BakeOptions options;
    options.placement = Placement::random;
    options.cell_m = 100.0f;
    const auto bytes = [&](std::size_t triangles, bool moves) {
        return bake_bytes({hall, 5000.0, triangles, moves}, options);
    };
    const double one = bytes(2'000'000, false) - bytes(1'000'000, false);
    EXPECT_GE(one, 146e6);  // what building was measured to take
    EXPECT_LT(one, 200e6);
    EXPECT_DOUBLE_EQ(bytes(2'000'000, true) - bytes(1'000'000, true), 2.0 * one);
}

TEST(MemoryNeed, WhatFitsIsAccepted) { EXPECT_EQ(refusal({}, std::uint64_t{1} << 30), "accepted"); }

TEST(MemoryNeed, TheRefusalNamesTheNeedAndTheCellsThatWouldFit) {
    BakeOptions options;
    options.cell_m = 0.01f;
    options.points = 1000;
    const std::string text = refusal(options, std::uint64_t{1} << 30);
    EXPECT_NE(text.find("cells of 0.01 m takes up to"), std::string::npos) << text;
    EXPECT_NE(text.find("1.07 GB are free"), std::string::npos) << text;
    EXPECT_NE(text.find("cells of 0.08 m would fit"), std::string::npos) << text;
}

TEST(MemoryNeed, RefusesMoreCellsThanCanBeNumberedWhateverTheMemory) {
    BakeOptions options;
    options.cell_m = 1e-4f;
    EXPECT_THROW(require_memory({{vec3(0.0f), vec3(1000.0f, 0.0f, 0.0f)}, 0.0, 1}, options, ~std::uint64_t{0}),
                 EnvironmentError);
    EXPECT_THROW(require_memory({{vec3(0.0f), vec3(1e5f)}, 1e10, 1}, {}, ~std::uint64_t{0}), EnvironmentError);
}

TEST(MemoryNeed, WhereSamplesAloneAreTooManyItSaysSo) {
    BakeOptions options;
    options.points = 4'000'000'000u;
    EXPECT_NE(refusal(options, std::uint64_t{1} << 30).find("fewer point samples"), std::string::npos);
}

}  // namespace
}  // namespace sightlines::visibility_field
