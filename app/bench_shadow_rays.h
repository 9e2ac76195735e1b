// How many shadow rays a second: voxel rows on both backends, and Embree in every way that we know to use it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/results.h"
#include "app/table.h"

namespace sightlines {

/// One contestant's measurements.
struct BenchRow {
    std::string key;  ///< "voxel_rows_cpu", as in the JSON
    std::string title;
    std::uint64_t rays = 0, blocked = 0;
    std::vector<double> seconds;  ///< of each repetition; empty: it could not run here
};

struct ShadowRayBench {
    Session session;
    std::size_t triangles = 0, lights = 0;
    double build_seconds = 0.0, embree_build_seconds = 0.0;
    std::uint64_t structure_bytes = 0, peak_bytes = 0;
    std::vector<BenchRow> rows;  ///< both backends, compressed and uncompressed, then Embree's variants
    std::vector<std::string> notes;
};

/// Every contestant asks the same rays once in each repetition, in turn, so that what else the machine does meets all
/// alike; one further round before that is not counted. Of a compressed array, the uncompressed one takes part as well.
/// Without a Vulkan device that row is empty, and a note says why.
ShadowRayBench bench_shadow_rays(const Session& session, int repetitions, Results& results, Progress& progress);

/// Median over the repetitions, in rays a second; nothing where the row could not run.
std::optional<double> median_rays_per_second(const BenchRow& row);

Json json_from_bench(const ShadowRayBench& bench);
std::string heading_from_bench(const ShadowRayBench& bench);
TextTable table_from_bench(const ShadowRayBench& bench);

}  // namespace sightlines
