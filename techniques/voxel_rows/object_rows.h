// Objects that move rigidly (Wang 2017, Algorithm 5): an array of voxelizations for each type of object, asked in the
// frame of each of its instances, beside the array of what stands still. Time moves frames, and no voxel.
#pragma once

#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "shaders/voxel_row_objects_data.h"
#include "techniques/scene/moving_parts.h"
#include "techniques/voxel_rows/row_array.h"

namespace sightlines::voxel_rows {

struct VulkanRows;
struct VulkanObjects;

/// What all moments of a scene share whose parts move rigidly. On the device once a moment was asked there.
struct RigidRows {
    RowArray fixed;               ///< what stands still; its grid spans the whole scene at all times
    std::vector<RowArray> types;  ///< in the order of rigid_objects(), in the object's own frame
    bool complete = true;         ///< false where a type had no extent at this moment: its array has no words
    std::mutex device_mutex;
    std::shared_ptr<const VulkanRows> fixed_on_device;
    std::shared_ptr<const VulkanObjects> types_on_device;
};

/// An instance: which of the arrays it is of, and where it is.
struct PlacedObject {
    std::uint32_t type = 0;
    mat4 world_from_object{1.0f};
};

/// What a ray is asked of besides the array. The spans must outlive it.
struct Objects {
    std::span<const RowArray> types;
    std::span<const PlacedObject> placed;

    bool empty() const { return placed.empty(); }
};

/// Whether all that moves moves rigidly (and anything does).
bool moves_rigidly(const Scene& scene);

/// Whether asking each object beats splatting what moves anew: all moves rigidly, and there are few enough of them.
/// The cost of a ray grows with their number.
bool worth_asking_objects(const Scene& scene);

/// The array of one type, in its own frame; its bounds are half a voxel wider than the object. Without words where none
/// of its instances has an extent now.
RowArray build_object(const Scene& scene, const RigidObject& object, const BuildOptions& options, bool directly,
                      Progress& progress);

/// Where the instances are at the scene's moment. Those without an extent (a scale of zero) are left out.
std::vector<PlacedObject> placed_objects(const Scene& scene);

/// The objects as kernels ask them, with the offsets of the parameters in voxels of each; at the addresses of the
/// arrays' own memory.
std::vector<ObjectInstance> object_instances(const Objects& objects, const ParameterValues& parameters);

/// The instance's bounds in the world.
Box3 world_bounds(const RowArray& type, const mat4& world_from_object);

/// Bytes of all their rows.
std::uint64_t bytes_of(std::span<const RowArray> types);

}  // namespace sightlines::voxel_rows
