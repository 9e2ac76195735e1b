// Imperfect shadow maps: the technique's row in the catalog, and Algorithm 4 with two small maps for each light.
#include <memory>

#include "shaders/wide.h"  // first: makes the kernels below wide

#include "shaders/shadow_map.h"
#include "techniques/base/random.h"
#include "techniques/baselines/baselines.h"
#include "techniques/baselines/imperfect_shadow_maps/splatting.h"
#include "techniques/baselines/lighting.h"
#include "techniques/baselines/shadow_maps/light_maps.h"
#include "techniques/baselines/shadow_maps/map_shapes.h"
#include "techniques/baselines/shadow_maps/map_trace.h"

namespace sightlines::baselines {
namespace {

constexpr int paraboloids = 2;
constexpr std::uint64_t points_seed = 1;

constexpr std::array<Parameter, 8> parameters{{
    {"points", "Points per light", "", ParameterKind::integer, ParameterAffects::structure, 100, 200000, 11000, 11000,
     "Points of the surface that a light's maps are drawn from."},
    {"point_sets", "Sets of points", "", ParameterKind::integer, ParameterAffects::structure, 1, 256, 64, std::nullopt,
     "Different samples of the surface; each light draws one of them, so that lights do not err alike."},
    {"resolution", "Resolution", "texels", ParameterKind::integer, ParameterAffects::picture, 16, 512, 128, 128,
     "Texels along each side of a paraboloid; a point light has two."},
    {"splat_size", "Splat size", "", ParameterKind::real, ParameterAffects::picture, 0, 4, 0.7, std::nullopt,
     "Side of a point's splat, in sides of the square of surface that the point stands for."},
    {"most_texels", "Largest splat", "texels", ParameterKind::integer, ParameterAffects::picture, 1, 64, 8,
     std::nullopt, "Points near the light are drawn at most so wide."},
    {"fill_levels", "Pull-push levels", "", ParameterKind::integer, ParameterAffects::picture, 0, 9, 2, std::nullopt,
     "Coarser copies of a map that holes are filled from; each doubles the width of the holes that are filled."},
    {"normal_offset", "Offset along the normal", "texels", ParameterKind::real, ParameterAffects::picture, 0, 8, 0.25,
     std::nullopt, "How far a point is moved off its surface before it is looked up, in sizes of a texel and a splat."},
    {"bias", "Depth bias", "texels", ParameterKind::real, ParameterAffects::picture, 0, 8, 0.5, std::nullopt,
     "How much nearer to the light than the point a blocker must be, in sizes of a texel and a splat there."},
}};

struct SampledScene {
    PointSamples samples;
    Box3 bounds;
    float reach_m = 1.0f;
    double build_seconds = 0.0;
};
using SampledPointer = std::shared_ptr<const SampledScene>;

const SampledScene& sampled(const Structure& structure) { return *std::any_cast<const SampledPointer&>(structure); }

float value_of(const ParameterValues& values, std::string_view name) {
    return static_cast<float>(parameter_value(parameters, values, name));
}

SplatOptions splat_options(const ParameterValues& values) {
    SplatOptions options;
    options.size = value_of(values, "splat_size");
    options.most_texels = static_cast<int>(value_of(values, "most_texels"));
    options.fill_levels = static_cast<int>(value_of(values, "fill_levels"));
    return options;
}

MapOptions map_options(const SampledScene& scene, const ParameterValues& values) {
    return {static_cast<int>(value_of(values, "resolution")), value_of(values, "normal_offset"),
            value_of(values, "bias"), value_of(values, "splat_size") * scene.samples.side_m()};
}

/// Draws the maps of a few lights.
struct Maker {
    const SampledScene& scene;
    MapOptions options;
    SplatOptions splats;
    std::uint64_t seed;
    int threads;
    LightMaps& maps;
    const Progress& progress;

    void operator()(const LightByLight& picture, std::uint32_t first, std::uint32_t end) const {
        maps.first_light = first;
        parallel_for(end - first, threads, [&](std::int64_t k) {
            const std::uint32_t light = first + static_cast<std::uint32_t>(k);
            draw(picture.lights.records[light], light);
        });
    }

    void draw(const LightRecord& record, std::uint32_t light) const {
        progress.check();
        ShadowMapShape& shape = maps.shapes[light - maps.first_light];
        shape = map_shape(record, scene.bounds, options);
        const std::size_t used =
            static_cast<std::size_t>(imperfect_maps_of(shape)) * static_cast<std::size_t>(shape.map_pitch);
        const std::size_t sets = std::max<std::size_t>(scene.samples.sets, 1);
        PullPushScratch scratch;
        draw_imperfect_maps(scene.samples, random_u32(seed, light, 0) % sets, shape, splats, {maps.maps(light), used},
                            scratch);
    }
};

struct MapJudge {
    const LightMaps& maps;

