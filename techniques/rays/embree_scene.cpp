#include "techniques/rays/embree_scene.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <map>
#include <string>

#include <tbb/task_arena.h>

#include "techniques/base/parallel.h"
#include "techniques/rays/embree_handles.h"
#include "techniques/rays/texture_sampling.h"

namespace sightlines {
namespace {

bool is_solid(const MaskedTriangles& masked, unsigned primitive, vec2 barycentric) {
    const MaskedTriangle& triangle = masked.triangles[primitive];
    const AlphaMask& mask = masked.masks[triangle.mask];
    const vec2 coordinates = (1.0f - barycentric.x - barycentric.y) * triangle.corners[0] +
                             barycentric.x * triangle.corners[1] + barycentric.y * triangle.corners[2];
    const BilinearTap tap = bilinear_tap(mask.size, mask.wrap_u, mask.wrap_v, coordinates);
    float alpha = 0.0f;
    for (std::size_t corner = 0; corner < 4; ++corner)
        alpha += tap.weight[corner] * static_cast<float>(mask.alpha[tap.texel[corner]]);
    return mask.factor * alpha >= 255.0f * mask.cutoff;
}

/// Embree calls this for every hit with a masked triangle: hits in a hole do not count.
void reject_holes(const RTCFilterFunctionNArguments* arguments) {
    const auto& masked = *static_cast<const MaskedTriangles*>(arguments->geometryUserPtr);
    for (unsigned lane = 0; lane < arguments->N; ++lane) {
        if (arguments->valid[lane] == 0) continue;
        const vec2 barycentric(RTCHitN_u(arguments->hit, arguments->N, lane),
                               RTCHitN_v(arguments->hit, arguments->N, lane));
        if (!is_solid(masked, RTCHitN_primID(arguments->hit, arguments->N, lane), barycentric))
            arguments->valid[lane] = 0;
    }
}

AlphaMask alpha_mask(const Material& material, const Texture& texture) {
    AlphaMask mask{texture.texels.size, texture.wrap_u, texture.wrap_v, {}, material.alpha, material.alpha_cutoff};
    mask.alpha.reserve(texture.texels.pixels.size());
    for (const glm::u8vec4 texel : texture.texels.pixels) mask.alpha.push_back(texel.a);
    return mask;
}

enum class Solidity { opaque, masked, invisible };

/// Blended materials count as opaque: shadows are all or nothing here.
Solidity solidity(const Scene& scene, const Material& material) {
    if (material.alpha_mode != AlphaMode::mask) return Solidity::opaque;
    const auto& lookup = material.base_color_texture;
    const bool textured = lookup && !scene.textures[lookup->texture].texels.empty() &&
                          !scene.texture_coordinates[lookup->coordinate_set].empty();
    if (textured) return Solidity::masked;
    return material.alpha >= material.alpha_cutoff ? Solidity::opaque : Solidity::invisible;
}

/// Sorts the wanted triangles into the two geometries and copies what the masks need.
void sort_triangles(const Scene& scene, const std::vector<std::uint8_t>& wanted, EmbreeScene& embree) {
    std::map<std::uint32_t, std::uint32_t> mask_of_material;
    for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
        if (wanted[t] == 0) continue;
        const std::uint32_t material_index = scene.triangle_materials[t];
        const Material& material = scene.materials[material_index];
        const Solidity kind = solidity(scene, material);
        if (kind == Solidity::opaque) embree.scene_triangles[opaque_geometry].push_back(t);
        if (kind != Solidity::masked) continue;
        embree.scene_triangles[masked_geometry].push_back(t);
        const TextureLookup& lookup = *material.base_color_texture;
        const auto [mask, is_new] =
            mask_of_material.try_emplace(material_index, static_cast<std::uint32_t>(embree.masked.masks.size()));
        if (is_new) embree.masked.masks.push_back(alpha_mask(material, scene.textures[lookup.texture]));
        MaskedTriangle triangle;
        triangle.mask = mask->second;
        for (int corner = 0; corner < 3; ++corner) {
            const std::uint32_t vertex = scene.triangles[t][corner];
            triangle.corners[corner] =
                transformed_coordinates(lookup, scene.texture_coordinates[lookup.coordinate_set][vertex]);
        }
        embree.masked.triangles.push_back(triangle);
    }
}

/// Throws what Embree has to complain of, if it has.
void check_embree(const EmbreeScene& embree) {
    const RTCError error = rtcGetDeviceError(embree.device.get());
    if (error == RTC_ERROR_NONE) return;
    if (error == RTC_ERROR_CANCELLED) throw Cancelled();
    if (error == RTC_ERROR_OUT_OF_MEMORY)
        throw EnvironmentError("Embree", "out of memory while building", "choose a smaller scene");
    if (error == RTC_ERROR_UNSUPPORTED_CPU) throw EnvironmentError("Embree", "does not support this processor");
    throw EnvironmentError("Embree", "failed with error " + std::to_string(static_cast<int>(error)));
}

/// Copies the vertices from the first to the last that the sorted triangles use: few where little moves. Gives the
/// first.
std::uint32_t copy_positions(const Scene& scene, EmbreeScene& embree) {
    std::uint32_t first = std::numeric_limits<std::uint32_t>::max(), end = 0;
    for (const std::vector<std::uint32_t>& members : embree.scene_triangles) {
        for (const std::uint32_t t : members) {
            const uvec3 corners = scene.triangles[t];
            first = std::min({first, corners.x, corners.y, corners.z});
            end = std::max({end, corners.x + 1, corners.y + 1, corners.z + 1});
        }
    }
    first = std::min(first, end);
    embree.positions.reserve(end - first + 1u);
    embree.positions.assign(scene.positions.begin() + first, scene.positions.begin() + end);
    embree.positions.emplace_back(0.0f);
    return first;
}

void attach_geometry(const Scene& scene, std::uint32_t first_vertex, EmbreeScene& embree, unsigned id) {
    const std::vector<std::uint32_t>& members = embree.scene_triangles[id];
    if (members.empty()) return;
    RTCGeometry geometry = rtcNewGeometry(embree.device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, embree.positions.data(), 0,
                               sizeof(vec3), embree.positions.size() - 1);
    auto* indices = static_cast<uvec3*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(uvec3), members.size()));
    for (std::size_t i = 0; indices != nullptr && i < members.size(); ++i)
        indices[i] = scene.triangles[members[i]] - first_vertex;
    if (id == masked_geometry) {
        rtcSetGeometryUserData(geometry, &embree.masked);
        rtcSetGeometryIntersectFilterFunction(geometry, reject_holes);
        rtcSetGeometryOccludedFilterFunction(geometry, reject_holes);
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(embree.scene.get(), geometry, geometry_number(embree, id));
    rtcReleaseGeometry(geometry);
    check_embree(embree);
}

