// Scenes made by code: deterministic, no files, one per thing worth teaching.
#pragma once

#include <vector>

#include "techniques/base/progress.h"
#include "techniques/scene/scene.h"

namespace sightlines {

/// All built-in scenes in the order that `list scenes` shows, cornell first. Making the list is free; the triangles are
/// made by `SceneModel::at`, once.
const std::vector<SceneModel>& builtin_scenes();

/// A built-in scene by name, or a `.gltf`/`.glb` file by path. InputError offers the nearest built-in name.
SceneModel find_scene(const std::string& name_or_path, Progress& progress);

}  // namespace sightlines
