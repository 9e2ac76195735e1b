#include "techniques/visibility_field/visibility_field.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <chrono>
#include <numeric>

#include "techniques/base/error.h"
#include "techniques/base/parallel.h"
#include "techniques/scene/moving_parts.h"
#include "techniques/visibility_field/area_lights.h"
#include "techniques/visibility_field/denoise.h"
#include "techniques/visibility_field/irradiance_cache.h"
#include "techniques/visibility_field/one_bounce.h"
#include "techniques/visibility_field/weighted_samples.h"

namespace sightlines::visibility_field {
namespace {

constexpr std::array<std::string_view, 2> placements{"random", "stratified"};
constexpr std::array<std::string_view, 2> label_rules{"texels", "smaller"};
constexpr std::array<std::string_view, 2> layouts{"packed", "dense"};
constexpr std::array<std::string_view, 3> cullings{"label", "visible", "both"};
constexpr std::array<std::string_view, 2> unshadowed_ways{"analytic", "sampled"};
constexpr std::array<std::string_view, 2> ray_orders{"pixel", "direction"};

constexpr std::array<std::string_view, 2> surface_kinds{"diffuse", "glossy"};
constexpr std::array<std::string_view, 4> samplings{"cosine", "brdf", "map", "both"};
constexpr std::array<std::string_view, 2> light_sources{"harmonics", "map"};
constexpr std::array<std::string_view, 2> indirect_ways{"off", "once"};

constexpr std::array<Parameter, 23> parameters{{
    {"cell_size", "Cell size", "m", ParameterKind::real, ParameterAffects::structure, 0.01, 1000, 0.5, 0.5,
     "Side of a cell of the grid."},
    {"mask_size", "Mask size", "texels", ParameterKind::integer, ParameterAffects::structure, 8, 64, 18, 18,
     "Along each side of a cell's two octahedral masks."},
    {"points", "Point samples", "", ParameterKind::integer, ParameterAffects::structure, 1000, 10000000, 4000000,
     std::nullopt, "Points of the surface from which rays are cast into the masks."},
    {"rays_per_point", "Rays per point", "", ParameterKind::integer, ParameterAffects::structure, 1, 4096, 64,
     std::nullopt, "Cast from each point sample, over the hemisphere."},
    {"probes", "Rays at rims", "", ParameterKind::integer, ParameterAffects::structure, 0, 4096, 128, 0,
     "In place of dilation, into each texel beside those that a cell's masks have set; one from each of its points if "
     "those are more. 0: masks are dilated, as always in scenes that move."},
    {"dilation", "Dilation", "texels", ParameterKind::real, ParameterAffects::structure, 0, 2, 0.33, 1,
     "By how much both masks grow where no rays are spent at their rims, so that directions between the rays count "
     "too; "
     "in steps of a third of a texel for masks of 18."},
    {"area_rays", "Rays to area lights", "", ParameterKind::integer, ParameterAffects::structure, 0, 4096, 0, 0,
     "Cast from each side of a cell to each part of the surfaces that shine by themselves, so that segments to it need "
     "no ray where they agree. 0: all are traced, as always in scenes that move."},
    {"placement", "Placement", "", ParameterKind::choice, ParameterAffects::structure, 0, 1, 1, 0,
     "Where point samples lie: at random by area, as in the paper, or spread so that every cell and triangle has its "
     "share.",
     placements},
    {"label_rule", "Label rule", "", ParameterKind::choice, ParameterAffects::structure, 0, 1, 1, 0,
     "A cell is called occluded where more than half of its texels are (equation 8), or where the visible region is "
     "the smaller one.",
     label_rules},
    {"layout", "Memory layout", "", ParameterKind::choice, ParameterAffects::structure, 0, 1, 0, 1,
     "Two bits a texel for the cells that hold points, or the paper's: a byte a texel for all cells. The answers are "
     "the same.",
     layouts},
    {"samples", "Samples per pixel", "", ParameterKind::integer, ParameterAffects::picture, 16, 256, 64, std::nullopt,
     "Directions that each pixel asks, cosine-weighted about its normal."},
    {"culling", "Rays traced", "", ParameterKind::choice, ParameterAffects::picture, 0, 2, 0, 0,
     "Those in the region that the cell's label names, those in the visible region (Figure 9), or those on which the "
     "cell's points disagree.",
     cullings},
    {"unshadowed", "Unshadowed light", "", ParameterKind::choice, ParameterAffects::picture, 0, 1, 1, 0,
     "What blocked light is taken off where the occluded region is traced: the exact irradiance, as in the paper, or "
     "that of the same samples.",
     unshadowed_ways},
    {"surface", "Surfaces", "", ParameterKind::choice, ParameterAffects::picture, 0, 1, 0, 0,
     "All reflect evenly, or each by its material's roughness and metalness; labels are then ignored and visible "
     "regions traced (Figure 10).",
     surface_kinds},
    {"roughness", "Roughness", "", ParameterKind::real, ParameterAffects::picture, 0, 1, 0, std::nullopt,
     "Of all glossy surfaces; 0 leaves each material its own."},
    {"sampling", "Sampling", "", ParameterKind::choice, ParameterAffects::picture, 0, 3, 0, 0,
     "Samples are drawn by the cosine, by what the surface reflects, by the map of the surroundings, or half by the "
     "map and half by the surface.",
     samplings},
    {"light_from", "Light from", "", ParameterKind::choice, ParameterAffects::picture, 0, 1, 0, 0,
     "The surroundings as harmonics of order 3, or the map itself with all its contrasts.", light_sources},
    {"indirect", "Indirect light", "", ParameterKind::choice, ParameterAffects::picture, 0, 1, 0, 0,
     "Light of the surroundings by way of one other surface: what a blocked sample hits is lit by a ray of its own, "
     "which the masks of the cell that is hit cull.",
     indirect_ways},
    {"area_samples", "Area lights", "samples", ParameterKind::integer, ParameterAffects::picture, 0, 256, 0, 0,
     "That each pixel draws on the scene's surfaces that shine by themselves; 0: these light nothing."},
    {"cache_spacing", "Irradiance cache", "pixels", ParameterKind::integer, ParameterAffects::picture, 0, 16, 0, 0,
     "The coarsest distance between pixels that are asked, rounded down to a power of two; those between are "
     "interpolated where plane, normal and light agree. 0: all are asked, as glossy surfaces always are."},
    {"cache_tolerance", "Cache tolerance", "%", ParameterKind::real, ParameterAffects::picture, 0, 100, 10,
     std::nullopt,
     "How much the brightness of asked pixels, the square root of their irradiance, may differ for others to be "
     "interpolated between them, in percent of that of unshadowed surfaces."},
    {"denoise", "Denoising", "passes", ParameterKind::integer, ParameterAffects::picture, 0, most_denoising_passes, 0,
     0, "Passes of a filter that takes noise out of the irradiance and keeps edges; 0: none."},
    {"ray_order", "Order of rays", "", ParameterKind::choice, ParameterAffects::picture, 0, 1, 1, 0,
     "Embree gets the rays pixel by pixel, or those of a few hundred pixels sorted by direction.", ray_orders},
}};

constexpr std::array<std::string_view, 5> stages{"point samples", "masks", "grid of cells", "samples",
                                                 "rays that are left"};

using BuiltFieldPointer = std::shared_ptr<const BuiltField>;
using PatternPointer = std::shared_ptr<const SamplePattern>;

double value_of(const ParameterValues& chosen, std::string_view name) {
    return parameter_value(parameters, chosen, name);
}

template <class Choice>
Choice choice_of(const ParameterValues& chosen, std::string_view name) {
    return static_cast<Choice>(static_cast<int>(value_of(chosen, name)));
}

std::string cpu_device(int threads) {
    return "CPU, " + std::to_string(thread_count(threads)) + " threads, Embree, packets of 16";
}

BakeOptions bake_options(const BuildRequest& request) {
    const ParameterValues& chosen = request.parameters;
    BakeOptions options;
    options.cell_m = static_cast<float>(value_of(chosen, "cell_size"));
    options.mask_size = static_cast<int>(value_of(chosen, "mask_size"));
    options.points = static_cast<std::uint32_t>(value_of(chosen, "points"));
    options.rays = static_cast<int>(value_of(chosen, "rays_per_point"));
    options.probes = static_cast<int>(value_of(chosen, "probes"));
    options.dilation = static_cast<float>(value_of(chosen, "dilation"));
    options.placement = choice_of<Placement>(chosen, "placement");
    options.label = choice_of<LabelRule>(chosen, "label_rule");
    options.threads = request.threads;
    return options;
}

/// Of a scene that moves, what all its moments share: `kept` where that serves. Null where nothing moves.
std::shared_ptr<const FixedField> fixed_field(const Scene& scene, const BakeOptions& options, const std::any& kept,
                                              Progress& progress) {
    if (!anything_moves(scene)) return nullptr;
    const auto* held = std::any_cast<std::shared_ptr<const FixedField>>(&kept);
    return held != nullptr && serves(**held, scene, options) ? *held : bake_fixed(scene, options, progress);
}

std::any kept(const Structure& structure) {
    const BuiltField& built = built_field(structure);
    return built.fixed ? std::any(built.fixed) : std::any();
}

Structure build(const BuildRequest& request, Progress& progress) {
    check_parameters(parameters, request.parameters);
    const auto start = std::chrono::steady_clock::now();
    const Scene& scene = *request.scene;
    auto built = std::make_shared<BuiltField>();
    built->options = bake_options(request);
    check_bake(scene, built->options);
    built->fixed = fixed_field(scene, built->options, request.kept, progress);
    built->embree = built->fixed ? build_moment_tree(scene, built->fixed->embree, request.threads, progress)
                                 : build_embree_scene(scene, EmbreeUse::benchmark, request.threads, progress);
    built->field = built->fixed
                       ? bake_moment(*built->fixed, scene, *built->embree, built->options, progress, &built->points)
                       : bake(scene, *built->embree, built->options, progress, &built->points);
    if (!built->fixed)
        built->area_sight = bake_area_sight(scene, built->field, *built->embree, built->points,
                                            {.rays = static_cast<int>(value_of(request.parameters, "area_rays")),
                                             .seed = built->options.seed,
                                             .threads = request.threads},
                                            progress);
    if (value_of(request.parameters, "layout") != 0.0) built->dense = to_dense(built->field);
    if (request.backend == Backend::vulkan)
        built->on_device = give_to_vulkan(&built->field, *built->embree, request.threads, progress);
    built->build_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return BuiltFieldPointer(std::move(built));
}

PatternPointer new_pattern(const ParameterValues& chosen, std::uint64_t seed) {
    return std::make_shared<const SamplePattern>(make_pattern(static_cast<int>(value_of(chosen, "samples")), seed));
}

PatternPointer pattern_of(const RenderRequest& request) {
    return request.samples != nullptr ? std::any_cast<PatternPointer>(*request.samples)
                                      : new_pattern(request.parameters, request.seed);
}

/// The light, how it is drawn, and which rays are traced.
EnvironmentRequest light_request(const ParameterValues& chosen, const EnvironmentLight& environment) {
    EnvironmentRequest asked;
    asked.light = environment.harmonics;
    if (value_of(chosen, "light_from") != 0.0) asked.map = &environment;
    asked.sampling = choice_of<Sampling>(chosen, "sampling");
    if (asked.sampling == Sampling::map || asked.sampling == Sampling::both)
        asked.distribution = &environment.distribution;
    asked.culling = culling_of(chosen);
    return asked;
}

EnvironmentRequest environment_request(const RenderRequest& request, const SamplePattern& pattern) {
    assert(request.environment != nullptr);
    EnvironmentRequest asked = light_request(request.parameters, *request.environment);
    asked.surfaces = request.surfaces;
    asked.pattern = &pattern;
    asked.unshadowed = choice_of<Unshadowed>(request.parameters, "unshadowed");
    asked.order = choice_of<RayOrder>(request.parameters, "ray_order");
    asked.glossy = value_of(request.parameters, "surface") != 0.0;
    asked.roughness = static_cast<float>(value_of(request.parameters, "roughness"));
    asked.threads = request.threads;
    asked.reverse_tiles = request.reverse_tiles;
    asked.keep_verdicts = request.keep_verdicts;
    return asked;
}

/// A picture that shows the surroundings where it shows no surface.
RenderResult background(const RenderRequest& request) {
    const SurfaceBuffer& surfaces = *request.surfaces;
    const ImageSize size = surfaces.size;
    RenderResult result;
    result.radiance = ImageRgb(size);
    result.shadow = ImageScalar(size);
    result.rays_asked = Image<std::uint32_t>(size);
    result.traced = Image<std::uint32_t>(size);
    parallel_for(size.height, request.threads, [&](std::int64_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < size.width; ++x) {
            const auto pixel =
                static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width) + static_cast<std::size_t>(x);
            if (surfaces.triangle[pixel] != no_triangle) continue;
            const Segment ray = camera_ray(surfaces.camera, size, vec2(x, y) + 0.5f, 1.0f);
            result.radiance.pixels[pixel] =
                radiance_from(*request.environment, glm::normalize(ray.target - ray.origin));
        }
    });
    return result;
}