    void operator()(const AskedLights&, std::uint32_t light, const RayBatch& batch, PackedVerdicts& verdicts) const {
        const ShadowMapShape shape = maps.shape(light);
        const wide::Reals numbers{maps.maps(light)};
        for (std::size_t k = 0; k < batch.vectors(); ++k)
            verdicts[k] =
                wide::bits_of(wide::is_in_imperfect_shadow(shape, numbers, batch.position(k), batch.normal(k)));
    }
};

Structure build(const BuildRequest& request, Progress& progress) {
    refuse_vulkan(request.backend, "imperfect_shadow_maps");
    const auto start = Clock::now();
    auto built = std::make_shared<SampledScene>();
    built->samples = sample_points(*request.scene, static_cast<std::size_t>(value_of(request.parameters, "points")),
                                   static_cast<std::size_t>(value_of(request.parameters, "point_sets")), points_seed,
                                   request.threads, progress);
    built->bounds = request.scene->bounds;
    built->reach_m = reach_m(*request.scene);
    built->build_seconds = seconds_since(start);
    return SampledPointer(std::move(built));
}

LightMaps maps_for(const MapOptions& options) {
    return LightMaps(lights_at_once(options.resolution, paraboloids), paraboloids, options.resolution);
}

RenderResult render(const Structure& structure, const RenderRequest& request, Progress& progress) {
    refuse_vulkan(request.backend, "imperfect_shadow_maps");
    const SampledScene& scene = sampled(structure);
    const MapOptions options = map_options(scene, request.parameters);
    LightMaps maps = maps_for(options);
    const Maker make{scene, options, splat_options(request.parameters), request.seed, request.threads, maps, progress};
    RenderResult result = render_lights(request, scene.reach_m, static_cast<std::uint32_t>(maps.shapes.size()), make,
                                        MapJudge{maps}, progress);
    result.device = cpu_device(request.threads, std::to_string(wide::lanes) + " wide");
    return result;
}

/// The maps of one light.
LightMaps maps_of_light(const SampledScene& scene, const TraceRequest& request, const SplatOptions& splats) {
    const MapOptions options = map_options(scene, request.parameters);
    LightMaps maps(1, paraboloids, options.resolution);
    const Progress progress;
    const Maker make{scene, options, splats, 1, 1, maps, progress};
    make.draw(light_record(request.light), 0);
    return maps;
}

Trace trace(const Structure& structure, const TraceRequest& request) {
    const SampledScene& scene = sampled(structure);
    const LightMaps maps = maps_of_light(scene, request, splat_options(request.parameters));
    return trace_map(maps.shapes[0], maps.maps(0), MapKind::imperfect, request, scene.reach_m);
}

Statistics statistics(const Structure& structure) {
    const SampledScene& scene = sampled(structure);
    Statistics statistics;
    statistics.structure_bytes = scene.samples.position[0].size() * 3 * sizeof(float);
    statistics.uncompressed_bytes = statistics.structure_bytes;
    statistics.build_seconds = scene.build_seconds;
    statistics.values = {{"points in a set", static_cast<double>(scene.samples.points), ""},
                         {"sets", static_cast<double>(scene.samples.sets), ""},
                         {"surface", scene.samples.area_m2, "m^2"},
                         {"side of a point's square", static_cast<double>(scene.samples.side_m()), "m"}};
    return statistics;
}

constexpr std::array<std::string_view, 4> stages{"points on the surface", "splats in paraboloids", "pull and push",
                                                 "look-ups"};

}  // namespace

const Technique& imperfect_shadow_maps() {
    static const Technique row{
        "imperfect_shadow_maps",
        "Imperfect shadow maps",
        "T. Ritschel, T. Grosch, M. H. Kim, H.-P. Seidel, C. Dachsbacher, J. Kautz: Imperfect Shadow Maps for "
        "Efficient Computation of Indirect Illumination. ACM TOG 27 (5), 2008",
        "Each light draws a few thousand points of the surface into two small paraboloid maps and fills their holes.",
        stages,
        parameters,
        build,
        render,
        trace,
        statistics,
        false};
    return row;
}

std::vector<LookedUpMap> looked_up_imperfect_maps(const Structure& structure, const TraceRequest& request,
                                                  const Trace& traced) {
    constexpr std::array<std::string_view, paraboloids> splatted{"points, front", "points, back"},
        filled{"filled, front", "filled, back"};
    const SampledScene& scene = sampled(structure);
    SplatOptions splats = splat_options(request.parameters);
    const LightMaps whole = maps_of_light(scene, request, splats);
    splats.fill_levels = 0;
    const LightMaps raw = maps_of_light(scene, request, splats);
    const auto used = static_cast<std::size_t>(imperfect_maps_of(whole.shapes[0]));
    std::vector<LookedUpMap> maps = maps_of_trace(raw.shapes[0], raw.maps(0), std::span(splatted).first(used), traced);
    std::ranges::move(maps_of_trace(whole.shapes[0], whole.maps(0), std::span(filled).first(used), traced),
                      std::back_inserter(maps));
    return maps;
}

QueryCount count_by_imperfect_shadow_maps(const Structure& structure, const RenderRequest& request) {
    refuse_vulkan(request.backend, "imperfect_shadow_maps");
    const SampledScene& scene = sampled(structure);
    const MapOptions options = map_options(scene, request.parameters);
    LightMaps maps = maps_for(options);
    const Progress progress;
    const Maker make{scene, options, splat_options(request.parameters), request.seed, request.threads, maps, progress};
    return count_lights(request, scene.reach_m, static_cast<std::uint32_t>(maps.shapes.size()), make, MapJudge{maps});
}

}  // namespace sightlines::baselines
