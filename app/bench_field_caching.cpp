// What irradiance caching in screen space gains, with a field and without, and what it costs in accuracy.
#include <array>
#include <cmath>

#include "app/bench_field.h"
#include "app/table.h"
#include "techniques/visibility_field/irradiance_cache.h"
#include "techniques/visibility_field/visibility_field.h"

namespace sightlines::tables {

using namespace visibility_field;

namespace {

constexpr std::array<int, 3> spacings{4, 8, 16};
constexpr int converged_samples = 4096, converged_samples_when_quick = 256;

constexpr FieldFigure without_cache{"time without field and cache", "ms", 1}, field_alone{"time with field", "ms", 1},
    cache_alone{"time with cache", "ms", 1}, both{"time with field and cache", "ms", 1},
    gain{"speed-up by the cache", "×", 2}, asked{"pixels asked", "%", 1, false},
    error_without{"RMSE with field", "% of unshadowed", 3, false},
    error_with{"RMSE with field and cache", "% of unshadowed", 3, false};

float default_tolerance() {
    return static_cast<float>(parameter_value(technique().parameters, {}, "cache_tolerance") / 100.0);
}

/// A picture of this field (null: without) and this cache (0 pixels: without).
EnvironmentResult picture(FieldMeasuring& m, const FieldScene& scene, const VisibilityField* field,
                          const EnvironmentRequest& request, int spacing) {
    const auto make = [&](const EnvironmentRequest& each) {
        return render_environment(field, *scene.embree, each, m.progress);
    };
    return render_cached({spacing, default_tolerance()}, request, make);
}

struct CachingMeasurement {
    std::vector<double> plain, with_field;  ///< seconds without a cache, and for each of the spacings
};

/// All of them in turn.
CachingMeasurement measure_times(FieldMeasuring& m, const FieldScene& scene, const VisibilityField& field,
                                 const EnvironmentRequest& request) {
    std::vector<std::function<double()>> asks;
    for (const VisibilityField* each : {static_cast<const VisibilityField*>(nullptr), &field}) {
        asks.emplace_back([&, each] { return picture(m, scene, each, request, 0).seconds; });
        for (const int spacing : spacings)
            asks.emplace_back([&, each, spacing] { return picture(m, scene, each, request, spacing).seconds; });
    }
    const std::vector<double> seconds = median_seconds(m.run, asks, m.progress);
    const auto half = seconds.begin() + static_cast<std::ptrdiff_t>(seconds.size() / 2);
    return {{seconds.begin(), half}, {half, seconds.end()}};
}

EnvironmentResult converged_picture(FieldMeasuring& m, const FieldScene& scene, EnvironmentRequest request) {
    const SamplePattern pattern =
        make_pattern(m.run.quick ? converged_samples_when_quick : converged_samples, m.run.base.seed);
    request.pattern = &pattern;
    return picture(m, scene, nullptr, request, 0);
}

void measure_caching(FieldMeasuring& m, const FieldScene& scene, const FieldWay& way) {
    const auto field = bake_field(m, scene, way.bake);
    if (!field) return;
    const SamplePattern pattern = make_pattern(field_samples(m.run, 0), m.run.base.seed);
    EnvironmentRequest request;
    request.surfaces = &scene.surfaces->value;
    request.pattern = &pattern;
    request.light = scene.light;
    request.unshadowed = Unshadowed::sampled;  // the technique's default
    request.threads = m.results.threads();
    const CachingMeasurement times = measure_times(m, scene, *field, request);
    const EnvironmentResult converged = converged_picture(m, scene, request);
    const EnvironmentResult all = picture(m, scene, &*field, request, 0);
    const auto error = [&](const EnvironmentResult& ours) {
        return compare_irradiance(ours, converged, request).rmse_percent();
    };
    add_field_figure(m, scene, way, without_cache, 1e3 * times.plain[0]);
    add_field_figure(m, scene, way, field_alone, 1e3 * times.with_field[0]);
    add_field_figure(m, scene, way, error_without, error(all));
    for (std::size_t k = 0; k < spacings.size(); ++k) {
        const std::string setting = std::to_string(spacings[k]) + " pixels";
        const EnvironmentResult ours = picture(m, scene, &*field, request, spacings[k]);
        const auto add = [&](const FieldFigure& figure, double value) {
            add_field_figure(m, scene, way, figure, value, spacings[k], setting);
        };
        add(cache_alone, 1e3 * times.plain[k + 1]);
        add(both, 1e3 * times.with_field[k + 1]);
        add(gain, times.with_field[0] / times.with_field[k + 1]);
        add(asked, 100.0 * static_cast<double>(ours.counts.samples) /
                       static_cast<double>(std::max<std::uint64_t>(all.counts.samples, 1)));
        add(error_with, error(ours));
    }
}

}  // namespace

void field_caching(MeasuredTable& table, BenchRun& run, Results& results, Progress& progress) {
    FieldMeasuring m{table, run, results, progress};
    for (const std::string& name : field_scenes(m, "atrium")) {
        const auto scene = field_scene(m, name);
        say(run, table, scene->label);
        measure_caching(m, *scene, field_ways(run, results).front());
    }
    finish_field_table(m, {}, "pixels");
    table.notes.emplace_back(
        "Pixels: the coarsest distance between pixels that are asked. The cache's speed-up and error are those "
        "with the field. Tolerance: " +
        fixed_text(100.0 * static_cast<double>(default_tolerance()), 0) + " %.");
    table.notes.emplace_back(
        "RMSE: of irradiance, against a picture of " +
        count_text(static_cast<std::uint64_t>(run.quick ? converged_samples_when_quick : converged_samples)) +
        " samples a pixel without field or cache, in percent of the mean irradiance of the same surfaces with nothing "
        "in the way. Without a cache it is nearly all noise.");
}

}  // namespace sightlines::tables
