// Materials and the pictures they use.
#pragma once

#include <vector>

#include "techniques/base/progress.h"
#include "techniques/scene/gltf_source.h"
#include "techniques/scene/scene.h"

namespace sightlines {

struct GltfMaterials {
    std::vector<Material> materials;  ///< [the document's]; one more, matte light grey, for primitives that name none
    std::vector<Texture> textures;    ///< only those that a material looks up
};

/// Decodes the PNG and JPEG pictures of base colour and emission. InputError for a damaged or too large picture; a note
/// for one of another format and for what the picture will not show (normal maps, blending ...).
GltfMaterials load_gltf_materials(GltfSource& source, Progress& progress);

}  // namespace sightlines
