#include "techniques/scene/gltf.h"

#include <exception>
#include <memory>
#include <new>
#include <utility>

#include "techniques/base/error.h"
#include "techniques/scene/gltf_materials.h"
#include "techniques/scene/gltf_meshes.h"
#include "techniques/scene/gltf_nodes.h"
#include "techniques/scene/gltf_scene.h"
#include "techniques/scene/gltf_source.h"

namespace sightlines {
namespace {

GltfScene load_parts(const std::filesystem::path& file, Progress& progress) {
    progress.begin("reading " + file.filename().string(), 1);
    GltfSource source = read_gltf_source(file);
    progress.advance();

    GltfScene scene;
    scene.file = source.file;
    scene.name = file.stem().string();
    GltfMaterials materials = load_gltf_materials(source, progress);
    scene.materials = std::move(materials.materials);
    scene.textures = std::move(materials.textures);
    scene.meshes = load_gltf_meshes(source, progress);
    load_gltf_nodes(source, scene);
    load_gltf_animations(source, scene);
    load_gltf_instances(source, scene);
    if (scene.instances.empty()) add_note(source.notes, "the file shows no triangles");
    scene.notes = std::move(source.notes);
    return scene;
}

SceneModel model_of(GltfScene loaded) {
    SceneModel model;
    model.name = loaded.name;
    model.about = "read from " + loaded.file;
    model.duration_s = loaded.duration_s;
    Scene start = gltf_scene_at(loaded, 0.0);
    if (loaded.cameras.empty()) loaded.automatic_cameras = start.cameras;  // the same at all times
    loaded.moving_bounds = gltf_moving_bounds(loaded);
    if (!(loaded.duration_s > 0.0)) {
        model.at = [still = std::make_shared<const Scene>(std::move(start))](double time_s) {
            Scene scene = *still;
            scene.time_s = time_s;
            return scene;
        };
        return model;
    }
    model.at = [moving = std::make_shared<const GltfScene>(std::move(loaded))](double time_s) {
        return gltf_scene_at(*moving, time_s);
    };
    return model;
}

}  // namespace

SceneModel load_gltf(const std::filesystem::path& file, Progress& progress) {
    try {
        return model_of(load_parts(file, progress));
    } catch (const InputError&) {
        throw;
    } catch (const EnvironmentError&) {
        throw;
    } catch (const Cancelled&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw EnvironmentError(file.string(), "there is not enough memory to load it",
                               "close other programs or use a smaller scene");
    } catch (const std::exception& failure) {
        throw InputError(file.string(), "", std::string("cannot be read as glTF: ") + failure.what(),
                         "check it with a glTF validator");
    }
}

}  // namespace sightlines
