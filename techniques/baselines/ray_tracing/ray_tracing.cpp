// Brute force: every shadow ray by Embree.
#include <memory>

#include "shaders/wide.h"  // first: makes the kernels below wide

#include "techniques/baselines/baselines.h"
#include "techniques/baselines/lighting.h"
#include "techniques/baselines/ray_tracing/ray_trace.h"
#include "techniques/rays/packed_rays.h"

namespace sightlines::baselines {
namespace {

constexpr std::array<std::string_view, 4> variants{"single", "packets of 8", "packets of 16", "stream"};

constexpr std::array<Parameter, 1> parameters{{
    {"variant", "Rays together", "", ParameterKind::choice, ParameterAffects::picture, 0, 3, 2, std::nullopt,
     "How Embree is asked: ray by ray, in packets, or in a stream of packets.", variants},
}};

struct TracedScene {
    std::shared_ptr<const EmbreeScene> embree;
    float reach_m = 1.0f;
    std::vector<vec3> positions;  ///< of the scene, for traces
    std::vector<uvec3> triangles;
    double build_seconds = 0.0;
};
using TracedPointer = std::shared_ptr<const TracedScene>;

const TracedScene& traced(const Structure& structure) { return *std::any_cast<const TracedPointer&>(structure); }

EmbreeVariant variant_of(const ParameterValues& values) {
    return static_cast<EmbreeVariant>(static_cast<int>(parameter_value(parameters, values, "variant")));
}

struct EmbreeJudge {
    const EmbreeScene& embree;
    EmbreeVariant variant;

    void operator()(const AskedLights& lights, std::uint32_t light, const RayBatch& batch,
                    PackedVerdicts& verdicts) const {
        const auto& numbers = batch.numbers;
        const PackedSurfaces surfaces{{numbers[0].data(), numbers[1].data(), numbers[2].data()},
                                      {numbers[3].data(), numbers[4].data(), numbers[5].data()},
                                      batch.rays};
        are_occluded(embree, variant, lights.records[light], surfaces, wide::lanes, verdicts);
    }
};

Structure build(const BuildRequest& request, Progress& progress) {
    refuse_vulkan(request.backend, "ray_tracing");
    const auto start = Clock::now();
    auto built = std::make_shared<TracedScene>();
    built->embree = build_embree_scene(*request.scene, EmbreeUse::benchmark, request.threads, progress);
    built->reach_m = reach_m(*request.scene);
    built->positions = request.scene->positions;
    built->triangles = request.scene->triangles;
    built->build_seconds = seconds_since(start);
    return TracedPointer(std::move(built));
}

RenderResult render(const Structure& structure, const RenderRequest& request, Progress& progress) {
    refuse_vulkan(request.backend, "ray_tracing");
    const TracedScene& scene = traced(structure);
    const EmbreeVariant variant = variant_of(request.parameters);
    RenderResult result = render_tiles(request, scene.reach_m, EmbreeJudge{*scene.embree, variant}, progress);
    result.rays_traced = result.rays;
    result.device = cpu_device(request.threads, "Embree, " + std::string(variants[static_cast<std::size_t>(variant)]));
    return result;
}

/// The triangle in the ray's way that is nearest to the light.
std::optional<std::array<vec3, 3>> blocker(const TracedScene& scene, const Segment& ray, vec3 normal) {
    if (!occluded(*scene.embree, ray, normal)) return std::nullopt;
    const vec3 way = ray.origin - ray.target;
    const auto hit = closest_hit(*scene.embree, ray.target, glm::normalize(way), glm::length(way));
    if (!hit) return std::nullopt;
    const uvec3 corners = scene.triangles[hit->triangle];
    return std::array{scene.positions[corners.x], scene.positions[corners.y], scene.positions[corners.z]};
}

Trace trace(const Structure& structure, const TraceRequest& request) {
    const TracedScene& scene = traced(structure);
    const Segment ray = asked_ray(request, scene.reach_m);
    Trace trace = trace_triangle(ray, blocker(scene, ray, request.normal));
    trace.blocked = occluded(*scene.embree, ray, request.normal);
    return trace;
}

Statistics statistics(const Structure& structure) {
    const TracedScene& scene = traced(structure);
    Statistics statistics;
    statistics.build_seconds = scene.build_seconds;
    statistics.values = {{"triangles", static_cast<double>(scene.triangles.size()), ""}};
    return statistics;
}

constexpr std::array<std::string_view, 2> stages{"bounding volume hierarchy", "shadow rays"};

}  // namespace

const Technique& ray_tracing() {
    static const Technique row{
        "ray_tracing",
        "Ray tracing",
        "I. Wald, S. Woop, C. Benthin, G. S. Johnson, M. Ernst: Embree: A Kernel Framework for Efficient CPU Ray "
        "Tracing. ACM TOG 33 (4), 2014",
        "Every shadow ray against the triangles themselves, by Embree's hierarchy of boxes.",
        stages,
        parameters,
        build,
        render,
        trace,
        statistics,
        false};
    return row;
}

QueryCount count_by_ray_tracing(const Structure& structure, const RenderRequest& request) {
    refuse_vulkan(request.backend, "ray_tracing");
    return count_blocked(*traced(structure).embree, variant_of(request.parameters), *request.surfaces, request.lights,
                         request.threads);
}

}  // namespace sightlines::baselines
