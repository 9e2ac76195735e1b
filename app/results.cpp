#include "app/results.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "techniques/base/error.h"
#include "techniques/compute/device.h"
#include "techniques/rays/virtual_lights.h"
#include "techniques/scene/builtin_scenes.h"
#include "techniques/scene/moving_parts.h"

namespace sightlines {
namespace {

/// The reference keeps one bit for each pixel and light, twice (the technique's and Embree's).
constexpr std::uint64_t verdict_limit_bytes = std::uint64_t{2} << 30u;

/// The technique's parameters out of those that are set; of one kind only, or all.
std::map<std::string, ParameterValues> own_parameters(const Session& session, std::optional<ParameterAffects> kind) {
    ParameterValues kept;
    for (const Parameter& row : find_technique(session.technique).parameters) {
        const ParameterValues values = technique_parameters(session);
        const auto given = values.find(std::string(row.name));
        if (given == values.end() || (kind && row.affects != *kind)) continue;
        kept.insert(*given);
    }
    if (kept.empty()) return {};
    return {{session.technique, std::move(kept)}};
}

void check_verdicts(const Session& session, const std::vector<Light>& lights) {
    const std::size_t light_count = rays_per_pixel(session, lights);
    const std::uint64_t words = (light_count + 31u) / 32u;
    const std::uint64_t bytes = 2u * 4u * words * session.size.pixels();
    if (bytes > verdict_limit_bytes)
        throw InputError("reference", "",
                         std::to_string(session.size.pixels()) + " pixels times " + std::to_string(light_count) +
                             (lit_by_environment(session) ? " samples" : " lights") + " are too many rays to compare",
                         "a smaller picture or fewer of these; their answers may take " +
                             std::to_string(verdict_limit_bytes >> 20u) + " MiB");
}

}  // namespace

template <class Value>
template <class Make>
Shared<Value> Stage<Value>::get(const Session& part, Progress& progress, bool forget_first, Make make) {
    if (auto ready = latest(part)) return ready;
    begin_making(progress);
    const struct Making {
        Stage& stage;
        ~Making() { stage.end_making(); }
    } making{*this};
    if (auto ready = latest(part)) return ready;
    progress.check();
    if (forget_first) keep(std::nullopt, nullptr);
    const auto start = std::chrono::steady_clock::now();
    auto made = std::make_shared<Made<Value>>();
    made->value = make();
    made->seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    keep(part, made);
    return made;
}

std::filesystem::path default_cache_folder() {
    namespace fs = std::filesystem;
    const char* const wish = std::getenv("SIGHTLINES_CACHE");
    if (wish != nullptr && std::string(wish) == "off") return {};
    const char* const cache = std::getenv("XDG_CACHE_HOME");
    if (cache != nullptr && fs::path(cache).is_absolute()) return fs::path(cache) / "sightlines" / "arrays";
    const char* const home = std::getenv("HOME");
    return home == nullptr ? fs::path() : fs::path(home) / ".cache" / "sightlines" / "arrays";
}

Camera session_camera(const Session& session, const Scene& scene) {
    return session.free_camera ? *session.free_camera : find_camera(scene, session.camera);
}

Backend automatic_backend() {
    const auto is_gpu = [](const compute::DeviceInfo& device) {
        return device.lacks.empty() && device.kind != compute::DeviceKind::cpu &&
               device.kind != compute::DeviceKind::other;
    };
    return std::ranges::any_of(compute::list_devices(), is_gpu) ? Backend::vulkan : Backend::cpu;
}

Environment make_surroundings(const EnvironmentChoice& choice) {
    if (!choice.file.empty()) return read_environment(choice.file);
    SkyOptions sky;
    sky.sun_elevation_deg = choice.sun_elevation_deg;
    sky.sun_azimuth_deg = choice.sun_azimuth_deg;
    return procedural_sky(sky);
}

float turn_deg(const Session& session) {
    const EnvironmentChoice& choice = session.environment;
    const double turn = double{choice.turn_deg} + double{choice.turn_deg_per_s} * session.time_s;
    return static_cast<float>(std::fmod(turn, 360.0));
}

std::size_t rays_per_pixel(const Session& session, const std::vector<Light>& lights) {
    const EnvironmentLit* const lit = find_technique(session.technique).environment;
    return lit != nullptr ? lit->samples_per_pixel(technique_parameters(session)) : lights.size();
}

RenderResult reference_picture(const Technique& technique, const EmbreeScene& embree, const RenderRequest& request,
                               Progress& progress) {
    return technique.environment != nullptr ? technique.environment->reference(embree, request, progress)
                                            : render_reference(embree, request, progress);
}

Session model_part(const Session& session) {
    Session part;
    part.scene = session.scene;
    return part;
}

Session scene_part(const Session& session) {
    Session part = model_part(session);
    part.time_s = session.time_s;
    return part;
}

Session surfaces_part(const Session& session) {
    Session part = scene_part(session);
    part.free_camera = session.free_camera;
    if (!session.free_camera) part.camera = session.camera;
    part.size = session.size;
    return part;
}

Session lights_part(const Session& session) {
    Session part = scene_part(session);
    if (lit_by_environment(session)) {
        part.technique = session.technique;
        return part;
    }
    part.lights = session.lights;
    part.seed = session.seed;
    return part;
}

Session environment_part(const Session& session) {
    Session part;
    part.environment = session.environment;
    part.environment.turn_deg = turn_deg(session);
    part.environment.turn_deg_per_s = 0.0f;
    if (session.environment.file.empty()) return part;
    part.environment.sun_elevation_deg = EnvironmentChoice{}.sun_elevation_deg;
    part.environment.sun_azimuth_deg = EnvironmentChoice{}.sun_azimuth_deg;
    return part;
}

Session structure_part(const Session& session) {
    Session part = scene_part(session);
    part.technique = session.technique;
    part.parameters = own_parameters(session, ParameterAffects::structure);
    part.backend = session.backend;
    return part;
}

Session reference_part(const Session& session) {
    Session part = surfaces_part(session);
    if (lit_by_environment(session)) {
        part.technique = session.technique;
        part.parameters = own_parameters(session, ParameterAffects::picture);
        part.environment = environment_part(session).environment;
    } else {
        part.lights = session.lights;
    }
    part.seed = session.seed;
    part.reference = needs_reference(session);
    return part;
}

Session picture_part(const Session& session) {
    Session part = reference_part(session);
    part.technique = session.technique;
    part.parameters = own_parameters(session, std::nullopt);
    part.backend = session.backend;
    return part;
}

Backend Results::backend(const Session& session) const {
    return resolved(session).backend == BackendChoice::vulkan ? Backend::vulkan : Backend::cpu;
}

Session Results::resolved(Session session) const {
    if (session.backend != BackendChoice::automatic) return session;
    if (!find_technique(session.technique).on_vulkan) {
        session.backend = BackendChoice::cpu;
        return session;
    }
    std::call_once(automatic_asked_, [this] { automatic_answer_ = automatic_(); });
    session.backend = automatic_answer_ == Backend::vulkan ? BackendChoice::vulkan : BackendChoice::cpu;
    return session;
}

PictureRequest Results::request(const Session& session, const SurfaceBuffer& surfaces, const std::vector<Light>& lights,
                                Progress& progress) {
    PictureRequest asked;
    RenderRequest& request = asked.request;
    if (lit_by_environment(session)) {
        asked.environment = environment(session, progress);
        asked.samples = samples(session, progress);
        request.environment = &asked.environment->value;
        request.samples = &asked.samples->value;
    }
    asked.scene = scene(session, progress);
    request.scene = &asked.scene->value;
    request.surfaces = &surfaces;
    request.lights = lights;
    request.parameters = technique_parameters(session);
    request.backend = backend(session);
    request.seed = session.seed;
    request.threads = threads_;
    request.keep_verdicts = needs_reference(session);
    return asked;
}

Shared<SceneModel> Results::model(const Session& session, Progress& progress) {
    return model_.get(model_part(session), progress, true, [&] { return find_scene(session.scene, progress); });
}

Shared<SceneModel> Results::tried_model(const Session& session, Progress& progress) {
    return model_.get(model_part(session), progress, false, [&] { return find_scene(session.scene, progress); });
}

namespace {

/// What depends on a part of the session and the scene's geometry, not on the time where only lights move.
Session geometry_key(Session part, const Scene& scene) {
    if (!anything_moves(scene)) part.time_s = 0.0;
    return part;
}

}  // namespace

Session Results::at_rest(Session session) const {
    const auto model = model_.latest(model_part(session));
    if (model && model->value.duration_s == 0.0 && !session.lights.moving) session.time_s = 0.0;
    return session;
}

Shared<Scene> Results::scene(const Session& session, Progress& progress) {
    if (auto ready = scene_.latest(scene_part(at_rest(session)))) return ready;
    const auto model = this->model(session, progress);
    return scene_.get(scene_part(at_rest(session)), progress, false, [&] { return model->value.at(session.time_s); });
}

Shared<std::shared_ptr<const EmbreeScene>> Results::embree(const Session& session, Progress& progress) {
    const auto scene = this->scene(session, progress);
    const Session part = geometry_key(scene_part(at_rest(session)), scene->value);
    return embree_.get(part, progress, false, [&] {
        const auto build = [&](PartChoice parts) {
            return build_embree_scene(scene->value, EmbreeUse::reference, threads_, progress, parts);
        };
        std::shared_ptr<const EmbreeScene>& fixed = fixed_tree_.of(part);
        if (!anything_moves(scene->value)) return build(PartChoice::all);
        if (fixed == nullptr) fixed = build(PartChoice::fixed);
        return build_moment_tree(scene->value, fixed, threads_, progress);
    });
}

Shared<SurfaceBuffer> Results::surfaces(const Session& session, Progress& progress) {
    const auto scene = this->scene(session, progress);
    const auto embree = this->embree(session, progress);
    return surfaces_.get(surfaces_part(at_rest(session)), progress, false, [&] {
        return visible_surfaces(scene->value, *embree->value, session_camera(session, scene->value), session.size,
                                threads_, progress);
    });
}

Shared<EnvironmentLight> Results::environment(const Session& session, Progress& progress) {
    const Session part = environment_part(session);
    if (auto ready = environment_.latest(part)) return ready;
    Session still = part;
    still.environment.turn_deg = 0.0f;
    const auto surroundings = surroundings_.get(
        still, progress, true, [&] { return make_environment_light(make_surroundings(still.environment)); });
    return environment_.get(part, progress, false,
                            [&] { return turned(surroundings->value, part.environment.turn_deg); });
}

Shared<std::any> Results::samples(const Session& session, Progress& progress) {
    const EnvironmentLit& lit = *find_technique(session.technique).environment;
    Session part;
    part.technique = session.technique;
    part.parameters = own_parameters(session, ParameterAffects::picture);
    part.seed = session.seed;
    return samples_.get(part, progress, false,
                        [&] { return lit.samples(technique_parameters(session), session.seed); });
}

Shared<std::vector<Light>> Results::lights(const Session& session, Progress& progress) {
    const auto scene = this->scene(session, progress);
    const bool unlit = lit_by_environment(session);
    const std::uint32_t indirect = unlit ? 0 : session.lights.virtual_lights;
    const auto embree = indirect > 0 ? this->embree(session, progress) : nullptr;
    return lights_.get(lights_part(at_rest(session)), progress, false, [&] {
        if (unlit) return std::vector<Light>{};
        std::vector<Light> lights = make_lights(scene->value, session.lights, session.seed);
        if (indirect == 0) return lights;
        if (lights.size() + indirect > max_lights)
            throw InputError("virtual lights", "", std::to_string(lights.size() + indirect) + " lights are too many",
                             "the most is " + std::to_string(max_lights) + " with the lights that they come from");
        const std::vector<Light> added =
            virtual_lights(scene->value, *embree->value, lights, indirect, session.seed, threads_, progress);
        lights.insert(lights.end(), added.begin(), added.end());
        return lights;
    });
}

Session Results::structure_key(const Session& session, const Scene& scene) const {
    return geometry_key(structure_part(resolved(session)), scene);
}

Shared<BuiltStructure> Results::structure(const Session& session, Progress& progress) {
    const auto scene = this->scene(session, progress);
    const Session part = structure_key(session, scene->value);
    return structure_.get(part, progress, true, [&] {
        BuiltStructure built{&find_technique(session.technique), scene, {}, {}};
        BuildRequest request{&scene->value, technique_parameters(session), backend(session), threads_};
        request.cache_folder = cache_folder;
        std::any& kept = kept_.of(part);  // stays where this build is cancelled, as it is when time moves on
        request.kept = kept;
        built.structure = built.technique->build(request, progress);
        built.statistics = built.technique->statistics(built.structure);
        if (built.technique->kept) kept = built.technique->kept(built.structure);
        return built;
    });
}

Shared<RenderResult> Results::picture(const Session& session, Progress& progress, const OnRegion& on_region) {
    const auto lights = this->lights(session, progress);
    if (needs_reference(session)) check_verdicts(session, lights->value);
    const auto surfaces = this->surfaces(session, progress);
    const auto structure = this->structure(session, progress);
    if (auto ready = latest_picture(session)) return ready;
    return picture_.get(picture_part(resolved(session)), progress, false, [&] {
        PictureRequest asked = request(session, surfaces->value, lights->value, progress);
        asked.request.on_region = on_region;
        return structure->value.technique->render(structure->value.structure, asked.request, progress);
    });
}

Shared<RenderResult> Results::reference(const Session& session, Progress& progress, const OnRegion& on_region) {
    const auto lights = this->lights(session, progress);
    if (needs_reference(session)) check_verdicts(session, lights->value);
    const auto surfaces = this->surfaces(session, progress);
    const auto embree = this->embree(session, progress);
    return reference_.get(reference_part(session), progress, false, [&] {
        PictureRequest asked = request(session, surfaces->value, lights->value, progress);
        asked.request.on_region = on_region;
        return reference_picture(find_technique(session.technique), *embree->value, asked.request, progress);
    });
}

Shared<ErrorMetrics> Results::errors(const Session& session, Progress& progress) {
    const auto ours = picture(session, progress);
    const auto truth = reference(session, progress);
    return errors_.get(picture_part(resolved(session)), progress, false,
                       [&] { return compare(ours->value, truth->value); });
}

Shared<ErrorMetrics> Results::compression(const Session& session, Progress& progress) {
    const auto ours = picture(session, progress);
    const auto lights = this->lights(session, progress);
    const auto scene = this->scene(session, progress);
    const auto surfaces = this->surfaces(session, progress);
    return compression_.get(picture_part(resolved(session)), progress, false, [&] {
        Session plain = session;
        plain.parameters[session.technique].erase("compression");
        if (plain == session) return compare(ours->value, ours->value);
        // Not a stage of its own: it is large, and needed once.
        const Technique& technique = find_technique(session.technique);
        const Structure structure =
            technique.build({&scene->value, technique_parameters(plain), backend(plain), threads_}, progress);
        return compare(
            ours->value,
            technique.render(structure, request(plain, surfaces->value, lights->value, progress).request, progress));
    });
}

Shared<RenderResult> Results::latest_picture(const Session& session) const {
    if (picture_.empty()) return nullptr;
    Session part = picture_part(resolved(session));
    if (auto ready = picture_.latest(part)) return ready;
    // One that was made to be compared is the same picture, with every ray's answer besides.
    part.reference = true;
    return picture_.latest(part);
}

Shared<BuiltStructure> Results::latest_structure(const Session& session) const {
    if (structure_.empty()) return nullptr;
    const auto scene = scene_.latest(scene_part(at_rest(session)));
    return scene ? structure_.latest(structure_key(session, scene->value)) : nullptr;
}

}  // namespace sightlines
