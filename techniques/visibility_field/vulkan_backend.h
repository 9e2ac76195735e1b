// Algorithm 2 on a Vulkan device, by the GLSL compilation of the kernels.
#pragma once

#include <memory>
#include <optional>

#include "techniques/compute/device.h"
#include "techniques/rays/ray_tree.h"
#include "techniques/visibility_field/render.h"

namespace sightlines::visibility_field {

struct FieldOnDevice;  // hides Vulkan's handles; shared between threads

/// What answers rays on a device. `queries`: its own ray queries, where it has them for so many triangles; the tree
/// else.
enum class DeviceRays { queries, tree };

/// By the environment variable SIGHTLINES_RAY_QUERIES: `queries` where it is 1, `tree` where it is 0. Unless it says,
/// `queries`, but `tree` on a software device, whose queries are the slower code of the two.
DeviceRays device_rays_wanted(compute::DeviceKind kind);

/// Copies the field (null: none, every sample is traced) and what answers rays to the preferred device. `wanted`:
/// nothing as device_rays_wanted says. EnvironmentError: no device, or out of memory.
std::shared_ptr<const FieldOnDevice> give_to_vulkan(const VisibilityField* field, const EmbreeScene& embree,
                                                    int threads, Progress& progress,
                                                    std::optional<DeviceRays> wanted = {});

/// What answers the field's rays, and the bytes it takes on the device.
struct DeviceRaysUsed {
    DeviceRays rays = DeviceRays::tree;
    std::uint64_t bytes = 0;
};
DeviceRaysUsed rays_used(const FieldOnDevice& field);

/// The picture of render_environment, by the same samples and masks. Answers differ where rays graze triangles, and
/// sums by rounding. request.dense and request.order are not looked at: the answers are the same in any layout.
EnvironmentResult render_on_vulkan(const FieldOnDevice& field, const EnvironmentRequest& request, Progress& progress);

}  // namespace sightlines::visibility_field
