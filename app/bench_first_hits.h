// Where rays first hit, by voxel rows and by Embree: how often both agree that something is hit, and how far apart.
#pragma once

#include <string>
#include <vector>

#include "app/results.h"
#include "app/table.h"

namespace sightlines {

/// One kind of rays, one ray for each pixel that shows a surface.
struct FirstHitRow {
    std::string key;  ///< "mirror": the reflected camera rays; "hemisphere": about the normal, by the cosine
    std::uint64_t rays = 0;
    double agree_percent = 0.0;  ///< both hit something, or both nothing
    double median_voxels = 0.0,
           ninetieth_voxels = 0.0;  ///< |ours - Embree's| where both hit, in voxels of the longest side
    double bias_voxels = 0.0;       ///< median of ours less Embree's
    double median_m = 0.0;
    double seconds = 0.0;  ///< that ours took
};

struct FirstHitBench {
    Session session;
    double voxel_m = 0.0;
    std::vector<FirstHitRow> rows;
};

/// The session's technique must be voxel_rows. On the CPU.
FirstHitBench bench_first_hits(const Session& session, Results& results, Progress& progress);

Json json_from_bench(const FirstHitBench& bench);
std::string heading_from_bench(const FirstHitBench& bench);
TextTable table_from_bench(const FirstHitBench& bench);

}  // namespace sightlines
