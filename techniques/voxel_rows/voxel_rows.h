// Voxel rows: Wang et al. 2017, "Fast Ray-Scene Intersection for Interactive Shadow Rendering with Thousands of Dynamic
// Lights". The technique's row in the catalog, and what its own view and benchmark ask beyond that.
#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include "techniques/rays/reference.h"
#include "techniques/technique.h"
#include "techniques/voxel_rows/object_rows.h"
#include "techniques/voxel_rows/row_array.h"

namespace sightlines::voxel_rows {

const Technique& technique();

/// The array inside a structure that `technique().build` made.
const RowArray& row_array(const Structure& structure);

/// Whether structures of these parameters are compressed.
bool is_compressed(const ParameterValues& parameters);

/// What the array of these parameters held in one direction before it was compressed, unpacked as by
/// unpack_voxelization: the compressed one cannot tell.
std::vector<std::uint8_t> uncompressed_voxelization(const Scene& scene, const ParameterValues& parameters,
                                                    int direction, int threads, Progress& progress);

/// The objects that are asked beside the array (Algorithm 5); none where the array holds the whole scene.
Objects objects(const Structure& structure);

/// Asks all rays of the request by its backend and counts them; no shading.
QueryCount count_blocked(const Structure& structure, const RenderRequest& request);

/// What serves one ray: everything that the view shows of it.
struct ServedRay {
    Segment ray;  ///< as looked up: off the surface, clipped to the bounds
    int direction = 0, theta = 0, phi = 0;
    int v = 0, w = 0;          ///< of the row that holds the midpoint
    int first = 0, last = -1;  ///< voxels kept, inclusive; first > last: nothing to look at
    bool blocked = false;
    vec3 row_direction{0.0f};  ///< unit, world, the way the ray goes
    float angular_error_deg = 0.0f;
    std::vector<bool> bits;  ///< [N] of the row
};

/// A row that a ray was asked of: voxels first .. last of row (v, w); first > last: nothing to look at.
struct AskedRow {
    int v = 0, w = 0;
    int first = 0, last = -1;
    bool blocked = false;
};

/// An object that a ray was asked of (Algorithm 5, lines 4 to 10).
struct AskedObject {
    std::uint32_t instance = 0;    ///< of Objects::placed
    bool met = false;              ///< the ray meets its bounds
    int direction = 0;             ///< of its type's array, in its own frame
    std::vector<AskedRow> rows{};  ///< none where the ray passes it by, one, or one for each half of the ray

    bool blocked() const { return std::ranges::any_of(rows, &AskedRow::blocked); }
};

/// The objects that a recorded ray was asked of, in order: read out of its steps.
std::vector<AskedObject> asked_objects(const Objects& objects, const Trace& trace);

/// The ray of the request as the kernel serves it, recorded step by step: by the array, then by the objects until one
/// is in the way.
Trace trace(const RowArray& array, const TraceRequest& request, const Objects& objects = {});

ServedRay serve(const RowArray& array, const TraceRequest& request);

}  // namespace sightlines::voxel_rows
