// Whether anything is in the way of a ray that has no end, by the device's own ray queries. GLSL only: what the kernel
// of the ray tree answers where a device has none. Needs GL_EXT_ray_query.
#ifndef SIGHTLINES_RAY_QUERY_GLSL
#define SIGHTLINES_RAY_QUERY_GLSL

#include "ray_tree.h"

/// Opaque triangles end the query; those with holes are offered here, and count where their texture is solid. `tree`: their
/// records and cut-outs, its nodes unused. `ray_scene`: the address of an acceleration structure.
bool is_blocked_by_query(RayTreeTables tree, uvec2 ray_scene, vec3 origin, vec3 direction) {
    rayQueryEXT query;
    rayQueryInitializeEXT(query, accelerationStructureEXT(ray_scene), gl_RayFlagsTerminateOnFirstHitEXT, 0xffu, origin,
                          0.0f, direction, 3.0e38f);
    while (rayQueryProceedEXT(query)) {
        const uint triangle = uint(rayQueryGetIntersectionPrimitiveIndexEXT(query, false));
        const vec2 shares = rayQueryGetIntersectionBarycentricsEXT(query, false);
        TriangleMeeting meeting;
        meeting.share_b = shares.x;
        meeting.share_c = shares.y;
        meeting.inside = true;
        if (is_solid_at(tree, triangle_words(tree, 3u * triangle).w, meeting)) rayQueryConfirmIntersectionEXT(query);
    }
    return rayQueryGetIntersectionTypeEXT(query, true) != gl_RayQueryCommittedIntersectionNoneEXT;
}

#endif
