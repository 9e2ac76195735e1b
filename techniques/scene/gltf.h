// glTF 2.0 in: an untrusted file becomes a SceneModel or one InputError.
#pragma once

#include <filesystem>

#include "techniques/base/progress.h"
#include "techniques/scene/scene.h"

namespace sightlines {

/// Reads `.gltf` or `.glb` with everything that its external buffers and images hold. InputError names the file, the
/// place inside it (`accessors[3]`), what is wrong and how to mend it. A file without triangles is a scene with none
/// and a note.
SceneModel load_gltf(const std::filesystem::path& file, Progress& progress);

}  // namespace sightlines
