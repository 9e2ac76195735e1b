// What an array of voxelizations takes, told before anything is allocated.
#pragma once

#include <cstdint>

namespace sightlines::voxel_rows {

/// Bytes of the uncompressed array.
std::uint64_t array_bytes(int resolution, double angle_step_deg);

/// Bytes of the array and of what compressing it takes besides, where no more than a third of its rows are distinct (of
/// our scenes Sponza has most, 28 %).
std::uint64_t compression_bytes(int resolution, double angle_step_deg);

/// What is to be made.
enum class ArrayKind { plain, compressed };

/// EnvironmentError where that takes more than `available_bytes`: says what it would take, and which coarser step and
/// which lower resolution would fit.
void require_memory(int resolution, double angle_step_deg, std::uint64_t available_bytes,
                    ArrayKind kind = ArrayKind::plain);

}  // namespace sightlines::voxel_rows