/// Takes the surfaces of a part over. Harmonics ring: where their sum is negative there is no light.
void take_over(const EnvironmentResult& from, const SurfaceBuffer& surfaces, PixelRect rect, RenderResult& result) {
    for (int y = rect.y; y < rect.y + rect.height; ++y) {
        for (int x = rect.x; x < rect.x + rect.width; ++x) {
            const auto pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(surfaces.size.width) +
                               static_cast<std::size_t>(x);
            if (surfaces.triangle[pixel] == no_triangle) continue;
            result.radiance.pixels[pixel] = glm::max(from.radiance.pixels[pixel], vec3(0.0f));
            result.shadow.pixels[pixel] = from.shadow.pixels[pixel];
            result.rays_asked.pixels[pixel] = from.rays_asked.pixels[pixel];
            result.traced.pixels[pixel] = from.rays_traced.pixels[pixel];
        }
    }
}

/// The irradiance of glossy surfaces is what they reflect, texture and all: without about its colour it is as smooth as
/// that of others.
void set_colour(const EnvironmentRequest& asked, bool with, ImageRgb& irradiance) {
    if (!asked.glossy) return;
    for (std::size_t p = 0; p < irradiance.pixels.size(); ++p) {
        if (asked.surfaces->triangle[p] == no_triangle) continue;
        const vec3 colour = reflecting_colour(asked, p);
        irradiance.pixels[p] = with ? irradiance.pixels[p] * colour : irradiance.pixels[p] / colour;
    }
}

