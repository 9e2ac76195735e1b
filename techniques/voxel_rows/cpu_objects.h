// Algorithm 5 on the CPU: the rays that pass what stands still are asked of the objects, by the wide compilation of the
// kernel.
#pragma once

#include <span>
#include <vector>

#include "shaders/lighting_data.h"
#include "techniques/pixel_groups.h"
#include "techniques/voxel_rows/object_rows.h"

namespace sightlines::voxel_rows {

/// The objects of one picture.
struct ObjectQuery {
    std::vector<ObjectInstance> instances;
    std::vector<float> bounds[6];  ///< of each in the world: centre, then half size; whole vectors
    float reach_m = 0.0f;          ///< how far directional lights are put away
};
ObjectQuery make_object_query(const Objects& objects, const ParameterValues& parameters, float reach_m);

/// Where the positions of a tile's pixels lie: most of them ask no object, and are passed over together.
struct PixelBounds {
    std::vector<Box3> of_batches;
    std::vector<float> of_vectors[6];  ///< centre, then half size; whole vectors of them
};
PixelBounds bounds_of_pixels(const PixelGroups& pixels, std::size_t vectors_per_batch);

/// The rays that some vectors of pixels ask of a light, counted pixel after pixel: ray i is that of the i-th bit of
/// `asked` that is set.
struct BatchOfRays {
    const PixelGroups& pixels;
    const PixelBounds& bounds;
    std::size_t batch = 0, first = 0;      ///< which batch, and its first vector of pixels
    std::span<const std::uint32_t> asked;  ///< which pixels of each vector ask, bit by lane; at most 64 vectors
};

/// Sets the bits of `blocked` (ray i: bit i % lanes of word i / lanes; one word more than the rays take) where an
/// object is in the way; asks no ray whose bit is set already.
void ask_objects(const ObjectQuery& query, const BatchOfRays& batch, const LightRecord& light,
                 std::span<std::uint32_t> blocked);

}  // namespace sightlines::voxel_rows
