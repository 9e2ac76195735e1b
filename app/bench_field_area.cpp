// Local area lights: what cells know of them saves, and what it errs.
#include <array>

#include "app/bench_field.h"
#include "app/table.h"
#include "techniques/visibility_field/area_sight.h"

namespace sightlines::tables {

using namespace visibility_field;

namespace {

constexpr std::array<std::string_view, 2> lit_scenes{"cornell", "tv"};
constexpr int sight_rays = 64;
constexpr int reference_samples = 256;

constexpr FieldFigure shining{"triangles that shine", "", 0, false}, time_without{"time without the field", "ms", 1},
    time_with{"time with the field", "ms", 1}, speed_up{"speed-up of area lights", "×", 2, false},
    needed{"segments that need a ray", "%", 1, false}, error_without{"RMSE without the field", "%", 3, false},
    error_with{"RMSE with the field", "%", 3, false}, error_of_field{"RMSE of the field alone", "%", 3, false},
    baking{"finding out what cells know", "s", 2, false};

/// One scene's pictures of area lights under a black sky.
struct AreaBench {
    FieldMeasuring& m;
    const FieldScene& scene;
    AreaLights lights;
    EnvironmentRequest request;
    SamplePattern pattern;

    AreaBench(FieldMeasuring& measuring, const FieldScene& of)
        : m(measuring),
          scene(of),
          lights(find_area_lights(of.scene->value)),
          pattern(make_pattern(1, measuring.run.base.seed)) {
        request.surfaces = &scene.surfaces->value;
        request.pattern = &pattern;
        request.threads = m.results.threads();
    }
    EnvironmentResult picture(const VisibilityField* field, const AreaSight* sight, int samples) const {
        EnvironmentResult result = blank_environment(request);
        add_area_lights(field, sight, *scene.embree, scene.scene->value, lights, request, samples, result, m.progress);
        return result;
    }
    /// The mean of pictures with other samples.
    EnvironmentResult reference() {
        EnvironmentResult sum = blank_environment(request);
        const int pictures = m.run.quick ? 2 : 8;
        const SamplePattern own = pattern;
        for (int k = 1; k <= pictures; ++k) {
            pattern = make_pattern(1, m.run.base.seed + static_cast<std::uint64_t>(k));
            const EnvironmentResult each = picture(nullptr, nullptr, reference_samples);
            for (std::size_t p = 0; p < sum.irradiance.pixels.size(); ++p)
                sum.irradiance.pixels[p] += each.irradiance.pixels[p] / static_cast<float>(pictures);
        }
        pattern = own;
        return sum;
    }
    double error(const EnvironmentResult& ours, const EnvironmentResult& truth) const {
        return compare_irradiance(ours, truth, request).rmse_percent_of_mean();
    }
};

double milliseconds(double seconds) { return 1000.0 * seconds; }

double percent_needed(const SampleCounts& counts) {
    const std::uint64_t asked = counts.samples - counts.below;
    return asked > 0 ? 100.0 * static_cast<double>(counts.traced) / static_cast<double>(asked) : 0.0;
}

void measure_area_lights(FieldMeasuring& m, const FieldScene& scene, const FieldWay& way, int samples) {
    const Scene& shown = scene.scene->value;
    CellPoints points;
    const VisibilityField field = bake(shown, *scene.embree, way.bake, m.progress, &points);
    const AreaSight sight =
        bake_area_sight(shown, field, *scene.embree, points,
                        {.rays = sight_rays, .seed = way.bake.seed, .threads = way.bake.threads}, m.progress);
    AreaBench bench(m, scene);
    EnvironmentResult with, without;
    const std::vector<double> seconds = median_seconds(m.run,
                                                       {[&] {
                                                            without = bench.picture(nullptr, nullptr, samples);
                                                            return without.seconds;
                                                        },
                                                        [&] {
                                                            with = bench.picture(&field, &sight, samples);
                                                            return with.seconds;
                                                        }},
                                                       m.progress);
    const EnvironmentResult truth = bench.reference();
    add_field_figure(m, scene, way, shining, static_cast<double>(bench.lights.triangles.size()));
    add_field_figure(m, scene, way, time_without, milliseconds(seconds[0]));
    add_field_figure(m, scene, way, time_with, milliseconds(seconds[1]));
    add_field_figure(m, scene, way, speed_up, seconds[1] > 0.0 ? seconds[0] / seconds[1] : 0.0);
    add_field_figure(m, scene, way, needed, percent_needed(with.area_rays));
    add_field_figure(m, scene, way, error_without, bench.error(without, truth));
    add_field_figure(m, scene, way, error_with, bench.error(with, truth));
    add_field_figure(m, scene, way, error_of_field, bench.error(with, without));
    add_field_figure(m, scene, way, baking, sight.seconds);
}

}  // namespace

void field_area_lights(MeasuredTable& table, BenchRun& run, Results& results, Progress& progress) {
    FieldMeasuring m{table, run, results, progress};
    std::vector<std::string> names(lit_scenes.begin(), lit_scenes.end());
    if (!run.scenes.empty()) names = run.scenes;
    const FieldWay way = field_ways(run, results).front();
    const int samples = run.quick ? 16 : 64;
    table.setup = std::to_string(run.base.size.width) + " x " + std::to_string(run.base.size.height) + " pixels, " +
                  std::to_string(samples) + " samples of the lights each; " + count_text(way.bake.points) +
                  " points with " + std::to_string(way.bake.rays) + " rays each; cells of " +
                  fixed_text(100.0 * way.bake.cell_m, 0) + " cm" + (run.quick ? "; quick: a small sample" : "");
    for (const std::string& name : names) {
        const auto scene = field_scene(m, name);
        say(run, table, scene->label + ", area lights");
        if (find_area_lights(scene->scene->value).triangles.empty()) {
            table.notes.push_back("Left out: " + scene->label + ", in which nothing shines.");
            continue;
        }
        measure_area_lights(m, *scene, way, samples);
    }
    table.notes.emplace_back(
        "Light of the scene's shining surfaces alone. A segment counts where each of its ends is in front of the "
        "other. RMSE: of the irradiance, in percent of its mean; with and without the field against many more samples "
        "without, of the field alone against the same samples without.");
    table.notes.emplace_back("The paper leaves local area lights to further research.");
}

}  // namespace sightlines::tables
