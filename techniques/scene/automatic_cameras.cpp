#include "techniques/scene/automatic_cameras.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>

namespace sightlines {
namespace {

constexpr float pi = std::numbers::pi_v<float>;
constexpr vec3 down(0.0f, -1.0f, 0.0f), up(0.0f, 1.0f, 0.0f);

constexpr float eye_height = 0.2f;             ///< above the floor, of the room's height
constexpr float pulled_in = 0.1f;              ///< from the wall behind the eye, of the free line's length
constexpr float rise = 0.09f;                  ///< tangent of the angle at which `inside` looks up
constexpr float field_of_view_deg = 60.0f;     ///< vertical
constexpr float view_half_angle = 0.25f * pi;  ///< horizontal, of a wide picture at that field of view
constexpr float snap_angle = pi / 18.0f;       ///< rooms are mostly built along the axes

constexpr int floor_probes = 9;  ///< one in the middle, the others around it
constexpr int fan_directions = 32, view_directions = 9;
constexpr int lines_each_side = 3;
constexpr float worth_a_step = 0.85f;                      ///< what must be left of the nearness of what is in the way
constexpr float enough_floor = 0.6f, enough_walls = 0.8f;  ///< shares of the lines that must meet fronts

struct Ray {
    vec3 origin, direction;
};

/// Where a ray ends: at a triangle, or where it leaves the scene's bounds.
struct RayEnd {
    float distance_m = 0.0f;
    bool meets_front = false;
};

/// From inside the box; a trifle beyond it, for the walls that lie in it.
float distance_to_exit(const Box3& box, const Ray& ray) {
    float nearest = box.diagonal();
    for (int axis = 0; axis < 3; ++axis) {
        const float speed = ray.direction[axis];
        if (speed == 0.0f) continue;
        const float wall = speed > 0.0f ? box.highest[axis] : box.lowest[axis];
        nearest = std::min(nearest, std::max((wall - ray.origin[axis]) / speed, 0.0f));
    }
    return nearest + 1e-4f * box.diagonal();
}

bool overlap(const Box3& a, const Box3& b) {
    return a.lowest.x <= b.highest.x && b.lowest.x <= a.highest.x && a.lowest.y <= b.highest.y &&
           b.lowest.y <= a.highest.y && a.lowest.z <= b.highest.z && b.lowest.z <= a.highest.z;
}

/// Möller & Trumbore 1997, with a little slack so that no ray slips between neighbours.
void shorten(RayEnd& end, const Ray& ray, vec3 a, vec3 b, vec3 c) {
    constexpr float slack = 1e-5f;
    const vec3 ab = b - a, ac = c - a, across = glm::cross(ray.direction, ac);
    const float determinant = glm::dot(ab, across);
    if (determinant == 0.0f) return;
    const vec3 offset = ray.origin - a;
    const float u = glm::dot(offset, across) / determinant;
    if (!(u >= -slack && u <= 1.0f + slack)) return;
    const vec3 normal_part = glm::cross(offset, ab);
    const float v = glm::dot(ray.direction, normal_part) / determinant;
    if (!(v >= -slack && u + v <= 1.0f + slack)) return;
    const float distance_m = glm::dot(ac, normal_part) / determinant;
    if (distance_m > 0.0f && distance_m <= end.distance_m) end = {distance_m, determinant > 0.0f};
}

/// All rays at once, by brute force: few rays, and quick when they lie in a slab that few triangles reach into.
std::vector<RayEnd> ends_of(const Scene& scene, std::span<const Ray> rays) {
    std::vector<RayEnd> ends;
    std::vector<Box3> boxes;
    Box3 all;
    for (const Ray& ray : rays) {
        ends.push_back({distance_to_exit(scene.bounds, ray), false});
        Box3 box;
        box.add(ray.origin);
        box.add(ray.origin + ends.back().distance_m * ray.direction);
        all.add(box.lowest);
        all.add(box.highest);
        boxes.push_back(box);
    }
    for (const uvec3& triangle : scene.triangles) {
        const vec3 a = scene.positions[triangle.x], b = scene.positions[triangle.y], c = scene.positions[triangle.z];
        const Box3 extent{glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c))};
        if (!overlap(extent, all)) continue;
        for (std::size_t i = 0; i < rays.size(); ++i)
            if (overlap(extent, boxes[i])) shorten(ends[i], rays[i], a, b, c);
    }
    return ends;
}