void denoise_picture(const EnvironmentRequest& asked, int passes, EnvironmentResult& made) {
    if (passes == 0) return;
    const auto start = std::chrono::steady_clock::now();
    set_colour(asked, false, made.irradiance);
    denoise(*asked.surfaces, passes, asked.threads, made.irradiance);
    set_colour(asked, true, made.irradiance);
    for (std::size_t p = 0; p < made.radiance.pixels.size(); ++p)
        if (asked.surfaces->triangle[p] != no_triangle)
            made.radiance.pixels[p] = reflected_radiance(asked, p, made.irradiance.pixels[p]);
    made.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

RenderResult render_samples(const RenderRequest& request, const DenseField* dense, const Renderer& make) {
    const PatternPointer pattern = pattern_of(request);
    const SurfaceBuffer& surfaces = *request.surfaces;
    RenderResult result = background(request);
    EnvironmentRequest asked = environment_request(request, *pattern);
    asked.dense = dense;
    if (request.on_region)
        asked.on_region = [&](const EnvironmentResult& so_far, PixelRect changed) {
            take_over(so_far, surfaces, changed, result);
            request.on_region(result, changed);
        };
    EnvironmentResult made = make(asked);
    denoise_picture(asked, static_cast<int>(value_of(request.parameters, "denoise")), made);
    take_over(made, surfaces, {0, 0, surfaces.size.width, surfaces.size.height}, result);
    result.verdicts = std::move(made.verdicts);
    for (const SampleCounts& asked_too : {made.second_rays, made.area_rays}) add(made.counts, asked_too);
    result.rays = made.counts.samples - made.counts.below;
    result.rays_traced = made.counts.traced;
    result.seconds = made.seconds;
    result.device = made.device;
    return result;
}

/// The same with indirect light where the request asks for it.
Renderer with_indirect(const VisibilityField* field, const EmbreeScene& embree, const RenderRequest& request,
                       Progress& progress, Renderer make) {
    if (value_of(request.parameters, "indirect") == 0.0) return make;
    assert(request.scene != nullptr);
    return [=, &embree, &progress, scene = request.scene](const EnvironmentRequest& asked) {
        return with_one_bounce(field, embree, *scene, asked, make, progress);
    };
}

/// The same with local area lights where the request asks for them. `built` null: every segment is traced.
Renderer with_area_lights(const BuiltField* built, const EmbreeScene& embree, const RenderRequest& request,
                          Progress& progress, Renderer make) {
    const auto samples = static_cast<int>(value_of(request.parameters, "area_samples"));
    if (samples == 0) return make;
    assert(request.scene != nullptr);
    const auto lights = std::make_shared<const AreaLights>(find_area_lights(*request.scene));
    return [=, &embree, &progress, scene = request.scene](const EnvironmentRequest& asked) {
        EnvironmentResult made = make(asked);
        add_area_lights(built != nullptr ? &built->field : nullptr, built != nullptr ? &built->area_sight : nullptr,
                        embree, *scene, *lights, asked, samples, made, progress);
        return made;
    };
}

/// All that goes on from what `make` gives.
Renderer with_more_light(const BuiltField* built, const EmbreeScene& embree, const RenderRequest& request,
                         Progress& progress, const Renderer& make) {
    return with_area_lights(built, embree, request, progress,
                            with_indirect(built != nullptr ? &built->field : nullptr, embree, request, progress, make));
}

/// The same, of few pixels, where the request asks for a cache.
Renderer with_cache(const RenderRequest& request, Renderer make) {
    const CacheOptions options{static_cast<int>(value_of(request.parameters, "cache_spacing")),
                               static_cast<float>(value_of(request.parameters, "cache_tolerance") / 100.0)};
    if (options.spacing == 0) return make;
    return [=](const EnvironmentRequest& asked) { return render_cached(options, asked, make); };
}

RenderResult render(const Structure& structure, const RenderRequest& request, Progress& progress) {
    const BuiltField& built = built_field(structure);
    const auto painted = [&](const DenseField* dense, const Renderer& make) {
        return render_samples(request, dense,
                              with_cache(request, with_more_light(&built, *built.embree, request, progress, make)));
    };
    if (request.backend == Backend::vulkan) {
        const std::shared_ptr<const FieldOnDevice> device =
            built.on_device ? built.on_device : give_to_vulkan(&built.field, *built.embree, request.threads, progress);
        return painted(nullptr,
                       [&](const EnvironmentRequest& asked) { return render_on_vulkan(*device, asked, progress); });
    }
    RenderResult result = painted(built.dense ? &*built.dense : nullptr, [&](const EnvironmentRequest& asked) {
        return render_environment(&built.field, *built.embree, asked, progress);
    });
    result.device = cpu_device(request.threads);
    return result;
}

RenderResult reference(const EmbreeScene& embree, const RenderRequest& request, Progress& progress) {
    RenderResult result = render_samples(
        request, nullptr, with_more_light(nullptr, embree, request, progress, [&](const EnvironmentRequest& asked) {
            return render_environment(nullptr, embree, asked, progress);
        }));
    result.device = cpu_device(request.threads);
    return result;
}

std::vector<Light> as_lights(const std::vector<PixelSample>& samples) {
    std::vector<Light> all(samples.size());
    for (std::size_t k = 0; k < all.size(); ++k) {
        all[k].kind = LightKind::directional;
        all[k].direction = -samples[k].direction;
        all[k].intensity = samples[k].adds;
    }
    return all;
}

std::vector<Light> lights(const RenderRequest& request, std::size_t pixel) {
    const PatternPointer pattern = pattern_of(request);
    const EnvironmentRequest asked = environment_request(request, *pattern);
    if (is_weighted(asked)) return as_lights(weighted_samples(asked, pixel));
    std::vector<Light> all(static_cast<std::size_t>(pattern->samples));
    for (std::size_t k = 0; k < all.size(); ++k) {
        const SampleRay ray = sample_ray(asked, pixel, static_cast<int>(k));
        all[k].kind = LightKind::directional;
        all[k].direction = -ray.direction;
        all[k].intensity = ray.share;
    }
    return all;
}

std::string metres_text(float metres) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g m", static_cast<double>(metres));
    return text;
}

