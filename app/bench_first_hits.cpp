#include "app/bench_first_hits.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "techniques/base/parallel.h"
#include "techniques/base/random.h"
#include "techniques/voxel_rows/first_hits.h"
#include "techniques/voxel_rows/hit_effects.h"
#include "techniques/voxel_rows/query.h"
#include "techniques/voxel_rows/voxel_rows.h"

namespace sightlines {
namespace {

/// Rays from surfaces, all equally long.
struct HitRays {
    std::vector<Segment> segments;
    std::vector<vec3> normals;
};

template <class DirectionOf>
HitRays rays_of(const SurfaceBuffer& surfaces, float length_m, const DirectionOf& direction_of) {
    HitRays rays;
    for (std::size_t pixel = 0; pixel < surfaces.triangle.size(); ++pixel) {
        if (surfaces.triangle[pixel] == no_triangle) continue;
        const vec3 position = surfaces.position[pixel];
        rays.segments.push_back({position, position + length_m * direction_of(pixel)});
        rays.normals.push_back(surfaces.normal[pixel]);
    }
    return rays;
}

std::vector<float> true_distances(const EmbreeScene& embree, const HitRays& rays, float offset_m, int threads) {
    std::vector<float> distances(rays.segments.size(), std::numeric_limits<float>::infinity());
    parallel_for(static_cast<std::int64_t>(distances.size()), threads, [&](std::int64_t index) {
        const auto k = static_cast<std::size_t>(index);
        const Segment& segment = rays.segments[k];
        const vec3 along = segment.target - segment.origin;
        const float length_m = glm::length(along);
        const auto hit = closest_hit(embree, segment.origin + offset_m * rays.normals[k], along / length_m, length_m);
        if (hit) distances[k] = hit->distance_m;
    });
    return distances;
}

/// The value below which `share` of the values lie.
double quantile(std::vector<double> values, double share) {
    if (values.empty()) return 0.0;
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::ranges::nth_element(values, at);
    return *at;
}

FirstHitRow measured(const std::string& key, const HitRays& rays, const voxel_rows::RowArray& array,
                     const RowShape& query, std::span<const float> truth, double voxel_m, int threads) {
    std::vector<float> ours(rays.segments.size());
    constexpr std::size_t piece = 4096;
    const auto start = std::chrono::steady_clock::now();
    parallel_for(static_cast<std::int64_t>((ours.size() + piece - 1) / piece), threads, [&](std::int64_t index) {
        const std::size_t first = static_cast<std::size_t>(index) * piece;
        const std::size_t count = std::min(piece, ours.size() - first);
        voxel_rows::first_hits(array, query, std::span(rays.segments).subspan(first, count),
                               std::span(rays.normals).subspan(first, count), std::span(ours).subspan(first, count));
    });
    FirstHitRow row;
    row.key = key;
    row.rays = ours.size();
    row.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    std::vector<double> signed_m, absolute_m;
    std::uint64_t agree = 0;
    for (std::size_t k = 0; k < ours.size(); ++k) {
        agree += std::isfinite(ours[k]) == std::isfinite(truth[k]);
        if (!std::isfinite(ours[k]) || !std::isfinite(truth[k])) continue;
        signed_m.push_back(static_cast<double>(ours[k] - truth[k]));
        absolute_m.push_back(std::abs(signed_m.back()));
    }
    row.agree_percent = 100.0 * static_cast<double>(agree) / static_cast<double>(std::max<std::size_t>(ours.size(), 1));
    row.median_m = quantile(absolute_m, 0.5);
    row.median_voxels = row.median_m / voxel_m;
    row.ninetieth_voxels = quantile(absolute_m, 0.9) / voxel_m;
    row.bias_voxels = quantile(signed_m, 0.5) / voxel_m;
    return row;
}

}  // namespace

FirstHitBench bench_first_hits(const Session& session, Results& results, Progress& progress) {
    const auto scene = results.scene(session, progress);
    const auto embree = results.embree(session, progress);
    const auto surfaces = results.surfaces(session, progress);
    const auto structure = results.structure(session, progress);
    const voxel_rows::RowArray& array = voxel_rows::row_array(structure->value.structure);
    const RowShape query = voxel_rows::make_query(array, technique_parameters(session), {});
    const vec3 size = array.grid.bounds.size();
    const SurfaceBuffer& seen = surfaces->value;
    FirstHitBench bench{session, std::max({size.x, size.y, size.z}) / static_cast<double>(query.resolution), {}};
    const auto measure = [&](const std::string& key, const HitRays& rays) {
        progress.begin("tracing " + key + " rays", 1);
        const auto truth =
            true_distances(*embree->value, rays, 1e-5f * scene->value.bounds.diagonal(), results.threads());
        bench.rows.push_back(measured(key, rays, array, query, truth, bench.voxel_m, results.threads()));
        progress.check();
    };
    measure("mirror", rays_of(seen, query.reach_m,
                              [&](std::size_t pixel) { return voxel_rows::mirrored_direction(seen, pixel); }));
    measure("hemisphere", rays_of(seen, query.reach_m, [&](std::size_t pixel) {
                const auto stream = static_cast<std::uint32_t>(pixel);
                return voxel_rows::cosine_direction(seen.normal[pixel], random_unit(session.seed, stream, 0),
                                                    random_unit(session.seed, stream, 1));
            }));
    return bench;
}

Json json_from_bench(const FirstHitBench& bench) {
    Json rows = Json::object();
    for (const FirstHitRow& row : bench.rows)
        rows[row.key] = {{"rays", row.rays},
                         {"agree_percent", row.agree_percent},
                         {"median_voxels", row.median_voxels},
                         {"ninetieth_voxels", row.ninetieth_voxels},
                         {"bias_voxels", row.bias_voxels},
                         {"median_m", row.median_m},
                         {"mrays_per_second", 1e-6 * static_cast<double>(row.rays) / row.seconds}};
    return {{"scene", bench.session.scene}, {"voxel_m", bench.voxel_m}, {"rays", rows}};
}

std::string heading_from_bench(const FirstHitBench& bench) {
    return "First hits: " + bench.session.scene + ", " + std::to_string(bench.session.size.width) + " x " +
           std::to_string(bench.session.size.height) + " pixels, against Embree; a voxel is " +
           fixed_text(bench.voxel_m, 3) + " m\n";
}

TextTable table_from_bench(const FirstHitBench& bench) {
    TextTable table;
    table.heading = {
        "rays", "M rays/s", "agree %", "median error, m", "voxels: median", "90th percentile", "median of the signed"};
    table.align.assign(table.heading.size(), TableAlign::right);
    table.align.front() = TableAlign::left;
    for (const FirstHitRow& row : bench.rows)
        table.rows.push_back({row.key, fixed_text(1e-6 * static_cast<double>(row.rays) / row.seconds, 1),
                              fixed_text(row.agree_percent, 2), fixed_text(row.median_m, 3),
                              fixed_text(row.median_voxels, 2), fixed_text(row.ninetieth_voxels, 2),
                              fixed_text(row.bias_voxels, 2)});
    return table;
}

}  // namespace sightlines
