// Conventional shadow maps: the technique's row in the catalog, and Algorithm 4 with a map for each light.
#include <memory>

#include "shaders/wide.h"  // first: makes the kernels below wide

#include "shaders/shadow_map.h"
#include "techniques/baselines/baselines.h"
#include "techniques/baselines/lighting.h"
#include "techniques/baselines/shadow_maps/light_maps.h"
#include "techniques/baselines/shadow_maps/map_shapes.h"
#include "techniques/baselines/shadow_maps/map_trace.h"
#include "techniques/baselines/shadow_maps/rasterizer.h"

namespace sightlines::baselines {
namespace {

constexpr int cube_faces = 6;

constexpr std::array<Parameter, 3> parameters{{
    {"resolution", "Resolution", "texels", ParameterKind::integer, ParameterAffects::picture, 16, 1024, 128, 128,
     "Texels along each side of a face of a light's cube. The paper takes, scene by scene, 36 to 384 to match its "
     "errors."},
    {"normal_offset", "Offset along the normal", "texels", ParameterKind::real, ParameterAffects::picture, 0, 8, 0.4,
     std::nullopt, "How far a point is moved off its surface before it is looked up, in sizes of a texel there."},
    {"bias", "Depth bias", "texels", ParameterKind::real, ParameterAffects::picture, 0, 8, 0.4, std::nullopt,
     "How much nearer to the light than the point a blocker must be, in sizes of a texel there."},
}};

struct CasterTriangles {
    TriangleClusters clusters;
    Box3 bounds;
    float reach_m = 1.0f;
    double build_seconds = 0.0;
};
using CasterPointer = std::shared_ptr<const CasterTriangles>;

const CasterTriangles& casters(const Structure& structure) { return *std::any_cast<const CasterPointer&>(structure); }

MapOptions map_options(const ParameterValues& values) {
    const auto value = [&](std::string_view name) { return parameter_value(parameters, values, name); };
    return {static_cast<int>(value("resolution")), static_cast<float>(value("normal_offset")),
            static_cast<float>(value("bias")), 0.0f};
}

int maps_of(const ShadowMapShape& shape) { return shape.directional != 0 ? 1 : cube_faces; }

/// Adds the texels that some places look up, map by map.
HWY_INLINE void add_places(const ShadowMapShape& shape, const wide::MapPlace& place, wide::Mask asked,
                           std::array<MapRect, cube_faces>& rects) {
    const wide::Int column = wide::texel_index(shape, place.x), line = wide::texel_index(shape, place.y);
    const wide::IntTag tag;
    for (int map = 0; map < maps_of(shape); ++map) {
        const wide::Mask here = asked && place.map == wide::splat(map);
        if (!wide::any_lane(here)) continue;
        const auto lowest = [&](wide::Int x) {
            return wide::hn::GetLane(wide::hn::MinOfLanes(tag, wide::select(here, x, wide::splat(1 << 20)).v));
        };
        const auto highest = [&](wide::Int x) {
            return wide::hn::GetLane(wide::hn::MaxOfLanes(tag, wide::select(here, x, wide::splat(-1)).v));
        };
        rects[static_cast<std::size_t>(map)].add({lowest(column), lowest(line), highest(column), highest(line)});
    }
}

/// The texels of the light's maps that the picture's pixels will look up: no others need to be drawn.
std::array<MapRect, cube_faces> receiver_rects(const LightByLight& picture, std::uint32_t light,
                                               const ShadowMapShape& shape, const Progress* progress) {
    std::array<MapRect, cube_faces> rects{};
    const LightRecord& record = picture.lights.records[light];
    for (const Tile& tile : picture.tiles) {
        if (progress != nullptr) progress->check();
        for (std::size_t start = 0; start < tile.pixels.pixel.size(); start += wide::lanes) {
            const wide::Vec3 position = detail::load_three(tile.pixels.position, start);
            const wide::Vec3 normal = detail::load_three(tile.pixels.normal, start);
            const wide::Mask asked = wide::is_asked(normal, wide::to_light(record, position, picture.lights.reach_m));
            if (wide::any_lane(asked)) add_places(shape, wide::looked_up_place(shape, position, normal), asked, rects);
        }
    }
    return rects;
}

/// The maps of the lights at hand, and how they are made.
struct Maker {
    const CasterTriangles& triangles;
    MapOptions options;
    int threads;
    LightMaps& maps;
    const Progress& progress;

    void operator()(const LightByLight& picture, std::uint32_t first, std::uint32_t end) const {
        maps.first_light = first;
        const std::size_t count = end - first;
        std::vector<std::array<MapRect, cube_faces>> rects(count);
        parallel_for(static_cast<std::int64_t>(count), threads, [&](std::int64_t index) {
            const auto k = static_cast<std::size_t>(index);
            const std::uint32_t light = first + static_cast<std::uint32_t>(k);
            maps.shapes[k] = map_shape(picture.lights.records[light], triangles.bounds, options);
            rects[k] = receiver_rects(picture, light, maps.shapes[k], &progress);
        });
        parallel_for(static_cast<std::int64_t>(count * cube_faces), threads, [&](std::int64_t task) {
            const std::size_t k = static_cast<std::size_t>(task) / cube_faces;
            const std::size_t face = static_cast<std::size_t>(task) % cube_faces;
            draw(first + static_cast<std::uint32_t>(k), static_cast<int>(face), rects[k][face]);
        });
    }