/// For a ray that was discarded wrongly: which sample should have kept it.
void add_nearest(const BuiltField& built, const SampleTrace& traced, TraceStep& step) {
    const NearestSamples nearest = nearest_samples(samples_of(built, traced.cell), *built.embree, traced);
    const double infinite = std::numeric_limits<double>::infinity();
    step.values.push_back({"samples in the cell", static_cast<std::int64_t>(nearest.points), ""});
    step.values.push_back({"nearest sample", nearest.points > 0 ? double{nearest.nearest_m} : infinite, "m"});
    step.sentence +=
        " This ray should have been traced. The nearest point sample is " + metres_text(nearest.nearest_m) + " away";
    if (!nearest.should_have_seen) {
        step.sentence += ", and no sample of the cell would have answered as Embree does.";
        return;
    }
    step.values.push_back({"sample that sees it", double{nearest.should_have_seen_m}, "m"});
    step.sentence += ", and one " + metres_text(nearest.should_have_seen_m) +
                     " away would have kept it, had it cast a ray in this direction.";
    step.geometry.push_back({"sample", TraceShape::point, {nearest.should_have_seen->position}});
}

Trace trace(const Structure& structure, const TraceRequest& request) {
    const BuiltField& built = built_field(structure);
    const SampleRay ray{request.position, request.normal, -request.light.direction, request.light.intensity};
    SampleTrace traced = trace_sample(built.field, *built.embree, culling_of(request.parameters), ray);
    if (traced.is_wrong() && !traced.trace.steps.empty()) add_nearest(built, traced, traced.trace.steps.back());
    if (value_of(request.parameters, "indirect") != 0.0 && traced.trace.blocked && traced.fate != Fate::below_surface)
        add_second_ray(built.field, *built.embree, *request.scene,
                       light_request(request.parameters, *request.environment), request.seed, ray, traced);
    return std::move(traced.trace);
}

