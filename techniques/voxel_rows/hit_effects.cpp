#include "techniques/voxel_rows/hit_effects.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "techniques/base/parallel.h"
#include "techniques/base/random.h"
#include "techniques/rays/embree_scene.h"
#include "techniques/voxel_rows/first_hits.h"
#include "techniques/voxel_rows/vulkan_first_hits.h"

namespace sightlines::voxel_rows {
namespace {

/// Rays of one line of pixels, asked together.
struct LineRays {
    std::vector<std::size_t> pixels;
    std::vector<Segment> segments;
    std::vector<vec3> normals;
    std::vector<float> distances_m;

    void add(std::size_t pixel, const Segment& segment, vec3 normal) {
        pixels.push_back(pixel);
        segments.push_back(segment);
        normals.push_back(normal);
    }
};

/// The device is given so many lines at once; a line for itself would keep no device busy.
constexpr int lines_together = 16;

/// Fills in the distances, on the device in one go.
void ask_device(const HitQuery& query, std::span<LineRays> lines, const Progress& progress) {
    LineRays all;
    for (const LineRays& line : lines) {
        all.segments.insert(all.segments.end(), line.segments.begin(), line.segments.end());
        all.normals.insert(all.normals.end(), line.normals.begin(), line.normals.end());
    }
    all.distances_m.resize(all.segments.size());
    first_hits_on_vulkan(*query.on_device, query.shape, all.segments, all.normals, all.distances_m, progress);
    auto from = all.distances_m.begin();
    for (LineRays& line : lines) {
        const auto to = from + static_cast<std::ptrdiff_t>(line.segments.size());
        line.distances_m.assign(from, to);
        from = to;
    }
}

/// Asks the rays that `rays_of(pixel, rays)` adds for each pixel that shows a surface; `answer(rays)` for each line.
template <class RaysOf, class Answer>
void ask_lines(const HitQuery& query, const SurfaceBuffer& surfaces, int threads, Progress& progress,
               const RaysOf& rays_of, const Answer& answer) {
    const auto width = static_cast<std::size_t>(surfaces.size.width);
    progress.begin("looking for first hits", surfaces.size.height);
    for (int top = 0; top < surfaces.size.height; top += lines_together) {
        const int count = std::min(lines_together, surfaces.size.height - top);
        std::vector<LineRays> lines(static_cast<std::size_t>(count));
        parallel_for(count, threads, [&](std::int64_t k) {
            progress.check();
            LineRays& rays = lines[static_cast<std::size_t>(k)];
            const std::size_t start = static_cast<std::size_t>(top + k) * width;
            for (std::size_t p = start; p < start + width; ++p)
                if (surfaces.triangle[p] != no_triangle) rays_of(p, rays);
            if (query.on_device) return;
            rays.distances_m.resize(rays.segments.size());
            first_hits(query.array, query.shape, rays.segments, rays.normals, rays.distances_m);
        });
        if (query.on_device) ask_device(query, lines, progress);
        for (const LineRays& rays : lines) answer(rays);
        progress.advance(count);
    }
}

}  // namespace

vec3 cosine_direction(vec3 normal, float u, float v) {
    // A basis without branches on the normal (Duff et al. 2017).
    const float sign = std::copysign(1.0f, normal.z);
    const float a = -1.0f / (sign + normal.z), b = normal.x * normal.y * a;
    const vec3 tangent(1.0f + sign * normal.x * normal.x * a, sign * b, -sign * normal.x);
    const vec3 bitangent(b, sign + normal.y * normal.y * a, -normal.y);
    const float radius = std::sqrt(u), angle = 2.0f * std::numbers::pi_v<float> * v;
    return radius * std::cos(angle) * tangent + radius * std::sin(angle) * bitangent +
           std::sqrt(std::max(0.0f, 1.0f - u)) * normal;
}

ImageScalar ambient_openness(const HitQuery& query, const SurfaceBuffer& surfaces, const OcclusionOptions& options,
                             Progress& progress) {
    ImageScalar openness(surfaces.size, 1.0f);
    const auto rays_of = [&](std::size_t pixel, LineRays& rays) {
        const vec3 position = surfaces.position[pixel], normal = surfaces.normal[pixel];
        const auto stream = static_cast<std::uint32_t>(pixel);
        const float turn_u = random_unit(options.seed, stream, 0), turn_v = random_unit(options.seed, stream, 1);
        for (int k = 0; k < options.rays; ++k) {
            // A rank-1 lattice by the golden ratio, shifted by a random amount for each pixel.
            const float u = (static_cast<float>(k) + turn_u) / static_cast<float>(options.rays);
            const float v = glm::fract(static_cast<float>(k) * std::numbers::phi_v<float> + turn_v);
            const vec3 direction = cosine_direction(normal, u, v);
            rays.add(pixel, {position, position + options.reach_m * direction}, normal);
        }
    };
    ask_lines(query, surfaces, options.threads, progress, rays_of, [&](const LineRays& rays) {
        for (std::size_t k = 0; k < rays.pixels.size(); ++k) {
            const float blocked = 1.0f - std::min(rays.distances_m[k] / options.reach_m, 1.0f);
            openness.pixels[rays.pixels[k]] -= blocked / static_cast<float>(options.rays);
        }
    });
    return openness;
}

vec3 mirrored_direction(const SurfaceBuffer& surfaces, std::size_t pixel) {
    const auto width = static_cast<std::size_t>(surfaces.size.width);
    const vec2 middle = vec2(pixel % width, pixel / width) + 0.5f;
    const Segment seen = camera_ray(surfaces.camera, surfaces.size, middle, 1.0f);
    return glm::reflect(glm::normalize(seen.target - seen.origin), surfaces.shading_normal[pixel]);
}

SurfaceBuffer mirrored_surfaces(const HitQuery& query, const SurfaceVoxels& voxels, const SurfaceBuffer& surfaces,
                                int threads, Progress& progress) {
    SurfaceBuffer mirrored;
    const std::size_t count = surfaces.size.pixels();
    mirrored.size = surfaces.size;
    mirrored.camera = surfaces.camera;
    for (auto* vectors :
         {&mirrored.position, &mirrored.normal, &mirrored.shading_normal, &mirrored.albedo, &mirrored.emission})
        vectors->assign(count, vec3(0.0f));
    mirrored.triangle.assign(count, no_triangle);
    const auto rays_of = [&](std::size_t pixel, LineRays& rays) {
        const vec3 direction = mirrored_direction(surfaces, pixel);
        const vec3 position = surfaces.position[pixel];
        rays.add(pixel, {position, position + query.shape.reach_m * direction}, surfaces.normal[pixel]);
    };
    ask_lines(query, surfaces, threads, progress, rays_of, [&](const LineRays& rays) {
        for (std::size_t k = 0; k < rays.pixels.size(); ++k) {
            if (std::isinf(rays.distances_m[k])) continue;
            const vec3 direction = glm::normalize(rays.segments[k].target - rays.segments[k].origin);
            const vec3 point = rays.segments[k].origin + rays.distances_m[k] * direction;
            const auto surface = surface_at(voxels, point);
            if (!surface) continue;
            const std::size_t pixel = rays.pixels[k];
            const vec3 normal = glm::dot(surface->normal, direction) > 0.0f ? -surface->normal : surface->normal;
            mirrored.position[pixel] = point;
            mirrored.normal[pixel] = mirrored.shading_normal[pixel] = normal;
            mirrored.albedo[pixel] = surface->albedo;
            mirrored.triangle[pixel] = 0;
        }
    });
    return mirrored;
}

}  // namespace sightlines::voxel_rows
