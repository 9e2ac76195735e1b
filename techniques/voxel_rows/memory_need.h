// What an array of voxelizations takes, told before anything is allocated.
#pragma once

#include <cstdint>

namespace sightlines::voxel_rows {

/// Bytes of the uncompressed array.
std::uint64_t array_bytes(int resolution, double angle_step_deg);

/// EnvironmentError where the array takes more than `available_bytes`: says what it would take, and which coarser step
/// and which lower resolution would fit.
void require_memory(int resolution, double angle_step_deg, std::uint64_t available_bytes);

}  // namespace sightlines::voxel_rows