Box3 bounds_of(const Scene& scene, const std::vector<std::uint8_t>& wanted) {
    Box3 bounds;
    for (std::size_t t = 0; t < wanted.size(); ++t)
        for (int corner = 0; wanted[t] != 0 && corner < 3; ++corner)
            bounds.add(scene.positions[scene.triangles[t][corner]]);
    return bounds;
}

void set_extents(const Box3& bounds, EmbreeScene& embree) {
    if (bounds.empty()) return;
    const vec3 coordinates = glm::max(glm::abs(bounds.lowest), glm::abs(bounds.highest));
    const float diagonal = bounds.diagonal();
    if (diagonal > 0.0f) embree.reach_m = diagonal;
    embree.extent_m =
        std::max({diagonal, coordinates.x, coordinates.y, coordinates.z, std::numeric_limits<float>::min()});
}

/// Passes Embree's own progress on, and our wish to stop back.
struct BuildMonitor {
    Progress& progress;
    std::atomic<int> percent{0};
};

bool monitor_build(void* user, double fraction) {
    auto& monitor = *static_cast<BuildMonitor*>(user);
    const int now = std::clamp(static_cast<int>(fraction * 100.0), 0, 100);
    int before = monitor.percent.load();
    while (before < now && !monitor.percent.compare_exchange_weak(before, now)) {}
    if (monitor.progress.cancelled()) return false;
    if (before < now) {
        try {
            monitor.progress.advance(now - before);
        } catch (const Cancelled&) {  // an exception must not pass through Embree
            return false;
        }
    }
    return true;
}

