// The field with indirect light: what a blocked sample hits is lit by a ray of its own, culled by its own cell.
#include <array>

#include "app/bench_field.h"
#include "app/table.h"

namespace sightlines::tables {

using namespace visibility_field;

namespace {

constexpr std::array<std::string_view, 2> usual_scenes{"atrium", "street"};

constexpr FieldFigure without{quantity::time_without_field, "ms", 0}, with{quantity::time_with_field, "ms", 0},
    speed_up{quantity::field_speed_up, "×", 2}, first_rays{"samples traced", "%", 2, false},
    second_rays{"second rays traced", "%", 2}, rmse{quantity::field_rmse, "% of unshadowed", 3};

double percent(std::uint64_t part, std::uint64_t whole) {
    return whole > 0 ? 100.0 * static_cast<double>(part) / static_cast<double>(whole) : 0.0;
}

}  // namespace

void field_indirect(MeasuredTable& table, BenchRun& run, Results& results, Progress& progress) {
    FieldMeasuring m{table, run, results, progress};
    std::vector<std::string> names(usual_scenes.begin(), run.quick ? usual_scenes.begin() + 1 : usual_scenes.end());
    if (!run.scenes.empty()) names = run.scenes;
    for (const std::string& name : names) {
        const auto scene = field_scene(m, name);
        FieldWay way = field_ways(run, results).front();
        way.indirect = true;
        say(run, table, scene->label);
        const auto field = bake_field(m, *scene, way.bake);
        if (!field) continue;
        const FieldMeasurement got =
            measure_field(m, *scene, *field, way, field_samples(run, find_table(table.name).number));
        add_field_figure(m, *scene, way, without, 1e3 * got.seconds_without);
        add_field_figure(m, *scene, way, with, 1e3 * got.seconds_with);
        add_field_figure(m, *scene, way, speed_up, got.speed_up());
        add_field_figure(m, *scene, way, first_rays, percent(got.with.traced, got.with.samples - got.with.below));
        add_field_figure(m, *scene, way, second_rays,
                         percent(got.second_rays.traced, got.second_rays.samples - got.second_rays.below));
        add_field_figure(m, *scene, way, rmse, got.error.rmse_percent());
    }
    finish_field_table(m, {}, "");
    table.notes.emplace_back(
        "Every sample that is blocked is followed to what it hits, with the field and without: the field saves rays "
        "towards the surroundings, of pixels and of what they hit, not those that find what is hit. The paper leaves "
        "indirect light to future work.");
}

}  // namespace sightlines::tables
