// Small worlds that the tests of the view inside look at.
#pragma once

#include <algorithm>
#include <vector>

#include "visualizers/voxel_row_view.h"

namespace sightlines {

/// A floor, as two triangles, one metre below the voxels.
inline std::shared_ptr<const Scene> floor_scene() {
    Scene scene;
    scene.positions = {{-4.0f, -1.0f, -4.0f}, {20.0f, -1.0f, -4.0f}, {20.0f, -1.0f, 20.0f}, {-4.0f, -1.0f, 20.0f}};
    scene.normals.assign(4, vec3(0.0f, 1.0f, 0.0f));
    scene.triangles = {{0, 2, 1}, {0, 3, 2}};
    scene.triangle_materials = {0, 0};
    scene.materials.resize(1);
    scene.cameras.resize(1);
    for (const vec3& position : scene.positions) scene.bounds.add(position);
    return std::make_shared<const Scene>(std::move(scene));
}

/// 16^3 voxels of one metre, the row v = 8, w = 8, its voxels 3 .. 12 kept; `set` are the voxels that are set.
inline VoxelRowPicture small_picture(const std::vector<ivec3>& set) {
    VoxelRowPicture picture;
    picture.resolution = 16;
    std::vector<std::uint8_t> occupied(16 * 16 * 16, 0);
    for (const ivec3& voxel : set) occupied[static_cast<std::size_t>((voxel.z * 16 + voxel.y) * 16 + voxel.x)] = 1;
    picture.occupied = std::make_shared<const std::vector<std::uint8_t>>(std::move(occupied));
    picture.v = 8;
    picture.w = 8;
    picture.first = 3;
    picture.last = 12;
    picture.ray = {{2.6f, 8.3f, 8.5f}, {13.4f, 8.7f, 8.5f}};
    picture.angular_error_deg = 2.12f;
    picture.theta_deg = 0.0f;
    picture.phi_deg = 90.0f;
    for (int u = picture.first; u <= picture.last; ++u) picture.blocked |= is_set(picture, {u, 8, 8});
    picture.truly_blocked = picture.blocked;
    return picture;
}

/// A wall behind the row, a block on the floor, and three bits of the row: one inside the extent, one outside, one at
/// its end.
inline VoxelRowPicture furnished_picture() {
    std::vector<ivec3> set{{6, 8, 8}, {12, 8, 8}, {14, 8, 8}};
    for (int u = 0; u < 16; ++u)
        for (int v = 0; v < 12; ++v) set.emplace_back(u, v, 2);
    for (int u = 4; u < 8; ++u)
        for (int v = 0; v < 3; ++v)
            for (int w = 4; w < 8; ++w) set.emplace_back(u, v, w);
    VoxelRowPicture picture = small_picture(set);
    picture.scene = floor_scene();
    return picture;
}

/// Only the solid voxels: nothing else can be mistaken for them.
inline ViewState voxels_only() {
    ViewState state;
    state.scene = state.row = state.extent = state.ray = state.twin = state.labels = false;
    return state;
}

inline std::size_t pixels_drawn(const ImageRgba8& image) {
    return static_cast<std::size_t>(std::ranges::count_if(image.pixels, [](glm::u8vec4 p) { return p.a > 0; }));
}

/// How many pixels are within `tolerance` (8-bit steps, each channel) of an sRGB colour in [0, 1].
inline std::size_t pixels_near(const ImageRgba8& image, vec3 colour, int tolerance) {
    const ivec3 wanted(colour * 255.0f + 0.5f);
    return static_cast<std::size_t>(std::ranges::count_if(image.pixels, [&](glm::u8vec4 p) {
        const ivec3 difference = glm::abs(ivec3(p.r, p.g, p.b) - wanted);
        return p.a > 200 && std::max({difference.x, difference.y, difference.z}) <= tolerance;
    }));
}

}  // namespace sightlines