float share_of_fronts(std::span<const RayEnd> ends) {
    return static_cast<float>(std::ranges::count(ends, true, &RayEnd::meets_front)) / static_cast<float>(ends.size());
}

vec3 horizontal(float angle) { return {std::cos(angle), 0.0f, std::sin(angle)}; }

/// A place to stand in, at eye height over the floor.
std::optional<vec3> standpoint(const Scene& scene) {
    const vec3 size = scene.bounds.size();
    const float radius = 0.08f * std::min(size.x, size.z);
    std::vector<Ray> rays;
    for (int i = 0; i < floor_probes; ++i) {
        // Turned a little, so that the probes of a regular room do not all run along its edges.
        const float angle = 0.3f + 2.0f * pi * static_cast<float>(i) / (floor_probes - 1);
        rays.push_back({scene.bounds.centre() + (i == 0 ? vec3(0.0f) : radius * horizontal(angle)), down});
    }
    for (int i = 0; i < floor_probes; ++i) rays.push_back({rays[static_cast<std::size_t>(i)].origin, up});
    const std::vector<RayEnd> ends = ends_of(scene, rays);
    const std::span<const RayEnd> below(ends.data(), floor_probes), above(ends.data() + floor_probes, floor_probes);
    if (share_of_fronts(below) < enough_floor) return std::nullopt;
    const auto median = [](std::span<const RayEnd> of) {
        std::vector<RayEnd> sorted(of.begin(), of.end());
        std::ranges::sort(sorted, {}, &RayEnd::distance_m);
        return sorted[sorted.size() / 2].distance_m;
    };
    const float drop_m = median(below), height_m = drop_m + median(above);
    // The first probe that ends on the floor: what is above it is air, which a table in the middle is not.
    for (std::size_t i = 0; i < floor_probes; ++i)
        if (below[i].meets_front && std::abs(below[i].distance_m - drop_m) <= 0.05f * height_m)
            return rays[i].origin + (below[i].distance_m - eye_height * height_m) * down;
    return std::nullopt;
}

/// The unit horizontal direction in which the place that is seen from `middle` is longest; none where too few of the
/// lines all around meet the front of a wall.
std::optional<vec3> long_axis(const Scene& scene, vec3 middle) {
    std::vector<Ray> rays;
    for (int i = 0; i < fan_directions; ++i)
        rays.push_back({middle, horizontal(2.0f * pi * (static_cast<float>(i) + 0.5f) / fan_directions)});
    const std::vector<RayEnd> ends = ends_of(scene, rays);
    if (share_of_fronts(ends) < enough_walls) return std::nullopt;
    // The greater principal axis of the ends' second moments.
    float xx = 0.0f, xz = 0.0f, zz = 0.0f;
    for (int i = 0; i < fan_directions; ++i) {
        const vec3 reach = ends[static_cast<std::size_t>(i)].distance_m * rays[static_cast<std::size_t>(i)].direction;
        xx += reach.x * reach.x;
        xz += reach.x * reach.z;
        zz += reach.z * reach.z;
    }
    const float angle = 0.5f * std::atan2(2.0f * xz, xx - zz);
    const float square = 0.5f * pi * std::round(angle / (0.5f * pi));
    return horizontal(std::abs(angle - square) < snap_angle ? square : angle);
}

/// Looking along a free line, from one of its ends.
struct Stand {
    vec3 eye, direction;
    float length_m = 0.0f;  ///< free ahead
};

/// On lines side by side along `axis`, the middle one first, all in the air: each is reached from `middle` in a
/// straight line.
std::vector<Stand> stands(const Scene& scene, vec3 middle, vec3 axis) {
    const vec3 side = glm::cross(axis, up);
    const std::vector<Ray> sideways = {{middle, side}, {middle, -side}};
    const std::vector<RayEnd> reach = ends_of(scene, sideways);
    std::vector<Ray> rays;
    for (int i = 0; i <= 2 * lines_each_side; ++i) {
        const int away = (i + 1) / 2;  // 0, 1, 1, 2, 2 ...: the middle first, then to either side
        const float share = 0.8f * static_cast<float>(away) / lines_each_side;
        const Ray& aside = sideways[static_cast<std::size_t>(i % 2)];
        const vec3 origin = middle + share * reach[static_cast<std::size_t>(i % 2)].distance_m * aside.direction;
        rays.push_back({origin, axis});
        rays.push_back({origin, -axis});
    }
    const std::vector<RayEnd> ends = ends_of(scene, rays);
    std::vector<Stand> found;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const float behind_m = ends[i ^ 1u].distance_m, ahead_m = ends[i].distance_m;
        const float inset_m = pulled_in * (behind_m + ahead_m);
        found.push_back({rays[i].origin - (behind_m - inset_m) * rays[i].direction, rays[i].direction,
                         behind_m + ahead_m - inset_m});
    }
    return found;
}

