// Homogeneous rasterisation (Olano and Greer 1997): a texel's ray from the light passes a triangle where it lies on the
// same side of the three planes through the light and an edge. So nothing is clipped, whatever lies behind the light.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

#include "shaders/wide.h"  // first: the vectors

#include "techniques/baselines/shadow_maps/rasterizer.h"

namespace sightlines::baselines {
namespace {

namespace wide = wide_kernel;
namespace hn = wide::hn;
using wide::Mask;
using wide::Real;
using wide::splat;
using wide::Vec3;

/// Bits of 10 of a number, two apart.
std::uint32_t spread_bits(std::uint32_t x) {
    x = (x | (x << 16u)) & 0x030000ffu;
    x = (x | (x << 8u)) & 0x0300f00fu;
    x = (x | (x << 4u)) & 0x030c30c3u;
    return (x | (x << 2u)) & 0x09249249u;
}

/// One map as a camera at the light: x and y across it, in [-1, 1] over the map for w = 1.
struct MapView {
    vec3 origin;
    vec3 x, y, w;  ///< perspective: axes; directional: x and y scaled, w the depth's direction
    bool directional;
    float reach_m;
    float left, right, top, bottom;  ///< of the rect, in [-1, 1]
};

MapView map_view(const ShadowMapShape& shape, int map, const MapRect& rect) {
    MapView view{};
    view.origin = shape.light;
    view.directional = shape.directional != 0;
    view.reach_m = shape.reach_m;
    const float scale = 2.0f / static_cast<float>(shape.resolution);
    if (view.directional) {
        view.x = shape.axis_u * scale;
        view.y = shape.axis_v * scale;
        view.w = shape.axis_depth;
    } else {
        const int axis = map / 2;
        view.w[axis] = map % 2 == 0 ? 1.0f : -1.0f;
        view.x[(axis + 1) % 3] = 1.0f;
        view.y[(axis + 2) % 3] = 1.0f;
    }
    view.left = static_cast<float>(rect.first_x) * scale - 1.0f;
    view.right = static_cast<float>(rect.last_x + 1) * scale - 1.0f;
    view.top = static_cast<float>(rect.first_y) * scale - 1.0f;
    view.bottom = static_cast<float>(rect.last_y + 1) * scale - 1.0f;
    return view;
}

/// Whether the box lies wholly outside one of the planes that bound the rect's view.
bool is_outside(const MapView& view, const Box3& box) {
    const vec3 centre = box.centre() - view.origin, half = 0.5f * box.size();
    const vec3 w = view.directional ? vec3(0.0f) : view.w;
    const float constant = view.directional ? 1.0f : 0.0f;
    const auto all_above_zero = [&](vec3 normal, float offset) {
        return glm::dot(normal, centre) + offset - glm::dot(glm::abs(normal), half) > 0.0f;
    };
    return all_above_zero(view.x - view.right * w, -view.right * constant) ||
           all_above_zero(view.left * w - view.x, view.left * constant) ||
           all_above_zero(view.y - view.bottom * w, -view.bottom * constant) ||
           all_above_zero(view.top * w - view.y, view.top * constant) ||
           (!view.directional && all_above_zero(-view.w, 0.0f));
}

/// a x + b y + c over the texels' numbers.
struct Plane {
    Real a, b, c;
};

/// One vector of triangles, set up; kept as numbers, so that each may be drawn by itself.
struct SetUp {
    alignas(64) float planes[4][3][wide::lanes];  ///< three edges, then the nearness
    alignas(64) float least[wide::lanes], most[wide::lanes];
    alignas(64) int first_x[wide::lanes], last_x[wide::lanes], first_y[wide::lanes], last_y[wide::lanes];
    std::uint32_t visible = 0;
};

HWY_INLINE Real min3(Real a, Real b, Real c) { return wide::min(a, wide::min(b, c)); }
HWY_INLINE Real max3(Real a, Real b, Real c) { return wide::max(a, wide::max(b, c)); }

HWY_INLINE Real dot_uniform(vec3 axis, Vec3 v) {
    return wide::fused(splat(axis.z), v.z, wide::fused(splat(axis.y), v.y, splat(axis.x) * v.x));
}

/// Exactly the negative of cross(b, a), so that neighbours agree on their common edge.
HWY_INLINE Vec3 cross(Vec3 a, Vec3 b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }

HWY_INLINE Real dot(Vec3 a, Vec3 b) { return wide::fused(a.z, b.z, wide::fused(a.y, b.y, a.x * b.x)); }

/// The function dot(normal, (x, y, 1)) of map coordinates, over texels' middles.
HWY_INLINE Plane over_texels(Vec3 normal, float scale) {
    const Real to_middle = splat(0.5f * scale - 1.0f);
    return {normal.x * splat(scale), normal.y * splat(scale), wide::fused(normal.x + normal.y, to_middle, normal.z)};
}

HWY_INLINE void keep(const Plane& plane, float (&numbers)[3][wide::lanes]) {
    wide::store(plane.a, numbers[0]);
    wide::store(plane.b, numbers[1]);
    wide::store(plane.c, numbers[2]);
}

/// The corners as the map sees them: x, y, w; and, for a directional light, their nearness.
struct Seen {
    Vec3 corner[3];
    Real nearness[3];
};

HWY_INLINE Seen see(const TriangleClusters& clusters, const MapView& view, std::size_t first) {
    Seen seen;
    for (int k = 0; k < 3; ++k) {
        const auto& corner = clusters.corners[k];
        const Vec3 from_light{wide::load(&corner[0][first]) - splat(view.origin.x),
                              wide::load(&corner[1][first]) - splat(view.origin.y),
                              wide::load(&corner[2][first]) - splat(view.origin.z)};
        const Real w = dot_uniform(view.w, from_light);
        seen.corner[k] = {dot_uniform(view.x, from_light), dot_uniform(view.y, from_light),
                          view.directional ? splat(1.0f) : w};
        seen.nearness[k] = splat(view.reach_m) - w;
    }
    return seen;
}

/// The triangles that are not wholly outside the rect's view.
HWY_INLINE Mask may_be_visible(const MapView& view, const Seen& seen) {
    const auto& [a, b, c] = seen.corner;
    const Real zero = splat(0.0f);
    const auto beyond = [&](auto distance) { return min3(distance(a), distance(b), distance(c)) > zero; };
    const Mask outside = beyond([&](const Vec3& v) { return v.x - splat(view.right) * v.z; }) ||
                         beyond([&](const Vec3& v) { return splat(view.left) * v.z - v.x; }) ||
                         beyond([&](const Vec3& v) { return v.y - splat(view.bottom) * v.z; }) ||
                         beyond([&](const Vec3& v) { return splat(view.top) * v.z - v.y; });
    return max3(a.z, b.z, c.z) > zero && !outside;
}

/// The texels that the triangles may cover; those that cross the light's plane may cover all of the rect.
HWY_INLINE Mask find_texels(const Seen& seen, const MapRect& rect, float resolution, Mask in_front, SetUp& set_up) {
    const auto& [a, b, c] = seen.corner;
    const Real half = splat(0.5f * resolution);
    Real low[2], high[2];
    const Real per_a = half / a.z, per_b = half / b.z, per_c = half / c.z;
    low[0] = min3(a.x * per_a, b.x * per_b, c.x * per_c);
    high[0] = max3(a.x * per_a, b.x * per_b, c.x * per_c);
    low[1] = min3(a.y * per_a, b.y * per_b, c.y * per_c);
    high[1] = max3(a.y * per_a, b.y * per_b, c.y * per_c);
    const int firsts[2] = {rect.first_x, rect.first_y}, lasts[2] = {rect.last_x, rect.last_y};
    int* const first_to[2] = {set_up.first_x, set_up.first_y};
    int* const last_to[2] = {set_up.last_x, set_up.last_y};
    Mask any = wide::mask_of(0xffffu);
    for (int axis = 0; axis < 2; ++axis) {
        const Real least = splat(static_cast<float>(firsts[axis])), most = splat(static_cast<float>(lasts[axis]));
        // A texel's middle is half a texel from its number; the hundredth is for rounding, the edges decide.
        const Real from = Real{hn::Ceil((low[axis] + half - splat(0.51f)).v)};
        const Real to = Real{hn::Floor((high[axis] + half - splat(0.49f)).v)};
        const Real first = wide::select(in_front, wide::max(from, least), least);
        const Real last = wide::select(in_front, wide::min(to, most), most);
        any = any && !(first > last);
        wide::store(wide::to_int(wide::min(first, most)), first_to[axis]);
        wide::store(wide::to_int(wide::max(last, least)), last_to[axis]);
    }
    return any;
}

HWY_INLINE Plane nearness_plane(const MapView& view, const Seen& seen, float scale) {
    const auto& [a, b, c] = seen.corner;
    const Vec3 normal = cross(b - a, c - a);
    if (!view.directional) {
        // On the triangle's plane dot(normal, w (x, y, 1)) = dot(normal, a): 1 / w is linear in x and y.
        const Real reciprocal = splat(1.0f) / dot(normal, a);
        return over_texels({normal.x * reciprocal, normal.y * reciprocal, normal.z * reciprocal}, scale);
    }
    const Real reciprocal = splat(1.0f) / normal.z;
    const Real to_b = seen.nearness[1] - seen.nearness[0], to_c = seen.nearness[2] - seen.nearness[0];
    const Real slope_x = (to_b * (c.y - a.y) - to_c * (b.y - a.y)) * reciprocal;
    const Real slope_y = (to_c * (b.x - a.x) - to_b * (c.x - a.x)) * reciprocal;
    return over_texels({slope_x, slope_y, seen.nearness[0] - slope_x * a.x - slope_y * a.y}, scale);
}

HWY_INLINE void set_up_triangles(const MapView& view, const Seen& seen, const MapRect& rect, float resolution,
                                 SetUp& set_up) {
    const auto& [a, b, c] = seen.corner;
    Mask visible = may_be_visible(view, seen);
    set_up.visible = 0;
    if (!wide::any_lane(visible)) return;
    const Mask in_front = min3(a.z, b.z, c.z) > splat(1.0e-9f);
    visible = visible && find_texels(seen, rect, resolution, in_front, set_up);
    const Vec3 edges[3] = {cross(b, c), cross(c, a), cross(a, b)};
    const Real turn = dot(a, edges[0]);
    visible = visible && wide::abs(turn) > splat(0.0f);
    set_up.visible = wide::bits_of(visible);
    if (set_up.visible == 0) return;
    const float scale = 2.0f / resolution;
    const Real sign = wide::select(turn < splat(0.0f), splat(-1.0f), splat(1.0f));
    for (int k = 0; k < 3; ++k) {
        Plane plane = over_texels(edges[k], scale);
        plane = {plane.a * sign, plane.b * sign, plane.c * sign};
        keep(plane, set_up.planes[k]);
    }
    keep(nearness_plane(view, seen, scale), set_up.planes[3]);
    // Rounding on a triangle seen edge-on must not carry its nearness beyond its corners'.
    const auto& [near_a, near_b, near_c] = seen.nearness;
    const Real one = splat(1.0f);
    const Real least = view.directional ? min3(near_a, near_b, near_c) : one / max3(a.z, b.z, c.z);
    const Real most = view.directional ? max3(near_a, near_b, near_c) : one / min3(a.z, b.z, c.z);
    wide::store(wide::select(in_front, least, splat(0.0f)), set_up.least);
    wide::store(wide::select(in_front, most, splat(std::numeric_limits<float>::max())), set_up.most);
}

HWY_INLINE void draw(const SetUp& set_up, std::size_t lane, int pitch, float* numbers) {
    const auto number = [&](int plane, int k) { return splat(set_up.planes[plane][k][lane]); };
    const Real a0 = number(0, 0), a1 = number(1, 0), a2 = number(2, 0), an = number(3, 0);
    const Real least = splat(set_up.least[lane]), most = splat(set_up.most[lane]), zero = splat(0.0f);
    constexpr int step = static_cast<int>(wide::lanes);
    const Real ramp{hn::Iota(wide::RealTag(), 0.0f)};
    for (int y = set_up.first_y[lane]; y <= set_up.last_y[lane]; ++y) {
        const Real at_y = splat(static_cast<float>(y));
        const Real row0 = wide::fused(number(0, 1), at_y, number(0, 2));
        const Real row1 = wide::fused(number(1, 1), at_y, number(1, 2));
        const Real row2 = wide::fused(number(2, 1), at_y, number(2, 2));
        const Real row_n = wide::fused(number(3, 1), at_y, number(3, 2));
        float* row = numbers + static_cast<std::ptrdiff_t>(y) * pitch;
        for (int x = set_up.first_x[lane] / step * step; x <= set_up.last_x[lane]; x += step) {
            const Real at_x = splat(static_cast<float>(x)) + ramp;
            const Real inside =
                min3(wide::fused(a0, at_x, row0), wide::fused(a1, at_x, row1), wide::fused(a2, at_x, row2));
            const Real nearness = wide::min(wide::max(wide::fused(an, at_x, row_n), least), most);
            const Real before = wide::load(row + x);
            wide::store(wide::select(inside < zero, before, wide::max(before, nearness)), row + x);
        }
    }
}

}  // namespace

void MapRect::add(const MapRect& other) {
    if (other.empty()) return;
    if (empty()) {
        *this = other;
        return;
    }
    first_x = std::min(first_x, other.first_x);
    first_y = std::min(first_y, other.first_y);
    last_x = std::max(last_x, other.last_x);
    last_y = std::max(last_y, other.last_y);
}

TriangleClusters make_clusters(const Scene& scene, Progress& progress) {
    progress.begin("sorting triangles", 1);
    const std::size_t count = scene.triangles.size();
    std::vector<std::uint32_t> codes(count), order(count);
    const vec3 size = glm::max(scene.bounds.size(), vec3(1.0e-20f));
    for (std::size_t t = 0; t < count; ++t) {
        vec3 middle(0.0f);
        for (int k = 0; k < 3; ++k) middle += scene.positions[scene.triangles[t][k]] / 3.0f;
        const vec3 unit = glm::clamp((middle - scene.bounds.lowest) / size, vec3(0.0f), vec3(1.0f));
        const uvec3 cell(unit * 1023.0f);
        codes[t] = spread_bits(cell.x) | spread_bits(cell.y) << 1u | spread_bits(cell.z) << 2u;
    }
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::stable_sort(order, {}, [&](std::uint32_t t) { return codes[t]; });
    progress.check();
    TriangleClusters clusters;
    clusters.triangles = count;
    clusters.bounds.resize((count + cluster_triangles - 1) / cluster_triangles);
    for (auto& corner : clusters.corners)
        for (auto& axis : corner) axis.resize(clusters.bounds.size() * cluster_triangles);
    for (std::size_t i = 0; i < clusters.bounds.size() * cluster_triangles; ++i) {
        // The padding repeats the last triangle's first corner.
        const uvec3 corners = i < count ? scene.triangles[order[i]] : uvec3(scene.triangles[order.back()].x);
        for (int k = 0; k < 3; ++k) {
            const vec3 position = scene.positions[corners[k]];
            clusters.bounds[i / cluster_triangles].add(position);
            for (int axis = 0; axis < 3; ++axis) clusters.corners[k][axis][i] = position[axis];
        }
    }
    progress.advance();
    return clusters;
}

void rasterize(const TriangleClusters& clusters, const ShadowMapShape& shape, int map, MapRect rect,
               std::span<float> numbers, const Progress& progress) {
    if (rect.empty()) return;
    const auto pitch = static_cast<std::size_t>(shape.pitch);
    std::fill(numbers.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(rect.first_y) * pitch),
              numbers.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(rect.last_y + 1) * pitch), 0.0f);
    const MapView view = map_view(shape, map, rect);
    const auto resolution = static_cast<float>(shape.resolution);
    SetUp set_up;
    for (std::size_t cluster = 0; cluster < clusters.bounds.size(); ++cluster) {
        if (cluster % 1024 == 0) progress.check();
        if (is_outside(view, clusters.bounds[cluster])) continue;
        const std::size_t start = cluster * cluster_triangles;
        for (std::size_t first = start; first < start + cluster_triangles; first += wide::lanes) {
            set_up_triangles(view, see(clusters, view, first), rect, resolution, set_up);
            for (std::uint32_t bits = set_up.visible; bits != 0; bits &= bits - 1)
                draw(set_up, static_cast<std::size_t>(std::countr_zero(bits)), shape.pitch, numbers.data());
        }
    }
}

}  // namespace sightlines::baselines