RTCRayHit ray_hit(vec3 origin, vec3 direction, float nearest, float farthest) {
    RTCRayHit ray{};
    ray.ray.org_x = origin.x;
    ray.ray.org_y = origin.y;
    ray.ray.org_z = origin.z;
    ray.ray.tnear = nearest;
    ray.ray.dir_x = direction.x;
    ray.ray.dir_y = direction.y;
    ray.ray.dir_z = direction.z;
    ray.ray.tfar = farthest;
    ray.ray.mask = 0xffffffffu;
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    return ray;
}

std::shared_ptr<const EmbreeScene> build_tree(const Scene& scene, EmbreeUse use, int threads, Progress& progress,
                                              PartChoice parts, std::shared_ptr<const EmbreeScene> fixed) {
    progress.begin("building the ray tracer's hierarchy", 100);
    progress.check();
    const auto embree = std::make_shared<EmbreeScene>();
    embree->fixed = std::move(fixed);
    embree->use = use;
    embree->device.reset(rtcNewDevice(nullptr));
    check_embree(*embree);
    embree->scene.reset(rtcNewScene(embree->device.get()));
    check_embree(*embree);
    // Measured: HIGH quality (spatial splits) makes packets slower by a quarter on Sponza, and changes nothing
    // elsewhere (count_blocked.cpp).
    const bool is_reference = use == EmbreeUse::reference;
    const RTCBuildQuality quality = is_reference ? RTC_BUILD_QUALITY_HIGH : RTC_BUILD_QUALITY_MEDIUM;
    rtcSetSceneBuildQuality(embree->scene.get(), quality);
    rtcSetSceneFlags(embree->scene.get(), is_reference ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);

    const std::vector<std::uint8_t> wanted = triangles_of(scene, parts);
    const bool whole = parts == PartChoice::all || embree->fixed;
    set_extents(whole ? scene.bounds : bounds_of(scene, wanted), *embree);
    sort_triangles(scene, wanted, *embree);
    const std::uint32_t first_vertex = copy_positions(scene, *embree);
    attach_geometry(scene, first_vertex, *embree, opaque_geometry);
    attach_geometry(scene, first_vertex, *embree, masked_geometry);

    BuildMonitor monitor{progress};
    rtcSetSceneProgressMonitorFunction(embree->scene.get(), monitor_build, &monitor);
    tbb::task_arena arena(thread_count(threads));
    arena.execute([&] { rtcJoinCommitScene(embree->scene.get()); });
    rtcSetSceneProgressMonitorFunction(embree->scene.get(), nullptr, nullptr);
    progress.check();
    check_embree(*embree);
    return embree;
}

}  // namespace

std::shared_ptr<const EmbreeScene> build_embree_scene(const Scene& scene, EmbreeUse use, int threads,
                                                      Progress& progress, PartChoice parts) {
    return build_tree(scene, use, threads, progress, parts, nullptr);
}

std::shared_ptr<const EmbreeScene> build_moment_tree(const Scene& scene, std::shared_ptr<const EmbreeScene> fixed,
                                                     int threads, Progress& progress) {
    const EmbreeUse use = fixed->use;
    return build_tree(scene, use, threads, progress, PartChoice::changing, std::move(fixed));
}

std::optional<Hit> closest_hit(const EmbreeScene& scene, vec3 origin, vec3 direction, float farthest_m) {
    const EmbreeQuery query(false);
    RTCRayHit ray = ray_hit(origin, direction, 0.0f, farthest_m);
    intersect_1(scene, query, ray);
    if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
    const std::uint32_t triangle = triangle_hit(scene, ray.hit.geomID, ray.hit.primID);
    return Hit{ray.ray.tfar, triangle, {ray.hit.u, ray.hit.v}};
}

bool occluded(const EmbreeScene& scene, const Segment& segment, vec3 normal) {
    const EmbreeQuery query(false);
    const vec3 end = segment.origin + surface_offset_m(scene) * normal;
    RTCRay ray = ray_hit(segment.target, end - segment.target, shadow_ray_near, shadow_ray_far).ray;
    occluded_1(scene, query, ray);
    return ray.tfar < 0.0f;
}

}  // namespace sightlines
