#include "techniques/scene/builtin_posed.h"

#include <mutex>
#include <utility>

namespace sightlines {
namespace {

constexpr int sampled_times = 64;
constexpr float motion_margin = 0.02f;

void add_box(Box3& box, const Box3& added) {
    if (added.empty()) return;
    box.add(added.lowest);
    box.add(added.highest);
}

bool is_animated(const Part& part) { return part.moves || part.deforms; }

/// Of the vertices of the triangles of all parts that are animated, or of all that are not.
Box3 bounds_of_parts(const Scene& scene, bool animated) {
    Box3 bounds;
    for (const Part& part : scene.parts) {
        if (is_animated(part) != animated) continue;
        for (std::uint32_t i = part.first_triangle; i < part.first_triangle + part.triangle_count; ++i)
            for (int corner = 0; corner < 3; ++corner) bounds.add(scene.positions[scene.triangles[i][corner]]);
    }
    return bounds;
}

/// What a model keeps between two calls.
struct Made {
    std::once_flag once;
    PosableScene posable;
    Box3 still_bounds, motion_bounds;
};

void make_once(Made& made, const std::string& name, double duration_s, const std::function<PosableScene()>& make) {
    made.posable = make();
    made.posable.rest.name = name;
    made.still_bounds = bounds_of_parts(made.posable.rest, false);
    made.motion_bounds = made.still_bounds;
    bool animated = false;
    for (const Part& part : made.posable.rest.parts) animated = animated || is_animated(part);
    if (!animated) return;
    if (made.posable.reach) {
        add_box(made.motion_bounds, *made.posable.reach);
        return;
    }
    Box3 reached;
    Scene scene = made.posable.rest;
    for (int i = 0; i < sampled_times; ++i) {
        made.posable.pose(scene, duration_s * i / sampled_times);
        add_box(reached, bounds_of_parts(scene, true));
    }
    const vec3 margin = motion_margin * reached.size();
    add_box(made.motion_bounds, {reached.lowest - margin, reached.highest + margin});
}

}  // namespace

RigidPart add_rigid_part(Scene& scene, std::shared_ptr<const Mesh> mesh, const std::string& name,
                         std::uint32_t mesh_number) {
    const RigidPart rigid{static_cast<std::uint32_t>(scene.parts.size()),
                          static_cast<std::uint32_t>(scene.positions.size()), std::move(mesh)};
    add_part(scene, *rigid.mesh, name, mesh_number, mat4(1.0f));
    scene.parts.back().moves = true;
    return rigid;
}

void place_part(Scene& scene, const RigidPart& rigid, const mat4& world_from_part) {
    scene.parts[rigid.part].world_from_part = world_from_part;
    const mat3 linear(world_from_part);
    const vec3 moved(world_from_part[3]);
    const mat3 turn = linear * (1.0f / glm::length(linear[0]));
    vec3* positions = scene.positions.data() + rigid.first_vertex;
    vec3* normals = scene.normals.data() + rigid.first_vertex;
    for (std::size_t i = 0; i < rigid.mesh->positions.size(); ++i) {
        positions[i] = linear * rigid.mesh->positions[i] + moved;
        normals[i] = turn * rigid.mesh->normals[i];
    }
}

SceneModel posed_model(const std::string& name, const std::string& about, double duration_s,
                       std::function<PosableScene()> make) {
    const auto made = std::make_shared<Made>();
    return {name, about, duration_s, [made, name, duration_s, make = std::move(make)](double time_s) {
                std::call_once(made->once, [&] { make_once(*made, name, duration_s, make); });
                Scene scene = made->posable.rest;
                scene.time_s = time_s;
                made->posable.pose(scene, time_s);
                scene.bounds = made->still_bounds;
                add_box(scene.bounds, bounds_of_parts(scene, true));
                scene.motion_bounds = made->motion_bounds;
                add_box(scene.motion_bounds, scene.bounds);
                return scene;
            }};
}

void PartBuilder::add(const Mesh& mesh, const std::string& name, const std::vector<mat4>& places) {
    for (const mat4& place : places) add_part(scene, mesh, name, meshes, place);
    ++meshes;
}

void PartBuilder::add(const Mesh& mesh, const std::string& name) { add(mesh, name, {mat4(1.0f)}); }

std::vector<RigidPart> PartBuilder::add_rigid(Mesh mesh, const std::string& name, int count) {
    const auto shared = std::make_shared<const Mesh>(std::move(mesh));
    std::vector<RigidPart> parts;
    for (int i = 0; i < count; ++i) parts.push_back(add_rigid_part(scene, shared, name, meshes));
    ++meshes;
    return parts;
}

}  // namespace sightlines