Statistics statistics(const Structure& structure) {
    const BuiltField& built = built_field(structure);
    const VisibilityField& field = built.field;
    const FieldShape& shape = field.shape;
    const std::vector<OccupiedCell> cells = occupied_cells(field);
    const auto occluded = std::ranges::count(cells, 1u, &OccupiedCell::label);
    const double count = std::max(1.0, static_cast<double>(cells.size()));
    const auto distinct = field.mask_numbers.empty() ? 0u : 1u + std::ranges::max(field.mask_numbers);
    Statistics statistics;
    statistics.uncompressed_bytes = dense_bytes(shape);
    statistics.structure_bytes = built.dense ? statistics.uncompressed_bytes : field.bytes();
    statistics.build_seconds = built.build_seconds;
    statistics.values = {{"cells of the grid", static_cast<double>(shape.cells_x) * shape.cells_y * shape.cells_z, ""},
                         {"cells with masks", static_cast<double>(cells.size()), ""},
                         {"cells called occluded", 100.0 * static_cast<double>(occluded) / count, "%"},
                         {"cells called visible",
                          100.0 * (static_cast<double>(cells.size()) - static_cast<double>(occluded)) / count, "%"},
                         {"point samples", static_cast<double>(field.points), ""},
                         {"rays cast", static_cast<double>(field.rays), ""},
                         {"placing the samples", field.place_seconds, "s"},
                         {"casting the rays", field.cast_seconds, "s"},
                         {"masks that are copies of others",
                          2.0 * static_cast<double>(cells.size()) - static_cast<double>(distinct), ""},
                         {"bytes packed", static_cast<double>(field.bytes()), "B"},
                         {"bytes in the paper's layout", static_cast<double>(dense_bytes(shape)), "B"}};
    if (built.fixed) {
        statistics.values.push_back(
            {"cells with the masks of what stands still", static_cast<double>(field.kept_cells), ""});
        statistics.values.push_back({"rays cast for this moment", static_cast<double>(field.rays_again), ""});
        statistics.values.push_back({"baking what stands still, once", built.fixed->seconds, "s"});
    }
    if (built.area_sight.words > 0) {
        statistics.structure_bytes += built.area_sight.bytes();
        statistics.values.push_back(
            {"what cells know of area lights", static_cast<double>(built.area_sight.bytes()), "B"});
        statistics.values.push_back({"finding that out", built.area_sight.seconds, "s"});
    }
    if (built.on_device) {
        const auto [rays, bytes] = rays_used(*built.on_device);
        const bool queries = rays == DeviceRays::queries;
        statistics.values.push_back(
            {queries ? "acceleration structure, asked by ray queries" : "ray tree on the device",
             static_cast<double>(bytes), "B"});
    }
    return statistics;
}

