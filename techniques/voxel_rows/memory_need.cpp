#include "techniques/voxel_rows/memory_need.h"

#include <array>
#include <sstream>
#include <string>

#include "techniques/base/error.h"
#include "techniques/compute/device.h"
#include "techniques/voxel_rows/row_array.h"
#include "techniques/voxel_rows/row_histogram.h"

namespace sightlines::voxel_rows {
namespace {

std::string array_text(int resolution, double angle_step_deg) {
    std::ostringstream text;
    text << resolution << " voxels at " << angle_step_deg << " deg";
    return text.str();
}

std::uint64_t needed_bytes(int resolution, double angle_step_deg, ArrayKind kind) {
    return kind == ArrayKind::plain ? array_bytes(resolution, angle_step_deg)
                                    : compression_bytes(resolution, angle_step_deg);
}

/// "256 voxels at 3 deg (7.64 GB)"
std::string sized_text(int resolution, double angle_step_deg, ArrayKind kind) {
    return array_text(resolution, angle_step_deg) + " (" +
           compute::bytes_text(needed_bytes(resolution, angle_step_deg, kind)) + ")";
}

/// The nearest choices that fit, one of a coarser step and one of a lower resolution; empty where nothing does.
std::string what_fits(int resolution, double angle_step_deg, std::uint64_t available_bytes, ArrayKind kind) {
    std::string fits;
    for (const double step_deg : {1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0}) {
        if (step_deg <= angle_step_deg || needed_bytes(resolution, step_deg, kind) > available_bytes) continue;
        fits = sized_text(resolution, step_deg, kind);
        break;
    }
    for (const int side : {192, 128, 96, 64, 48, 32}) {
        if (side >= resolution || needed_bytes(side, angle_step_deg, kind) > available_bytes) continue;
        fits += (fits.empty() ? "" : " or ") + sized_text(side, angle_step_deg, kind);
        break;
    }
    return fits;
}

}  // namespace

std::uint64_t array_bytes(int resolution, double angle_step_deg) {
    const RowGrid grid = make_grid(Box3{vec3(0.0f), vec3(1.0f)}, resolution, angle_step_deg);
    return grid.rows() * static_cast<std::uint64_t>(grid.words_per_row) * sizeof(std::uint32_t);
}

std::uint64_t compression_bytes(int resolution, double angle_step_deg) {
    const RowGrid grid = make_grid(Box3{vec3(0.0f), vec3(1.0f)}, resolution, angle_step_deg);
    return array_bytes(resolution, angle_step_deg) + counting_bytes(grid.rows(), grid.words_per_row, grid.rows() / 3);
}

void require_memory(int resolution, double angle_step_deg, std::uint64_t available_bytes, ArrayKind kind) {
    const std::uint64_t needed = needed_bytes(resolution, angle_step_deg, kind);
    if (needed <= available_bytes) return;
    const std::string fits = what_fits(resolution, angle_step_deg, available_bytes, kind);
    throw EnvironmentError("memory",
                           "an array of " + array_text(resolution, angle_step_deg) +
                               (kind == ArrayKind::plain ? "" : ", to be compressed,") + " takes " +
                               compute::bytes_text(needed) + ", and " + compute::bytes_text(available_bytes) +
                               " are free",
                           fits.empty() ? "close other programs" : "what would fit: " + fits);
}

}  // namespace sightlines::voxel_rows
