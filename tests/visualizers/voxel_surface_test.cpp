#include "visualizers/voxel_surface.h"

#include <gtest/gtest.h>

#include <random>

#include "visualizer_testing.h"

namespace sightlines {
namespace {

const VoxelBox whole{ivec3(0), ivec3(15)};

TEST(VoxelFaces, OneVoxelHasSixOpenFaces) {
    const std::vector<VoxelFace> faces = voxel_faces(small_picture({{5, 6, 7}}), whole);
    ASSERT_EQ(faces.size(), 6u);
    for (const VoxelFace& face : faces) {
        EXPECT_FALSE(face.section);
        for (const float openness : face.openness) EXPECT_EQ(openness, 1.0f);
        const int plane = face.corners[0][face.axis];
        EXPECT_EQ(plane, ivec3(5, 6, 7)[face.axis] + (face.towards_higher ? 1 : 0));
        for (const ivec3& corner : face.corners) EXPECT_EQ(corner[face.axis], plane);
    }
}

TEST(VoxelFaces, TouchingVoxelsShareNoFace) {
    EXPECT_EQ(voxel_faces(small_picture({{5, 6, 7}, {6, 6, 7}}), whole).size(), 10u);
}

TEST(VoxelFaces, VoxelsAtTheEdgeOfTheGridAreClosed) {
    EXPECT_EQ(voxel_faces(small_picture({{0, 0, 0}, {15, 15, 15}}), whole).size(), 12u);
}

TEST(VoxelFaces, CuttingThroughASolidMarksTheSection) {
    const VoxelBox cut{{0, 0, 7}, {15, 15, 15}};
    const std::vector<VoxelFace> faces = voxel_faces(small_picture({{5, 6, 6}, {5, 6, 7}}), cut);
    ASSERT_EQ(faces.size(), 6u);
    EXPECT_EQ(std::ranges::count_if(faces, &VoxelFace::section), 1);
}

TEST(VoxelFaces, CornersInNooksAreDarker) {
    const std::vector<VoxelFace> faces = voxel_faces(small_picture({{5, 6, 7}, {6, 7, 7}}), whole);
    const auto darkened = [](const VoxelFace& face) { return std::ranges::min(face.openness) < 1.0f; };
    EXPECT_GT(std::ranges::count_if(faces, darkened), 0);
}

TEST(FirstSetVoxel, AgreesWithTestingEveryVoxelsBox) {
    std::mt19937 random(7);
    std::uniform_int_distribution<int> index(0, 15);
    std::uniform_real_distribution<float> anywhere(-10.0f, 26.0f);
    std::vector<ivec3> set(200);
    for (ivec3& voxel : set) voxel = {index(random), index(random), index(random)};
    const VoxelRowPicture picture = small_picture(set);
    int met_count = 0;
    for (int i = 0; i < 2000; ++i) {
        const vec3 origin{anywhere(random), anywhere(random), 40.0f};
        const vec3 direction = vec3(anywhere(random), anywhere(random), 8.0f) - origin;
        float nearest = 1e30f;
        for (const ivec3& voxel : set) {
            const vec3 a = (vec3(voxel) - origin) / direction, b = (vec3(voxel) + 1.0f - origin) / direction;
            const vec3 low = glm::min(a, b), high = glm::max(a, b);
            const float enter = std::max({low.x, low.y, low.z}), leave = std::min({high.x, high.y, high.z});
            if (enter < leave && enter > 0.0f) nearest = std::min(nearest, enter);
        }
        const auto met = first_set_voxel(picture, whole, origin, direction);
        ASSERT_EQ(met.has_value(), nearest < 1e30f) << "line " << i;
        if (!met) continue;
        ++met_count;
        EXPECT_TRUE(is_set(picture, met->voxel));
        EXPECT_NEAR(met->distance, nearest, 1e-4);
    }
    EXPECT_GT(met_count, 300);
}

TEST(FirstSetVoxel, LooksOnlyInsideTheBox) {
    const VoxelRowPicture picture = small_picture({{5, 5, 2}, {5, 5, 10}});
    const vec3 origin{5.5f, 5.5f, 30.0f}, direction{0.0f, 0.0f, -1.0f};
    EXPECT_EQ(first_set_voxel(picture, whole, origin, direction)->voxel, ivec3(5, 5, 10));
    EXPECT_EQ(first_set_voxel(picture, {ivec3(0), {15, 15, 9}}, origin, direction)->voxel, ivec3(5, 5, 2));
    EXPECT_FALSE(first_set_voxel(picture, {ivec3(0), ivec3(-1)}, origin, direction));
}

TEST(CutAway, KeepsTheSlabBehindTheRowSeenFromEitherSide) {
    const VoxelRowPicture picture = small_picture({});
    ViewState state;
    state.slab_voxels = 4;
    const Cut from_high = cut_away(picture, state, {0.0f, 0.0f, -1.0f});
    EXPECT_EQ(from_high.axis, 2);
    EXPECT_EQ(from_high.box, (VoxelBox{{0, 0, 4}, {15, 15, 7}}));
    const Cut from_low = cut_away(picture, state, {0.0f, 0.2f, 1.0f});
    EXPECT_EQ(from_low.box, (VoxelBox{{0, 0, 9}, {15, 15, 12}}));
    EXPECT_EQ(cut_away(picture, state, {0.0f, -1.0f, 0.3f}).axis, 1);
}

TEST(CutAway, TheSliceLimitsTheVoxelsAlongTheRow) {
    ViewState state;
    state.cut_away = CutAway::none;
    state.slice_first = 3;
    state.slice_last = 900;
    EXPECT_EQ(cut_away(small_picture({}), state, {0.0f, 0.0f, -1.0f}).box, (VoxelBox{{3, 0, 0}, {15, 15, 15}}));
}

}  // namespace
}  // namespace sightlines