/// The first, or one with a clearly more open view: the harmonic mean of what is free in the directions that a picture
/// shows, which shuns a pillar before the lens as much as it likes depth.
Stand best_of(const Scene& scene, const std::vector<Stand>& candidates) {
    std::vector<Ray> rays;
    for (const Stand& stand : candidates) {
        const float ahead = std::atan2(stand.direction.z, stand.direction.x);
        for (int i = 0; i < view_directions; ++i) {
            const float share = 2.0f * static_cast<float>(i) / (view_directions - 1) - 1.0f;
            rays.push_back({stand.eye, horizontal(ahead + share * view_half_angle)});
        }
    }
    const std::vector<RayEnd> ends = ends_of(scene, rays);
    std::size_t best = 0;
    float best_nearness = 0.0f;
    for (std::size_t k = 0; k < candidates.size(); ++k) {
        float nearness = 0.0f;
        for (std::size_t i = 0; i < view_directions; ++i) nearness += 1.0f / ends[k * view_directions + i].distance_m;
        if (k == 0 || nearness < worth_a_step * best_nearness) {
            best = k;
            best_nearness = nearness;
        }
    }
    return candidates[best];
}

/// How near what hangs over the way ahead is: the mean inverse length of some lines that rise into the picture.
std::vector<float> overhang_nearness(const Scene& scene, const std::vector<Stand>& candidates) {
    std::vector<Ray> rays;
    for (const Stand& stand : candidates)
        for (const float climb : {0.4f, 0.65f})
            for (const float aside : {-0.3f, -0.1f, 0.1f, 0.3f})
                rays.push_back({stand.eye, glm::normalize(stand.direction + climb * up +
                                                          aside * glm::cross(stand.direction, up))});
    const std::vector<RayEnd> ends = ends_of(scene, rays);
    const std::size_t each = rays.size() / candidates.size();
    std::vector<float> nearness(candidates.size(), 0.0f);
    for (std::size_t i = 0; i < ends.size(); ++i)
        nearness[i / each] += 1.0f / (static_cast<float>(each) * ends[i].distance_m);
    return nearness;
}

/// Some steps ahead where that brings the eye out from under an arch or a gallery.
Stand clear_of_overhang(const Scene& scene, const Stand& stand) {
    std::vector<Stand> candidates;
    for (const float share : {0.0f, 0.05f, 0.1f, 0.15f, 0.2f}) {
        const float step_m = share * stand.length_m;
        candidates.push_back({stand.eye + step_m * stand.direction, stand.direction, stand.length_m - step_m});
    }
    const std::vector<float> nearness = overhang_nearness(scene, candidates);
    std::size_t best = 0;
    for (std::size_t i = 1; i < candidates.size(); ++i)
        if (nearness[i] < worth_a_step * nearness[best]) best = i;
    return candidates[best];
}

std::optional<Camera> inside_camera(const Scene& scene) {
    if (scene.bounds.empty()) return std::nullopt;
    const std::optional<vec3> middle = standpoint(scene);
    if (!middle) return std::nullopt;
    const std::optional<vec3> axis = long_axis(scene, *middle);
    if (!axis) return std::nullopt;
    const Stand stand = clear_of_overhang(scene, best_of(scene, stands(scene, *middle, *axis)));
    Camera camera;
    camera.name = "inside";
    camera.position = stand.eye;
    camera.target = stand.eye + 0.5f * stand.length_m * (stand.direction + rise * up);
    camera.vertical_field_of_view_deg = field_of_view_deg;
    return camera;
}

}  // namespace

std::vector<Camera> automatic_cameras(const Scene& scene) {
    std::vector<Camera> cameras;
    if (const std::optional<Camera> inside = inside_camera(scene)) cameras.push_back(*inside);
    cameras.push_back(framing_camera(scene.bounds));
    cameras.back().name = "outside";
    return cameras;
}

}  // namespace sightlines
