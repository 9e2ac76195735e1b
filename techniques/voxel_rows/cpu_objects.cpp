#include <algorithm>
#include <array>
#include <bit>

#include "shaders/wide.h"  // first: makes the kernels below wide

#include "shaders/voxel_row_objects.h"
#include "techniques/voxel_rows/cpu_objects.h"
#include "techniques/packed_bits.h"

namespace sightlines::voxel_rows {
namespace {

namespace wide = wide_kernel;
using wide::Int;
using wide::lanes;
using wide::Mask;
using wide::Real;
using wide::UInt;
using wide::Vec3;

constexpr std::size_t most_vectors = 64;

/// One vector of rays on its way through the steps.
struct PendingRays {
    wide::Direction direction;
    Int frame;
    Mask left;
    wide::RowSpan spans[2];  ///< [subrays]
};

/// The rays that meet an object's bounds, in its own frame.
struct MeetingRays {
    std::size_t count = 0;
    std::array<std::array<float, (most_vectors + 1) * lanes>, 6> ends;  ///< x, y, z of one, then of the other; packed
    std::array<std::uint16_t, most_vectors * lanes> pixel;              ///< which of the batch
    std::array<PendingRays, most_vectors> pending;

    std::size_t vectors() const { return (count + lanes - 1) / lanes; }
};

using SixColumns = std::span<const std::vector<float>, 6>;

HWY_INLINE Vec3 load_three(SixColumns columns, std::size_t first, std::size_t start) {
    return {wide::load(&columns[first][start]), wide::load(&columns[first + 1][start]),
            wide::load(&columns[first + 2][start])};
}
HWY_INLINE Vec3 load_end(const MeetingRays& meeting, std::size_t end, std::size_t start) {
    return {wide::load(&meeting.ends[3 * end][start]), wide::load(&meeting.ends[3 * end + 1][start]),
            wide::load(&meeting.ends[3 * end + 2][start])};
}
HWY_INLINE Vec3 load_axes(const std::vector<float> (&axes)[3], std::size_t start) {
    return {wide::load(&axes[0][start]), wide::load(&axes[1][start]), wide::load(&axes[2][start])};
}

/// Which rays of a batch no object has blocked so far.
struct OpenRays {
    std::array<std::uint32_t, most_vectors> open;           ///< of each vector of pixels, bit by lane
    std::array<std::uint16_t, most_vectors + 1> first_ray;  ///< the number of each vector's first ray
};

OpenRays open_rays(const BatchOfRays& batch, std::span<const std::uint32_t> blocked) {
    OpenRays rays;
    std::size_t ray = 0;
    for (std::size_t k = 0; k < batch.asked.size(); ++k) {
        const std::uint32_t asked = batch.asked[k];
        rays.first_ray[k] = static_cast<std::uint16_t>(ray);
        const std::uint64_t two = blocked[ray / lanes] | static_cast<std::uint64_t>(blocked[ray / lanes + 1]) << lanes;
        rays.open[k] = asked & ~deposit_bits(static_cast<std::uint32_t>(two >> (ray % lanes)), asked);
        ray += static_cast<std::size_t>(std::popcount(asked));
    }
    return rays;
}

/// Blocks the ray of a pixel of the batch.
HWY_INLINE void block(std::size_t pixel, const BatchOfRays& batch, OpenRays& rays, std::span<std::uint32_t> blocked) {
    const std::size_t k = pixel / lanes;
    const std::uint32_t lane = 1u << (pixel % lanes);
    rays.open[k] &= ~lane;
    const std::size_t ray = rays.first_ray[k] + static_cast<std::size_t>(std::popcount(batch.asked[k] & (lane - 1u)));
    blocked[ray / lanes] |= 1u << (ray % lanes);
}

/// Algorithm 5, line 5, for the open rays of one vector of pixels that meet the object's bounds.
HWY_INLINE void gather_meeting(const ObjectInstance& object, const BatchOfRays& batch, std::size_t k,
                               std::uint32_t open, const LightRecord& light, float reach_m, MeetingRays& meeting) {
    const std::size_t start = (batch.first + k) * lanes;
    const Vec3 position = load_axes(batch.pixels.position, start);
    const Vec3 origin = wide::ray_origin(object.query, position, load_axes(batch.pixels.normal, start));
    const Vec3 a = wide::to_object(object, origin);
    const Vec3 b = wide::to_object(object, wide::light_end(light, position, reach_m));
    const Mask met = wide::meets_bounds(object.query, a, b) && wide::mask_of(open);
    std::uint32_t bits = wide::bits_of(met);
    if (bits == 0) return;
    const std::array<Real, 6> numbers{a.x, a.y, a.z, b.x, b.y, b.z};
    for (std::size_t n = 0; n < 6; ++n) wide::store_compressed(numbers[n], met, &meeting.ends[n][meeting.count]);
    for (; bits != 0; bits &= bits - 1)
        meeting.pixel[meeting.count++] =
            static_cast<std::uint16_t>(k * lanes + static_cast<std::size_t>(std::countr_zero(bits)));
}

HWY_INLINE void prefetch_rows(const wide::Rows& rows, const UInt& row, int words_per_row) {
    const auto* index = reinterpret_cast<const uint*>(&row);
    for (std::size_t lane = 0; lane < lanes; ++lane)
        __builtin_prefetch(rows.v + static_cast<std::size_t>(index[lane]) * static_cast<std::size_t>(words_per_row));
}

/// Algorithm 3 in the object's frame, each step over all vectors before the next. Leaves the answers in `in_the_way`,
/// bit i % lanes of word i / lanes for ray i.
void ask_array(const ObjectInstance& object, MeetingRays& meeting,
               std::array<std::uint32_t, most_vectors>& in_the_way) {
    const RowShape cut = wide::shape_of_cut(object.query);
    const wide::Rows rows = wide::rows_of(object);
    // The last vector's idle lanes repeat its last ray.
    for (auto& numbers : meeting.ends) wide::store(wide::splat(numbers[meeting.count - 1]), &numbers[meeting.count]);
    for (std::size_t v = 0; v < meeting.vectors(); ++v) {
        PendingRays& rays = meeting.pending[v];
        const Vec3 along_ray = load_end(meeting, 1, v * lanes) - load_end(meeting, 0, v * lanes);
        rays.direction = wide::discretize_direction(cut, along_ray);
        rays.frame = wide::frame_index(cut, rays.direction);
    }
    for (std::size_t v = 0; v < meeting.vectors(); ++v) {
        PendingRays& rays = meeting.pending[v];
        Vec3 a = load_end(meeting, 0, v * lanes), b = load_end(meeting, 1, v * lanes);
        const wide::Frame frame = wide::load_frame(wide::frames_of(object), rays.frame);
        rays.left = wide::clip_to_object(object.query, frame, a, b);
        for (int part = 0; part < cut.subrays; ++part) {
            rays.spans[part] = wide::locate_part(cut, frame, rays.direction, a, b, part);
            prefetch_rows(rows, rays.spans[part].row, cut.words_per_row);
        }
    }
    for (std::size_t v = 0; v < meeting.vectors(); ++v) {
        const PendingRays& rays = meeting.pending[v];
        Mask is_blocked = wide::span_is_blocked(cut, rows, rays.spans[0]);
        if (cut.subrays == 2) is_blocked = is_blocked || wide::span_is_blocked(cut, rows, rays.spans[1]);
        in_the_way[v] = wide::bits_of(is_blocked && rays.left);
    }
}

/// Which of the objects from `first` on (a vector of them) any ray of the batch may meet, by their bounds in the world.
std::uint32_t objects_to_ask(const ObjectQuery& query, const BatchOfRays& batch, const LightRecord& light,
                             std::size_t first) {
    const Box3& pixels = batch.bounds.of_batches[batch.batch];
    const Vec3 from = wide::splat(pixels.centre()), object = load_three(query.bounds, 0, first);
    const Vec3 half_size = load_three(query.bounds, 3, first) + wide::splat(0.5f * pixels.size());
    return wide::bits_of(
        wide::meets_box(half_size, from - object, wide::light_end(light, from, query.reach_m) - object));
}

/// Which vectors of the batch's pixels may meet the object, bit by vector.
std::uint64_t vectors_to_ask(const ObjectQuery& query, const BatchOfRays& batch, const LightRecord& light,
                             const ObjectInstance& object) {
    std::uint64_t vectors = 0;
    for (std::size_t k = 0; k < batch.asked.size(); k += lanes) {
        const Vec3 centre = load_three(batch.bounds.of_vectors, 0, batch.first + k);
        const Vec3 half_size = load_three(batch.bounds.of_vectors, 3, batch.first + k);
        const Vec3 end = wide::light_end(light, centre, query.reach_m);
        vectors |= std::uint64_t{wide::bits_of(wide::may_meet(object, centre, half_size, end))} << k;
    }
    return vectors;
}

/// Centre and half size of the box as number k of the columns.
void put_box(const Box3& box, float wider_m, std::size_t k, std::span<std::vector<float>, 6> columns) {
    for (int axis = 0; axis < 3; ++axis) {
        columns[static_cast<std::size_t>(axis)][k] = box.centre()[axis];
        columns[static_cast<std::size_t>(axis) + 3][k] = 0.5f * box.size()[axis] + wider_m;
    }
}

}  // namespace

ObjectQuery make_object_query(const Objects& objects, const ParameterValues& parameters, float reach_m) {
    ObjectQuery query;
    query.instances = object_instances(objects, parameters);
    query.reach_m = reach_m;
    const std::size_t padded = (query.instances.size() + lanes - 1) / lanes * lanes;
    for (auto& column : query.bounds) column.resize(padded);
    for (std::size_t k = 0; k < query.instances.size(); ++k) {
        const PlacedObject& placed = objects.placed[k];
        // Rays start a little off their pixels.
        put_box(world_bounds(objects.types[placed.type], placed.world_from_object),
                query.instances[k].query.normal_offset_m, k, query.bounds);
    }
    return query;
}

PixelBounds bounds_of_pixels(const PixelGroups& pixels, std::size_t vectors_per_batch) {
    const std::size_t vectors = pixels.pixel.size() / lanes;
    PixelBounds bounds;
    bounds.of_batches.resize((vectors + vectors_per_batch - 1) / vectors_per_batch);
    // A batch's last vector of boxes may reach past those that there are.
    for (auto& column : bounds.of_vectors) column.resize(vectors + lanes);
    for (std::size_t vector = 0; vector < vectors; ++vector) {
        Box3 box;
        for (std::size_t k = vector * lanes; k < (vector + 1) * lanes; ++k)
            box.add({pixels.position[0][k], pixels.position[1][k], pixels.position[2][k]});
        put_box(box, 0.0f, vector, bounds.of_vectors);
        Box3& whole = bounds.of_batches[vector / vectors_per_batch];
        whole.add(box.lowest);
        whole.add(box.highest);
    }
    return bounds;
}

namespace {

/// Asks one object for the open rays of the batch.
void ask_object(const ObjectQuery& query, const BatchOfRays& batch, const LightRecord& light, std::size_t number,
                OpenRays& rays, std::span<std::uint32_t> blocked) {
    MeetingRays meeting;
    const ObjectInstance& object = query.instances[number];
    for (std::uint64_t vectors = vectors_to_ask(query, batch, light, object); vectors != 0; vectors &= vectors - 1) {
        const auto k = static_cast<std::size_t>(std::countr_zero(vectors));
        if (k >= batch.asked.size()) break;
        if (rays.open[k] != 0) gather_meeting(object, batch, k, rays.open[k], light, query.reach_m, meeting);
    }
    if (meeting.count == 0) return;
    std::array<std::uint32_t, most_vectors> in_the_way;
    ask_array(object, meeting, in_the_way);
    for (std::size_t i = 0; i < meeting.count; ++i)
        if (in_the_way[i / lanes] >> (i % lanes) & 1u) block(meeting.pixel[i], batch, rays, blocked);
}

}  // namespace

void ask_objects(const ObjectQuery& query, const BatchOfRays& batch, const LightRecord& light,
                 std::span<std::uint32_t> blocked) {
    OpenRays rays;
    bool are_known = false;
    for (std::size_t first = 0; first < query.instances.size(); first += lanes) {
        for (std::uint32_t bits = objects_to_ask(query, batch, light, first); bits != 0; bits &= bits - 1) {
            const std::size_t number = first + static_cast<std::size_t>(std::countr_zero(bits));
            if (number >= query.instances.size()) break;
            if (!are_known) rays = open_rays(batch, blocked);
            are_known = true;
            ask_object(query, batch, light, number, rays, blocked);
        }
    }
}

}  // namespace sightlines::voxel_rows
