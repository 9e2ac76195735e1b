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

/// A solid object of 4 x 4 x 4 voxels of half a metre, turned a little, in a box of twice the size at `corner`; the ray
/// is asked of its row (4, 4).
inline ObjectPicture small_object(const std::string& name, vec3 corner, bool blocked) {
    VoxelRowPicture rows;
    rows.resolution = 8;
    std::vector<std::uint8_t> occupied(8 * 8 * 8, 0);
    for (int k = 0; k < 64; ++k)
        occupied[static_cast<std::size_t>(((2 + k / 16) * 8 + 2 + k / 4 % 4) * 8 + 2 + k % 4)] = 1;
    rows.occupied = std::make_shared<const std::vector<std::uint8_t>>(std::move(occupied));
    rows.world_from_voxels = mat4(vec4(0.48f, 0.0f, -0.14f, 0.0f), vec4(0.0f, 0.5f, 0.0f, 0.0f),
                                  vec4(0.14f, 0.0f, 0.48f, 0.0f), vec4(corner, 1.0f));
    rows.v = rows.w = 4;
    rows.first = blocked ? 1 : 6;
    rows.last = 7;
    const std::vector<vec3> bounds{corner, 8.0f * vec3(rows.world_from_voxels[0]),
                                   8.0f * vec3(rows.world_from_voxels[1]), 8.0f * vec3(rows.world_from_voxels[2])};
    return {name, bounds, blocked, std::make_shared<const VoxelRowPicture>(std::move(rows))};
}

/// An open row of what stands still, and three objects: one that the ray passes by, one that lets it by, one in the
/// way.
inline VoxelRowPicture picture_with_objects() {
    VoxelRowPicture picture = furnished_picture();
    picture.first = 7;
    picture.last = 11;
    ObjectPicture aside = small_object("instance 0", {1.0f, 11.0f, 5.0f}, false);
    aside.rows = nullptr;
    picture.objects = {aside, small_object("instance 1", {3.4f, 6.4f, 7.0f}, false),
                       small_object("instance 2", {8.2f, 6.6f, 7.0f}, true)};
    picture.blocked = true;
    picture.truly_blocked = true;
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
