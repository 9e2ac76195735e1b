// What the camera sees: primary rays by packets of 16, and the surface at each hit.
#include <array>
#include <cmath>

#include "techniques/base/parallel.h"
#include "techniques/rays/embree_handles.h"
#include "techniques/rays/embree_scene.h"
#include "techniques/rays/texture_sampling.h"

namespace sightlines {
namespace {

constexpr int tile_size = 8;  // pixels; four packets of 4x4
constexpr int packet_side = 4;
constexpr int packet_lanes = packet_side * packet_side;

struct CameraRay {
    vec3 origin, direction;  // unit direction
};

CameraRay ray_through(const Camera& camera, const CameraFrame& frame, ImageSize size, vec2 pixel) {
    const float x = (2.0f * pixel.x / static_cast<float>(size.width) - 1.0f) * frame.half_width;
    const float y = (1.0f - 2.0f * pixel.y / static_cast<float>(size.height)) * frame.half_height;
    if (camera.kind == CameraKind::orthographic)
        return {camera.position + x * frame.right + y * frame.up, frame.forward};
    return {camera.position, glm::normalize(frame.forward + x * frame.right + y * frame.up)};
}

vec3 unit_or(vec3 vector, vec3 otherwise) {
    const float length = glm::length(vector);
    return std::isfinite(length) && length > 0.0f ? vector / length : otherwise;
}

void write_surface(const SurfaceAt& seen, std::uint32_t triangle, std::size_t pixel, SurfaceBuffer& surfaces) {
    surfaces.triangle[pixel] = triangle;
    surfaces.position[pixel] = seen.position;
    surfaces.normal[pixel] = seen.normal;
    surfaces.shading_normal[pixel] = seen.shading_normal;
    surfaces.albedo[pixel] = seen.albedo;
    surfaces.gloss[pixel] = seen.gloss;
    surfaces.emission[pixel] = seen.emission;
}

struct PrimaryRays {
    const Scene& scene;
    const EmbreeScene& embree;
    const Camera& camera;
    CameraFrame frame;
    float farthest_m;

    /// Asks for the 4x4 pixels from (left, top); lanes outside the picture are off.
    void trace_packet(int left, int top, SurfaceBuffer& surfaces) const {
        const ImageSize size = surfaces.size;
        alignas(64) RTCRayHit16 rays{};
        alignas(64) int valid[packet_lanes];
        std::array<vec3, packet_lanes> directions{};
        for (int lane = 0; lane < packet_lanes; ++lane) {
            const int x = left + lane % packet_side;
            const int y = top + lane / packet_side;
            valid[lane] = x < size.width && y < size.height ? -1 : 0;
            const vec2 middle(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
            const CameraRay ray = ray_through(camera, frame, size, middle);
            directions[static_cast<std::size_t>(lane)] = ray.direction;
            rays.ray.org_x[lane] = ray.origin.x;
            rays.ray.org_y[lane] = ray.origin.y;
            rays.ray.org_z[lane] = ray.origin.z;
            rays.ray.dir_x[lane] = ray.direction.x;
            rays.ray.dir_y[lane] = ray.direction.y;
            rays.ray.dir_z[lane] = ray.direction.z;
            rays.ray.tfar[lane] = farthest_m;
            rays.ray.mask[lane] = 0xffffffffu;
            rays.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
            rays.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
        }
        const EmbreeQuery query(true);
        intersect_16(valid, embree, query, rays);
        for (int lane = 0; lane < packet_lanes; ++lane) {
            if (valid[lane] == 0 || rays.hit.geomID[lane] == RTC_INVALID_GEOMETRY_ID) continue;
            const Hit hit{rays.ray.tfar[lane],
                          triangle_hit(embree, rays.hit.geomID[lane], rays.hit.primID[lane]),
                          {rays.hit.u[lane], rays.hit.v[lane]}};
            const int x = left + lane % packet_side;
            const int y = top + lane / packet_side;
            write_surface(surface_at(scene, hit, directions[static_cast<std::size_t>(lane)]), hit.triangle,
                          pixel_index(size, x, y), surfaces);
        }
    }

    static std::size_t pixel_index(ImageSize size, int x, int y) {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width) + static_cast<std::size_t>(x);
    }
};

}  // namespace

SurfaceAt surface_at(const Scene& scene, const Hit& hit, vec3 ray_direction) {
    const uvec3 vertices = scene.triangles[hit.triangle];
    const vec2 barycentric = hit.barycentric;
    const vec3 weights(1.0f - barycentric.x - barycentric.y, barycentric.x, barycentric.y);
    const vec3 a = scene.positions[vertices.x];
    const vec3 b = scene.positions[vertices.y];
    const vec3 c = scene.positions[vertices.z];
    SurfaceAt surface;
    surface.position = weights.x * a + weights.y * b + weights.z * c;
    surface.normal = unit_or(glm::cross(b - a, c - a), -ray_direction);
    if (glm::dot(surface.normal, ray_direction) > 0.0f) surface.normal = -surface.normal;
    surface.shading_normal = unit_or(weights.x * scene.normals[vertices.x] + weights.y * scene.normals[vertices.y] +
                                         weights.z * scene.normals[vertices.z],
                                     surface.normal);
    if (glm::dot(surface.shading_normal, surface.normal) < 0.0f) surface.shading_normal = -surface.shading_normal;
    const Material& material = scene.materials[scene.triangle_materials[hit.triangle]];
    surface.albedo = diffuse_albedo(scene, hit.triangle, barycentric);
    surface.gloss = {material.roughness, material.metallic};
    surface.emission = material.emissive * vec3(looked_up(scene, material.emissive_texture, hit.triangle, barycentric));
    return surface;
}

Segment camera_ray(const Camera& camera, ImageSize size, vec2 pixel, float length_m) {
    const CameraRay ray = ray_through(camera, camera_frame(camera, size), size, pixel);
    return {ray.origin, ray.origin + length_m * ray.direction};
}

SurfaceBuffer visible_surfaces(const Scene& scene, const EmbreeScene& embree, const Camera& camera, ImageSize size,
                               int threads, Progress& progress) {
    const std::size_t pixels = size.pixels();
    SurfaceBuffer surfaces{size,
                           camera,
                           std::vector<vec3>(pixels, vec3(0.0f)),
                           std::vector<vec3>(pixels, vec3(0.0f)),
                           std::vector<vec3>(pixels, vec3(0.0f)),
                           std::vector<vec3>(pixels, vec3(0.0f)),
                           std::vector<vec3>(pixels, vec3(0.0f)),
                           std::vector<std::uint32_t>(pixels, no_triangle),
                           std::vector<vec2>(pixels, vec2(0.0f))};
    const int columns = (size.width + tile_size - 1) / tile_size;
    const int rows = (size.height + tile_size - 1) / tile_size;
    const PrimaryRays rays{scene, embree, camera, camera_frame(camera, size), std::numeric_limits<float>::infinity()};
    progress.begin("finding what the camera sees", static_cast<std::int64_t>(columns) * rows);
    parallel_for(static_cast<std::int64_t>(columns) * rows, threads, [&](std::int64_t tile) {
        const int left = static_cast<int>(tile % columns) * tile_size;
        const int top = static_cast<int>(tile / columns) * tile_size;
        for (int y = 0; y < tile_size; y += packet_side)
            for (int x = 0; x < tile_size; x += packet_side) rays.trace_packet(left + x, top + y, surfaces);
        progress.advance();
    });
    return surfaces;
}

}  // namespace sightlines
