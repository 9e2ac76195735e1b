#include "techniques/voxel_rows/memory_need.h"

#include <gtest/gtest.h>

#include "techniques/base/error.h"

namespace sightlines::voxel_rows {
namespace {

constexpr std::uint64_t gigabyte = 1'000'000'000;

std::string refusal(int resolution, double angle_step_deg, std::uint64_t available_bytes,
                    ArrayKind kind = ArrayKind::plain) {
    try {
        require_memory(resolution, angle_step_deg, available_bytes, kind);
    } catch (const EnvironmentError& error) {
        return error.what();
    }
    return "accepted";
}

TEST(MemoryNeed, IsThatOfEveryRowOfEveryDirection) {
    EXPECT_EQ(array_bytes(128, 2.0), std::uint64_t{90} * 90 * 128 * 128 * 16);
    EXPECT_EQ(array_bytes(256, 1.0), std::uint64_t{180} * 180 * 256 * 256 * 32);
    EXPECT_EQ(array_bytes(32, 6.0), std::uint64_t{30} * 30 * 32 * 32 * 4);
}

TEST(MemoryNeed, WhatFitsIsAccepted) {
    EXPECT_EQ(refusal(128, 2.0, array_bytes(128, 2.0)), "accepted");
    EXPECT_NE(refusal(128, 2.0, array_bytes(128, 2.0) - 1), "accepted");
}

TEST(MemoryNeed, TheRefusalNamesTheNeedAndTheNearestChoicesThatFit) {
    const std::string text = refusal(256, 1.0, 20 * gigabyte);
    EXPECT_NE(text.find("256 voxels at 1 deg takes 67.9 GB"), std::string::npos) << text;
    EXPECT_NE(text.find("20 GB are free"), std::string::npos) << text;
    EXPECT_NE(text.find("256 voxels at 2 deg (17 GB) or 128 voxels at 1 deg (8.49 GB)"), std::string::npos) << text;
}

TEST(MemoryNeed, CompressingTakesMoreThanTheArrayAndFitsLess) {
    const std::uint64_t enough = compression_bytes(128, 2.0);
    EXPECT_GT(enough, array_bytes(128, 2.0) + 2 * gigabyte);
    EXPECT_LT(enough, array_bytes(128, 2.0) + 6 * gigabyte);
    EXPECT_EQ(refusal(128, 2.0, enough, ArrayKind::compressed), "accepted");
    const std::string text = refusal(256, 2.0, 20 * gigabyte, ArrayKind::compressed);
    EXPECT_NE(text.find("256 voxels at 2 deg, to be compressed, takes"), std::string::npos) << text;
    EXPECT_NE(text.find("192 voxels at 2 deg"), std::string::npos) << text;
    EXPECT_EQ(refusal(256, 2.0, 20 * gigabyte), "accepted");
}

TEST(MemoryNeed, WhereNothingFitsItSaysSo) {
    const std::string text = refusal(32, 6.0, 1000);
    EXPECT_NE(text.find("close other programs"), std::string::npos) << text;
}

}  // namespace
}  // namespace sightlines::voxel_rows
