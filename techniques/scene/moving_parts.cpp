#include "techniques/scene/moving_parts.h"

#include <algorithm>
#include <limits>

namespace sightlines {
namespace {

constexpr std::uint32_t not_taken = std::numeric_limits<std::uint32_t>::max();

bool changes(const Part& part) { return part.moves || part.deforms; }

/// The triangles of the parts that `wanted` says, with the vertices that they use.
template <class Wanted>
Scene scene_of_parts(const Scene& scene, const Wanted& wanted) {
    Scene taken;
    taken.name = scene.name;
    taken.time_s = scene.time_s;
    taken.materials = scene.materials;
    for (Material& material : taken.materials) {
        material.base_color_texture.reset();
        material.emissive_texture.reset();
    }
    std::vector<std::uint32_t> place(scene.positions.size(), not_taken);
    for (const Part& part : scene.parts) {
        if (!wanted(part)) continue;
        Part kept = part;
        kept.first_triangle = static_cast<std::uint32_t>(taken.triangles.size());
        taken.parts.push_back(kept);
        for (std::uint32_t t = part.first_triangle; t < part.first_triangle + part.triangle_count; ++t) {
            uvec3 triangle = scene.triangles[t];
            for (int k = 0; k < 3; ++k) {
                std::uint32_t& vertex = place[triangle[k]];
                if (vertex == not_taken) {
                    vertex = static_cast<std::uint32_t>(taken.positions.size());
                    taken.positions.push_back(scene.positions[triangle[k]]);
                    taken.bounds.add(taken.positions.back());
                }
                triangle[k] = vertex;
            }
            taken.triangles.push_back(triangle);
            taken.triangle_materials.push_back(scene.triangle_materials[t]);
        }
    }
    taken.motion_bounds = scene.motion_bounds;
    return taken;
}

}  // namespace

bool anything_moves(const Scene& scene) { return std::ranges::any_of(scene.parts, changes); }

std::vector<std::uint8_t> triangles_of(const Scene& scene, PartChoice parts) {
    std::vector<std::uint8_t> wanted(scene.triangles.size(), parts != PartChoice::changing);
    if (parts == PartChoice::all) return wanted;
    for (const Part& part : scene.parts)
        std::fill_n(wanted.begin() + part.first_triangle, part.triangle_count,
                    changes(part) == (parts == PartChoice::changing));
    return wanted;
}

Box3 bounds_of_motion(const Scene& scene) {
    Box3 bounds = scene.bounds;
    if (scene.motion_bounds.empty()) return bounds;
    bounds.add(scene.motion_bounds.lowest);
    bounds.add(scene.motion_bounds.highest);
    return bounds;
}

std::vector<Box3> changing_boxes(const Scene& scene, std::size_t most) {
    const auto changing = static_cast<std::size_t>(std::ranges::count_if(scene.parts, changes));
    std::vector<Box3> boxes(std::min(changing, most));
    std::size_t next = 0;
    for (const Part& part : scene.parts) {
        if (!changes(part)) continue;
        Box3& box = boxes[next++ * boxes.size() / changing];
        for (std::uint32_t t = part.first_triangle; t < part.first_triangle + part.triangle_count; ++t)
            for (int corner = 0; corner < 3; ++corner) box.add(scene.positions[scene.triangles[t][corner]]);
    }
    std::erase_if(boxes, [](const Box3& box) { return box.empty(); });
    return boxes;
}

Scene fixed_scene(const Scene& scene) {
    return scene_of_parts(scene, [](const Part& part) { return !changes(part); });
}

Scene changing_scene(const Scene& scene) { return scene_of_parts(scene, changes); }

std::vector<RigidObject> rigid_objects(const Scene& scene) {
    std::vector<RigidObject> objects;
    for (std::uint32_t p = 0; p < scene.parts.size(); ++p) {
        const Part& part = scene.parts[p];
        if (!part.moves || part.deforms) continue;
        const auto known = std::ranges::find(objects, part.mesh, &RigidObject::mesh);
        if (known == objects.end())
            objects.push_back({part.mesh, {p}});
        else
            known->parts.push_back(p);
    }
    return objects;
}

Scene object_scene(const Scene& scene, const RigidObject& object) {
    const Part& first = scene.parts[object.parts.front()];
    Scene shape = scene_of_parts(scene, [&](const Part& part) { return &part == &first; });
    const mat4 part_from_world = glm::inverse(first.world_from_part);
    shape.bounds = {};
    for (vec3& position : shape.positions) {
        position = vec3(part_from_world * vec4(position, 1.0f));
        shape.bounds.add(position);
    }
    shape.motion_bounds = shape.bounds;
    shape.parts.front().world_from_part = mat4(1.0f);
    return shape;
}

}  // namespace sightlines