    void draw(std::uint32_t light, int face, const MapRect& rect) const {
        const ShadowMapShape& shape = maps.shape(light);
        if (face >= maps_of(shape)) return;
        float* numbers = maps.maps(light) + static_cast<std::ptrdiff_t>(face) * shape.map_pitch;
        rasterize(triangles.clusters, shape, face, rect, {numbers, static_cast<std::size_t>(shape.map_pitch)},
                  progress);
    }
};

struct MapJudge {
    const LightMaps& maps;

    void operator()(const AskedLights&, std::uint32_t light, const RayBatch& batch, PackedVerdicts& verdicts) const {
        const ShadowMapShape shape = maps.shape(light);
        const wide::Reals numbers{maps.maps(light)};
        for (std::size_t k = 0; k < batch.vectors(); ++k)
            verdicts[k] = wide::bits_of(wide::is_in_shadow(shape, numbers, batch.position(k), batch.normal(k)));
    }
};

Structure build(const BuildRequest& request, Progress& progress) {
    refuse_vulkan(request.backend, "shadow_maps");
    const auto start = Clock::now();
    auto built = std::make_shared<CasterTriangles>();
    built->clusters = make_clusters(*request.scene, progress);
    built->bounds = request.scene->bounds;
    built->reach_m = reach_m(*request.scene);
    built->build_seconds = seconds_since(start);
    return CasterPointer(std::move(built));
}

/// Memory for the maps of a few lights.
LightMaps maps_for(const MapOptions& options) {
    return LightMaps(lights_at_once(options.resolution, cube_faces), cube_faces, options.resolution);
}

RenderResult render(const Structure& structure, const RenderRequest& request, Progress& progress) {
    refuse_vulkan(request.backend, "shadow_maps");
    const CasterTriangles& triangles = casters(structure);
    const MapOptions options = map_options(request.parameters);
    LightMaps maps = maps_for(options);
    const Maker make{triangles, options, request.threads, maps, progress};
    RenderResult result = render_lights(request, triangles.reach_m, static_cast<std::uint32_t>(maps.shapes.size()),
                                        make, MapJudge{maps}, progress);
    result.device = cpu_device(request.threads, std::to_string(wide::lanes) + " wide");
    return result;
}

/// All maps of one light, whole.
LightMaps whole_maps(const CasterTriangles& triangles, const TraceRequest& request) {
    const MapOptions options = map_options(request.parameters);
    LightMaps maps(1, cube_faces, options.resolution);
    const Progress progress;
    maps.shapes[0] = map_shape(light_record(request.light), triangles.bounds, options);
    const Maker make{triangles, options, 1, maps, progress};
    const int last = options.resolution - 1;
    for (int face = 0; face < maps_of(maps.shapes[0]); ++face) make.draw(0, face, {0, 0, last, last});
    return maps;
}

Trace trace(const Structure& structure, const TraceRequest& request) {
    const CasterTriangles& triangles = casters(structure);
    const LightMaps maps = whole_maps(triangles, request);
    return trace_map(maps.shapes[0], maps.maps(0), MapKind::conventional, request, triangles.reach_m);
}

Statistics statistics(const Structure& structure) {
    const CasterTriangles& triangles = casters(structure);
    Statistics statistics;
    statistics.structure_bytes = triangles.clusters.bytes();
    statistics.uncompressed_bytes = statistics.structure_bytes;
    statistics.build_seconds = triangles.build_seconds;
    statistics.values = {{"triangles", static_cast<double>(triangles.clusters.triangles), ""},
                         {"clusters", static_cast<double>(triangles.clusters.bounds.size()), ""}};
    return statistics;
}

constexpr std::array<std::string_view, 3> stages{"triangles in clusters", "a map for each light", "look-ups"};

}  // namespace

const Technique& shadow_maps() {
    static const Technique row{"shadow_maps",
                               "Shadow maps",
                               "L. Williams: Casting Curved Shadows on Curved Surfaces. SIGGRAPH, 1978; compared with "
                               "in L. Wang et al., IEEE TVCG, 2017, Table 5",
                               "The scene is drawn from every light, six faces each; a shadow ray is one depth looked "
                               "up there.",
                               stages,
                               parameters,
                               build,
                               render,
                               trace,
                               statistics,
                               false};
    return row;
}

std::vector<LookedUpMap> looked_up_maps(const Structure& structure, const TraceRequest& request, const Trace& traced) {
    constexpr std::array<std::string_view, cube_faces> faces{"+X", "-X", "+Y", "-Y", "+Z", "-Z"};
    constexpr std::array<std::string_view, 1> directional{"from the light"};
    const LightMaps maps = whole_maps(casters(structure), request);
    const ShadowMapShape& shape = maps.shapes[0];
    std::span<const std::string_view> titles = faces;
    if (shape.directional != 0) titles = directional;
    return maps_of_trace(shape, maps.maps(0), titles, traced);
}

QueryCount count_by_shadow_maps(const Structure& structure, const RenderRequest& request) {
    refuse_vulkan(request.backend, "shadow_maps");
    const CasterTriangles& triangles = casters(structure);
    const MapOptions options = map_options(request.parameters);
    LightMaps maps = maps_for(options);
    const Progress progress;
    const Maker make{triangles, options, request.threads, maps, progress};
    return count_lights(request, triangles.reach_m, static_cast<std::uint32_t>(maps.shapes.size()), make,
                        MapJudge{maps});
}

}  // namespace sightlines::baselines