constexpr EnvironmentLit environment{
    [](const ParameterValues& chosen) { return static_cast<std::uint32_t>(value_of(chosen, "samples")); },
    [](const ParameterValues& chosen, std::uint64_t seed) { return std::any(new_pattern(chosen, seed)); },
    lights,
    reference,
};

constexpr Technique row{
    "visibility_field",
    "Visibility field",
    "Y. Xu, Y. Jiang, C. Wang, K. Li, P. Zhou, G. Geng: Precomputed Discrete Visibility Fields for Real-Time "
    "Ray-Traced Environment Lighting. 2022",
    "Each cell of a grid knows in which directions its surfaces see the sky; rays whose answer it knows are not "
    "traced.",
    stages,
    parameters,
    build,
    render,
    trace,
    statistics,
    true,
    kept,
    &environment};

}  // namespace

const Technique& technique() { return row; }

const BuiltField& built_field(const Structure& structure) {
    return *std::any_cast<const BuiltFieldPointer&>(structure);
}

CellPoints samples_of(const BuiltField& built, ivec3 place) {
    return samples_in(built.field.shape, place, built.points, built.fixed ? &built.fixed->points : nullptr);
}

Culling culling_of(const ParameterValues& chosen) {
    EnvironmentRequest asked;
    asked.culling = choice_of<Culling>(chosen, "culling");
    asked.glossy = value_of(chosen, "surface") != 0.0;
    return culling_used(asked);
}

}  // namespace sightlines::visibility_field
