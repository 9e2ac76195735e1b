// What a technique offers to the rest of the program, and all that the rest knows of it.
#pragma once

#include <any>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "shaders/trace.h"
#include "techniques/base/image.h"
#include "techniques/base/parameters.h"
#include "techniques/base/progress.h"
#include "techniques/scene/environment_light.h"
#include "techniques/scene/scene.h"
#include "techniques/scene/surface_buffer.h"

namespace sightlines {

enum class Backend { cpu, vulkan };

/// For each ray pixel x light: one bit, set = blocked. Rays that were not asked (light behind the surface, background
/// pixel) have a clear bit. [P][words_per_pixel], light l in bit l % 32 of word l / 32.
struct Verdicts {
    std::uint32_t words_per_pixel = 0;
    std::vector<std::uint32_t> words;

    bool blocked(std::size_t pixel, std::uint32_t light) const {
        return (words[pixel * words_per_pixel + light / 32u] >> (light % 32u)) & 1u;
    }
};

struct RenderResult;

/// One picture to make. The spans must outlive the call.
struct RenderRequest {
    const SurfaceBuffer* surfaces = nullptr;
    const Scene* scene = nullptr;  ///< that the surfaces are of: for rays that go on from what they hit
    std::span<const Light> lights;
    const EnvironmentLight* environment = nullptr;  ///< not null where the technique is lit by it, instead of lights
    const std::any* samples = nullptr;              ///< EnvironmentLit::samples; null: the technique makes them itself
    ParameterValues parameters;
    Backend backend = Backend::cpu;
    std::uint64_t seed = 1;
    int threads = 0;             ///< 0: all. Never changes the result
    bool keep_verdicts = false;  ///< also return every ray's answer
    bool reverse_tiles = false;  ///< work through the tiles backwards. Never changes the result
    /// Called after each refinement pass over a region, with the picture so far (coarse passes fill whole blocks).
    /// From worker threads, one call at a time. May be empty: then there are no coarse passes.
    std::function<void(const RenderResult& so_far, PixelRect changed)> on_region;
};

/// An image and its companions, all [P].
struct RenderResult {
    ImageRgb radiance;                ///< linear; emission + lit by the lights that are seen
    ImageScalar shadow;               ///< share of the asked rays that are blocked, in [0, 1]
    Image<std::uint32_t> rays_asked;  ///< lights in front of the surface
    Verdicts verdicts;                ///< empty unless asked for
    std::uint64_t rays = 0;           ///< sum of rays_asked
    std::uint64_t rays_traced = 0;    ///< by Embree, for techniques that fall back on it
    Image<std::uint32_t> traced;      ///< of rays_traced, those of each pixel; empty where all or none are
    double seconds = 0.0;             ///< wall clock of the technique's own work
    std::string device;               ///< "CPU, 2 threads, AVX3" or the Vulkan device's name
};

/// One ray, recorded through the kernel that renders.
struct Trace {
    Segment ray;
    bool blocked = false;
    std::vector<TraceStep> steps;
};

/// A ray to record: the surface it starts from and the light it goes to.
struct TraceRequest {
    vec3 position{0.0f}, normal{0.0f};  ///< as in SurfaceBuffer
    Light light;
    ParameterValues parameters;
    const Scene* scene = nullptr;  ///< these as in RenderRequest
    const EnvironmentLight* environment = nullptr;
    std::uint64_t seed = 1;
};

struct Statistic {
    std::string name;
    double value = 0.0;
    std::string unit;
};

struct Statistics {
    std::uint64_t structure_bytes = 0, uncompressed_bytes = 0;
    double build_seconds = 0.0, compress_seconds = 0.0;
    std::vector<Statistic> values;
};

/// An immutable built structure; only its own technique looks inside.
using Structure = std::any;

struct BuildRequest {
    const Scene* scene = nullptr;
    ParameterValues parameters;
    Backend backend = Backend::cpu;  ///< where it will be asked: memory may be placed for it; the content is the same
    int threads = 0;
    /// What Technique::kept gave for the same scene and parameters at another time, or nothing. Saves work; the
    /// structure is the same without.
    std::any kept = {};
    std::filesystem::path cache_folder = {};  ///< for what takes long to build, between runs; empty: nothing is kept
};

struct EmbreeScene;

/// What a technique offers that is lit by the environment: each pixel asks samples of it instead of lights. Sample k
/// plays the part of light k everywhere: in verdicts, in rays_asked (samples above the surface), in traces.
struct EnvironmentLit {
    std::uint32_t (*samples_per_pixel)(const ParameterValues&);
    /// What all pixels' samples are made from (RenderRequest::samples). Takes a moment: to be made once.
    std::any (*samples)(const ParameterValues&, std::uint64_t seed);
    /// The samples of a pixel that shows a surface, as directional lights; a light's intensity is what its sample adds
    /// to the pixel's irradiance where nothing is in the way, W/m^2. The request's environment and samples are given.
    std::vector<Light> (*lights)(const RenderRequest&, std::size_t pixel);
    /// The same samples, each of them traced by the given tree.
    RenderResult (*reference)(const EmbreeScene&, const RenderRequest&, Progress&);
};

/// One row of the catalog. Plain functions; no state.
struct Technique {
    std::string_view name;                     ///< "voxel_rows"
    std::string_view title;                    ///< "Voxel rows"
    std::string_view paper;                    ///< citation
    std::string_view about;                    ///< one sentence
    std::span<const std::string_view> stages;  ///< the pipeline, in the words of the paper
    std::span<const Parameter> parameters;
    Structure (*build)(const BuildRequest&, Progress&);
    RenderResult (*render)(const Structure&, const RenderRequest&, Progress&);
    Trace (*trace)(const Structure&, const TraceRequest&);
    Statistics (*statistics)(const Structure&);
    /// Whether it also runs on Backend::vulkan; where not, build and render refuse that with an InputError.
    bool on_vulkan = true;
    /// What the next moment of the same scene can use of this one; null: nothing.
    std::any (*kept)(const Structure&) = nullptr;
    /// Null: it is lit by lights.
    const EnvironmentLit* environment = nullptr;
};

/// The explicit list of techniques (techniques/catalog.cpp).
std::span<const Technique> techniques();

/// InputError offers the nearest name.
const Technique& find_technique(std::string_view name);

}  // namespace sightlines
