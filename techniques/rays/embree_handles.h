// What is inside an EmbreeScene. Internal to this folder.
#pragma once

#include <memory>
#include <vector>

#include "techniques/rays/embree_scene.h"
#include "techniques/rays/embree_version.h"

namespace sightlines {

struct ReleaseDevice {
    void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct ReleaseScene {
    void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using DeviceHandle = std::unique_ptr<RTCDeviceTy, ReleaseDevice>;
using SceneHandle = std::unique_ptr<RTCSceneTy, ReleaseScene>;

/// What decides where a masked material has holes: the texture's alpha alone, times a factor, against a cutoff.
struct AlphaMask {
    ImageSize size{0, 0};
    Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
    std::vector<std::uint8_t> alpha;
    float factor = 1.0f, cutoff = 0.5f;
};

struct MaskedTriangle {
    vec2 corners[3];  ///< texture coordinates, transformed
    std::uint32_t mask = 0;
};

/// The masked triangles, in the order of their Embree geometry. Embree's filter functions hold its address.
struct MaskedTriangles {
    std::vector<AlphaMask> masks;
    std::vector<MaskedTriangle> triangles;
};

/// Opaque and masked triangles are two Embree geometries, so that opaque ones never pay for a texture lookup.
/// A moment's tree has those of what changes, numbered after the two of `fixed`.
struct EmbreeScene {
    DeviceHandle device;
    SceneHandle scene;
    std::vector<vec3> positions;                    ///< shared with Embree; one more than are used, for its wide loads
    std::vector<std::uint32_t> scene_triangles[2];  ///< [geometry][primitive]: index into Scene::triangles
    MaskedTriangles masked;
    /// A moment's: the tree of what never changes, which every ray asks first. Not an instance: Embree 3.13 does not
    /// return from some packets that meet one (coherent, robust).
    std::shared_ptr<const EmbreeScene> fixed;
    EmbreeUse use = EmbreeUse::reference;
    float extent_m = 1.0f;  ///< largest of the bounds' diagonal and coordinates: what rounding errors scale with
    float reach_m = 1.0f;   ///< how far directional lights are put away: the bounds' diagonal
};

constexpr unsigned opaque_geometry = 0, masked_geometry = 1, geometries_per_tree = 2;

/// Embree's number of a geometry of this tree's own.
inline unsigned geometry_number(const EmbreeScene& embree, unsigned id) {
    return embree.fixed ? geometries_per_tree + id : id;
}

/// The scene's triangle that Embree's two numbers of a hit stand for.
inline std::uint32_t triangle_hit(const EmbreeScene& embree, unsigned geometry, unsigned primitive) {
    const bool of_fixed = embree.fixed && geometry < geometries_per_tree;
    return (of_fixed ? *embree.fixed : embree).scene_triangles[geometry % geometries_per_tree][primitive];
}

/// Asks both trees of a moment. What the first has blocked is not asked again: its tfar is less than tnear.
template <class Ask>
void ask_in_turn(const EmbreeScene& embree, const Ask& ask) {
    if (embree.fixed) ask(embree.fixed->scene.get());
    ask(embree.scene.get());
}
inline void intersect_1(const EmbreeScene& embree, const EmbreeQuery& query, RTCRayHit& ray) {
    ask_in_turn(embree, [&](RTCScene scene) { intersect_1(scene, query, ray); });
}
inline void intersect_16(const int* valid, const EmbreeScene& embree, const EmbreeQuery& query, RTCRayHit16& rays) {
    ask_in_turn(embree, [&](RTCScene scene) { intersect_16(valid, scene, query, rays); });
}
inline void occluded_1(const EmbreeScene& embree, const EmbreeQuery& query, RTCRay& ray) {
    ask_in_turn(embree, [&](RTCScene scene) { occluded_1(scene, query, ray); });
}
inline void occluded_packet(const int* valid, const EmbreeScene& embree, const EmbreeQuery& query, RTCRay8& rays) {
    ask_in_turn(embree, [&](RTCScene scene) { occluded_8(valid, scene, query, rays); });
}
inline void occluded_packet(const int* valid, const EmbreeScene& embree, const EmbreeQuery& query, RTCRay16& rays) {
    ask_in_turn(embree, [&](RTCScene scene) { occluded_16(valid, scene, query, rays); });
}
inline void occluded_stream(const EmbreeScene& embree, const EmbreeQuery& query, RTCRay16* packets, unsigned count) {
    ask_in_turn(embree, [&](RTCScene scene) { occluded_stream(scene, query, packets, count); });
}

/// Shadow rays end this far above the surface: a hundred-thousandth of the scene's extent. Rounding moves a point of a
/// surface by less than a hundredth of that (24 bits), and the thinnest things worth a shadow are a hundred times it.
inline float surface_offset_m(const EmbreeScene& scene) { return 1.0e-5f * scene.extent_m; }

/// A shadow ray is light + t (end - light), with `end` the surface point moved by surface_offset_m along its normal,
/// and t between these two: things that touch the light do not hide it, and rounding does not reach past the end.
constexpr float shadow_ray_near = 1.0e-5f, shadow_ray_far = 1.0f - 1.0e-6f;

}  // namespace sightlines
