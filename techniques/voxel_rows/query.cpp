#include "techniques/voxel_rows/query.h"

#include <algorithm>

#include "shaders/voxel_row_objects.h"
#include "techniques/voxel_rows/voxel_rows.h"

namespace sightlines::voxel_rows {
namespace {

bool outside(const Box3& bounds, const Light& light) {
    if (light.kind == LightKind::directional) return true;
    return glm::any(glm::lessThan(light.position, bounds.lowest)) ||
           glm::any(glm::greaterThan(light.position, bounds.highest));
}

}  // namespace

RowShape make_query(const RowArray& array, const ParameterValues& parameters, std::span<const Light> lights) {
    const auto value = [&](std::string_view name) {
        return static_cast<float>(parameter_value(technique().parameters, parameters, name));
    };
    RowShape query = make_shape(array);
    const vec3 size = array.grid.bounds.size();
    query.subrays = static_cast<int>(value("subrays"));
    query.start_offset = value("start_offset");
    query.light_offset = value("light_offset");
    query.normal_offset_m =
        value("normal_offset") * std::max({size.x, size.y, size.z}) / static_cast<float>(query.resolution);
    const auto is_outside = [&](const Light& light) { return outside(array.grid.bounds, light); };
    query.clip_to_bounds = std::ranges::any_of(lights, is_outside) ? 1 : 0;
    return query;
}

bool is_blocked(const RowArray& array, const RowShape& query, const Segment& segment, vec3 normal) {
    const vec3 origin = scalar_kernel::ray_origin(query, segment.origin, normal);
    return scalar_kernel::is_blocked(query, {array.grid.frames.data()}, {array.words.words.data()}, origin,
                                     segment.target);
}

bool is_blocked(std::span<const ObjectInstance> objects, const Segment& segment, vec3 normal) {
    return scalar_kernel::objects_block({objects.data()}, static_cast<int>(objects.size()), segment.origin, normal,
                                        segment.target);
}

}  // namespace sightlines::voxel_rows
