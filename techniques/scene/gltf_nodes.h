// The node hierarchy and what hangs in it.
#pragma once

#include "techniques/scene/gltf_scene.h"
#include "techniques/scene/gltf_source.h"

namespace sightlines {

/// Fills nodes, parents_first, skins, cameras and lights. InputError for a node with two parents, a loop, too deep a
/// tree, a transform that is none, a skin whose matrices do not match its joints.
void load_gltf_nodes(GltfSource& source, GltfScene& scene);

/// Fills instances, after meshes, nodes and channels. InputError for a joint that the skin does not have, and where
/// instancing multiplies the triangles or vertices beyond the limits.
void load_gltf_instances(GltfSource& source, GltfScene& scene);

/// Fills channels and duration_s, and marks the nodes that move: the file's first animation, and with it every later
/// one that moves nothing which is moved already. InputError for samplers whose accessors do not fit.
void load_gltf_animations(GltfSource& source, GltfScene& scene);

}  // namespace sightlines
