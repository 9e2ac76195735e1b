#include "techniques/voxel_rows/surface_voxels.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "techniques/rays/texture_sampling.h"
#include "techniques/scene/surface_fragments.h"

namespace sightlines::voxel_rows {
namespace {

ivec3 cell_of(const SurfaceVoxels& voxels, vec3 point) {
    const ivec3 cell((point - voxels.bounds.lowest) / voxels.cell_m);
    return glm::clamp(cell, ivec3(0), voxels.cells - 1);
}

std::size_t index_of(const SurfaceVoxels& voxels, ivec3 cell) {
    const auto row =
        static_cast<std::size_t>(cell.z) * static_cast<std::size_t>(voxels.cells.y) + static_cast<std::size_t>(cell.y);
    return row * static_cast<std::size_t>(voxels.cells.x) + static_cast<std::size_t>(cell.x);
}

/// Of a point in the triangle's plane, by areas; clamped into the triangle. The second and the third corner's weight.
vec2 barycentric_of(const Scene& scene, std::uint32_t triangle, vec3 point) {
    const uvec3 corners = scene.triangles[triangle];
    const vec3 a = scene.positions[corners.x];
    const vec3 ab = scene.positions[corners.y] - a, ac = scene.positions[corners.z] - a, ap = point - a;
    const vec3 normal = glm::cross(ab, ac);
    const float squared = glm::dot(normal, normal);
    if (!(squared > 0.0f)) return vec2(0.0f);
    const float second = glm::dot(glm::cross(ap, ac), normal) / squared;
    const float third = glm::dot(glm::cross(ab, ap), normal) / squared;
    const vec2 inside = glm::clamp(vec2(second, third), vec2(0.0f), vec2(1.0f));
    return inside / std::max(1.0f, inside.x + inside.y);
}

}  // namespace

SurfaceVoxels voxelize_surface(const Scene& scene, int resolution, int threads, Progress& progress) {
    constexpr int samples_per_voxel = 2;
    SurfaceVoxels voxels;
    voxels.bounds = scene.bounds.empty() ? Box3{vec3(-0.5f), vec3(0.5f)} : scene.bounds;
    const vec3 size = voxels.bounds.size();
    voxels.cell_m = std::max({size.x, size.y, size.z, 1.0e-3f}) / static_cast<float>(resolution);
    voxels.cells = glm::max(ivec3(glm::ceil(size / voxels.cell_m)), ivec3(1));
    const FragmentGrid grid{voxels.bounds, voxels.cells * samples_per_voxel};
    const std::size_t count = index_of(voxels, voxels.cells - 1) + 1;
    voxels.colours.assign(count, glm::u8vec4(0));
    voxels.normals.assign(count, glm::i8vec4(0));
    std::vector<glm::vec4> colour_sums(count);  // w: area
    std::vector<vec3> normal_sums(count);
    for (const Fragment& fragment : surface_fragments(scene, grid, threads, progress)) {
        const std::size_t voxel = index_of(voxels, cell_of(voxels, fragment.position));
        const vec2 barycentric = barycentric_of(scene, fragment.triangle, fragment.position);
        colour_sums[voxel] += fragment.area_m2 * glm::vec4(diffuse_albedo(scene, fragment.triangle, barycentric), 1.0f);
        // The two sides of a thin sheet would cancel: all are turned to the side of the first.
        vec3 normal = winding_normal(scene, fragment.triangle);
        if (glm::dot(normal, normal_sums[voxel]) < 0.0f) normal = -normal;
        normal_sums[voxel] += fragment.area_m2 * normal;
    }
    for (std::size_t voxel = 0; voxel < count; ++voxel) {
        const float area = colour_sums[voxel].w, length = glm::length(normal_sums[voxel]);
        if (!(area > 0.0f) || !(length > 0.0f)) continue;
        voxels.colours[voxel] = glm::u8vec4(glm::clamp(colour_sums[voxel] / area, 0.0f, 1.0f) * 255.0f + 0.5f);
        voxels.normals[voxel] = glm::i8vec4(glm::vec4(glm::round(normal_sums[voxel] / length * 127.0f), 0.0f));
    }
    return voxels;
}

std::optional<VoxelSurface> surface_at(const SurfaceVoxels& voxels, vec3 point) {
    const ivec3 own = cell_of(voxels, point);
    float nearest = std::numeric_limits<float>::infinity();
    std::optional<VoxelSurface> found;
    for (int z = -1; z <= 1; ++z)
        for (int y = -1; y <= 1; ++y)
            for (int x = -1; x <= 1; ++x) {
                const ivec3 cell = own + ivec3(x, y, z);
                if (glm::any(glm::lessThan(cell, ivec3(0))) || glm::any(glm::greaterThanEqual(cell, voxels.cells)))
                    continue;
                const std::size_t voxel = index_of(voxels, cell);
                if (voxels.colours[voxel].w == 0) continue;
                const vec3 middle = voxels.bounds.lowest + (vec3(cell) + 0.5f) * voxels.cell_m;
                const float distance = cell == own ? 0.0f : glm::distance(middle, point);
                if (distance >= nearest) continue;
                nearest = distance;
                found = VoxelSurface{vec3(voxels.colours[voxel]) / 255.0f, glm::normalize(vec3(voxels.normals[voxel]))};
            }
    return found;
}

}  // namespace sightlines::voxel_rows
