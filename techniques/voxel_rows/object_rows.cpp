#include "techniques/voxel_rows/object_rows.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "techniques/voxel_rows/query.h"

namespace sightlines::voxel_rows {
namespace {

// Beyond these a picture with thousands of lights takes longer by objects than by splatting them anew, or their arrays
// take more memory than is gained (README, "Objects that move rigidly").
constexpr std::size_t most_objects = 16, most_types = 8;

constexpr float least_volume = 1.0e-12f;  ///< of the unit cube after an instance's matrix

float volume_of(const mat4& world_from_object) { return std::abs(glm::determinant(mat3(world_from_object))); }

bool has_extent(const Part& part) {
    const float volume = volume_of(part.world_from_part);
    return std::isfinite(volume) && volume > least_volume;
}

ObjectInstance instance_of(const RowArray& type, const PlacedObject& placed, const ParameterValues& parameters) {
    ObjectInstance instance{};
    instance.frames = std::bit_cast<std::uintptr_t>(type.grid.frames.data());
    instance.rows = std::bit_cast<std::uintptr_t>(type.words.words.data());
    instance.query = make_query(type, parameters, {});
    instance.query.normal_offset_m *= std::cbrt(volume_of(placed.world_from_object));
    const mat4 object_from_world = glm::inverse(placed.world_from_object);
    const mat3 rows = glm::transpose(mat3(object_from_world));
    instance.axis_x = rows[0];
    instance.axis_y = rows[1];
    instance.axis_z = rows[2];
    instance.shift = vec3(object_from_world[3]);
    instance.type = placed.type;
    return instance;
}

}  // namespace

bool moves_rigidly(const Scene& scene) {
    return anything_moves(scene) && std::ranges::none_of(scene.parts, &Part::deforms);
}

bool worth_asking_objects(const Scene& scene) {
    if (!moves_rigidly(scene)) return false;
    const auto moving = static_cast<std::size_t>(std::ranges::count_if(scene.parts, &Part::moves));
    return moving <= most_objects && rigid_objects(scene).size() <= most_types;
}

RowArray build_object(const Scene& scene, const RigidObject& object, const BuildOptions& options, bool directly,
                      Progress& progress) {
    RigidObject whole = object;
    std::erase_if(whole.parts, [&](std::uint32_t part) { return !has_extent(scene.parts[part]); });
    if (whole.parts.empty()) return {};
    Scene own = object_scene(scene, whole);
    const vec3 size = own.bounds.size();
    const float margin = 0.5f * std::max({size.x, size.y, size.z}) / static_cast<float>(options.resolution);
    own.bounds = own.motion_bounds = {own.bounds.lowest - margin, own.bounds.highest + margin};
    return directly ? build_directly(own, options, progress) : build_from_fragments(own, options, progress);
}

std::vector<PlacedObject> placed_objects(const Scene& scene) {
    std::vector<PlacedObject> placed;
    const std::vector<RigidObject> objects = rigid_objects(scene);
    for (std::uint32_t type = 0; type < objects.size(); ++type)
        for (const std::uint32_t part : objects[type].parts)
            if (has_extent(scene.parts[part])) placed.push_back({type, scene.parts[part].world_from_part});
    return placed;
}

std::vector<ObjectInstance> object_instances(const Objects& objects, const ParameterValues& parameters) {
    std::vector<ObjectInstance> instances;
    for (const PlacedObject& placed : objects.placed)
        instances.push_back(instance_of(objects.types[placed.type], placed, parameters));
    return instances;
}

Box3 world_bounds(const RowArray& type, const mat4& world_from_object) {
    const Box3& own = type.grid.bounds;
    const vec3 centre(world_from_object * vec4(own.centre(), 1.0f));
    const vec3 half_own = 0.5f * own.size();
    vec3 half_size(0.0f);
    for (int axis = 0; axis < 3; ++axis) half_size += glm::abs(vec3(world_from_object[axis])) * half_own[axis];
    return {centre - half_size, centre + half_size};
}

std::uint64_t bytes_of(std::span<const RowArray> types) {
    std::uint64_t bytes = 0;
    for (const RowArray& type : types) bytes += type.words.bytes();
    return bytes;
}

}  // namespace sightlines::voxel_rows
