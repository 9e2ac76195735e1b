// The lights as the subgroups of voxel_rows_lighting.glsl and voxel_row_objects_lighting.comp hand them on.

layout(constant_id = 4) const bool shade = true;
layout(constant_id = 5) const uint kind_of_all_lights = 3u;   // 3: mixed

/// The light that invocation k of the subgroup holds. Handing on what each has read once is cheaper than reading again.
LightRecord light_of(LightRecord held, uint k) {
    LightRecord light;
    light.position = subgroupBroadcast(held.position, k);
    light.kind = kind_of_all_lights < 3u ? kind_of_all_lights : subgroupBroadcast(held.kind, k);
    light.intensity = subgroupBroadcast(held.intensity, k);
    light.cosine_outer = subgroupBroadcast(held.cosine_outer, k);
    light.direction = subgroupBroadcast(held.direction, k);
    light.cosine_inner = subgroupBroadcast(held.cosine_inner, k);
    return light;
}
