// Xu 2022: Table 1, Figures 5 to 10, and memory.
#include <array>

#include "app/bench_field.h"
#include "app/table.h"
#include "techniques/visibility_field/dense_field.h"

namespace sightlines::tables {

using namespace visibility_field;

namespace {

constexpr std::array<int, 4> sample_counts{16, 32, 64, 128};
constexpr std::array<std::uint32_t, 4> point_counts{80'000, 400'000, 4'000'000, 10'000'000};
constexpr std::array<std::uint32_t, 4> point_counts_when_quick{1'250, 5'000, 20'000, 80'000};
constexpr std::array<int, 4> cells_cm{50, 100, 200, 400};

constexpr FieldFigure time_without{quantity::time_without_field, "ms", 2};
constexpr FieldFigure time_with{quantity::time_with_field, "ms", 2};
constexpr FieldFigure speed_up{quantity::field_speed_up, "×", 2};
constexpr FieldFigure rmse{quantity::field_rmse, "% of unshadowed", 3};
constexpr FieldFigure rays{quantity::field_rays, "% of samples", 2};
constexpr FieldFigure baking{quantity::field_bake, "s", 2};
constexpr FieldFigure memory{quantity::field_memory, "KiB", 0};
constexpr FieldFigure dense{quantity::dense_memory, "KiB", 0};

FieldFigure left_out_of_chart(FieldFigure figure) {
    figure.in_chart = false;
    return figure;
}

double rays_percent(const SampleCounts& counts) {
    return counts.samples > 0 ? 100.0 * static_cast<double>(counts.traced) / static_cast<double>(counts.samples) : 0.0;
}

double kibibytes(double bytes) { return bytes / 1024.0; }

std::string samples_text(int samples) { return std::to_string(samples) + " samples a pixel"; }
std::string cells_text(int cell_cm) { return std::to_string(cell_cm) + " cm"; }

/// Calls `add(scene, way, field, samples, measured)` for each way and number of samples, the field baked once.
void measure_by_samples(FieldMeasuring& m, const auto& add) {
    for (const std::string& name : field_scenes(m, "atrium")) {
        const auto scene = field_scene(m, name);
        for (const FieldWay& way : field_ways(m.run, m.results)) {
            say(m.run, m.table, scene->label + way.suffix);
            const auto field = bake_field(m, *scene, way.bake);
            if (!field) continue;
            for (const int samples : sample_counts)
                add(*scene, way, samples, measure_field(m, *scene, *field, way, samples));
        }
    }
}

void add_rmse_note(MeasuredTable& table) {
    table.notes.emplace_back(
        "RMSE: of irradiance, in percent of the mean irradiance of the same surfaces with nothing in the way. The "
        "paper's stand in its pictures, not in its text.");
}

void add_empty_cells_note(MeasuredTable& table) {
    table.notes.emplace_back(
        "In cells that no point fell into every ray is traced: few points at random cost time there.");
}

/// As the paper has its exterior.
FieldWay as_the_bistro(FieldWay way, const BenchRun& run) {
    way.suffix = " (as the bistro)";
    way.bake.cell_m = 1.0f;
    if (run.quick) return way;
    way.bake.points = 10'000'000;
    way.bake.rays = 128;
    return way;
}

/// Bakes, and adds everything about a picture by that field.
void add_picture(FieldMeasuring& m, const FieldScene& scene, const FieldWay& way, int samples) {
    say(m.run, m.table, scene.label + way.suffix);
    const auto field = bake_field(m, scene, way.bake);
    if (!field) return;
    const FieldMeasurement got = measure_field(m, scene, *field, way, samples);
    add_field_figure(m, scene, way, time_without, 1e3 * got.seconds_without);
    add_field_figure(m, scene, way, time_with, 1e3 * got.seconds_with);
    add_field_figure(m, scene, way, speed_up, got.speed_up());
    add_field_figure(m, scene, way, rmse, got.error.rmse_percent());
    add_field_figure(m, scene, way, rays, rays_percent(got.with));
}

}  // namespace

void field_speed_ups(MeasuredTable& table, BenchRun& run, Results& results, Progress& progress) {
    FieldMeasuring m{table, run, results, progress};
    measure_by_samples(m, [&](const FieldScene& scene, const FieldWay& way, int samples, const FieldMeasurement& got) {
        const std::string setting = samples_text(samples);
        add_field_figure(m, scene, way, left_out_of_chart(time_without), 1e3 * got.seconds_without, samples, setting);
        add_field_figure(m, scene, way, left_out_of_chart(time_with), 1e3 * got.seconds_with, samples, setting);
        add_field_figure(m, scene, way, speed_up, got.speed_up(), samples, setting);
    });
    finish_field_table(m, {left_out_of_chart(time_without), left_out_of_chart(time_with), speed_up}, "samples a pixel");
}

void field_pictures(MeasuredTable& table, BenchRun& run, Results& results, Progress& progress) {
    FieldMeasuring m{table, run, results, progress};
    for (const std::string& name : field_scenes(m, "atrium")) {
        const auto scene = field_scene(m, name);
        const std::vector<FieldWay> ways = field_ways(run, results);
        for (const FieldWay& way : {ways[0], with_finer_masks(ways[0]), ways[1]})
            add_picture(m, *scene, way, field_samples(run, 5));
        if (scene->label == "street") add_picture(m, *scene, as_the_bistro(ways[0], run), run.quick ? 32 : 64);
    }
    finish_field_table(m, {time_without, time_with, speed_up}, "");
    add_rmse_note(table);
    table.notes.emplace_back(
        "The paper: 128 samples a pixel, cells of 50 cm; the bistro, whose time is Figure 1's: 64 samples, cells of "
        "100 cm, 10 million points with 128 rays each, as the street has it, too, where it says so. Of the bistro's "
        "speed-up the text says only that it is less than 1.79, that of Figure 10.");
}

void field_by_points(MeasuredTable& table, BenchRun& run, Results& results, Progress& progress) {
    FieldMeasuring m{table, run, results, progress};
    for (const std::string& name : field_scenes(m, "atrium")) {
        const auto scene = field_scene(m, name);
        for (FieldWay way : field_ways(run, results))
            for (const std::uint32_t points : run.quick ? point_counts_when_quick : point_counts) {
                const std::string setting = count_text(points) + " points";
                say(run, table, scene->label + ", " + setting + way.suffix);
                way.bake.points = points;
                const auto field = bake_field(m, *scene, way.bake);
                if (!field) continue;
                const FieldMeasurement got = measure_field(m, *scene, *field, way, field_samples(run, 6));
                add_field_figure(m, *scene, way, rmse, got.error.rmse_percent(), points, setting);
                add_field_figure(m, *scene, way, left_out_of_chart(time_with), 1e3 * got.seconds_with, points, setting);
                add_field_figure(m, *scene, way, left_out_of_chart(rays), rays_percent(got.with), points, setting);
                add_field_figure(m, *scene, way, left_out_of_chart(baking), field->place_seconds + field->cast_seconds,
                                 points, setting);
            }
    }
    finish_field_table(m, {left_out_of_chart(time_with)}, "points");
    add_rmse_note(table);
    add_empty_cells_note(table);
    table.notes.emplace_back("Baking is timed once, not a median of repetitions.");
}

void field_by_cells(MeasuredTable& table, BenchRun& run, Results& results, Progress& progress) {
    FieldMeasuring m{table, run, results, progress};
    for (const std::string& name : field_scenes(m, "atrium")) {
        const auto scene = field_scene(m, name);
        for (FieldWay way : field_ways(run, results))
            for (const int cell_cm : cells_cm) {
                say(run, table, scene->label + ", cells of " + cells_text(cell_cm) + way.suffix);
                way.bake.cell_m = 0.01f * static_cast<float>(cell_cm);
                const auto field = bake_field(m, *scene, way.bake);
                if (!field) continue;
                const FieldMeasurement got = measure_field(m, *scene, *field, way, field_samples(run, 7));
                const std::string setting = cells_text(cell_cm);
                add_field_figure(m, *scene, way, rmse, got.error.rmse_percent(), cell_cm, setting);
                add_field_figure(m, *scene, way, time_with, 1e3 * got.seconds_with, cell_cm, setting);
                add_field_figure(m, *scene, way, rays, rays_percent(got.with), cell_cm, setting);
                add_field_figure(m, *scene, way, memory, kibibytes(static_cast<double>(field->bytes())), cell_cm,
                                 setting);
                if (way.suffix.empty())
                    add_field_figure(m, *scene, way, dense, kibibytes(static_cast<double>(dense_bytes(field->shape))),
                                     cell_cm, setting);
            }
    }
    finish_field_table(m, {time_with, dense}, "cm");
    add_rmse_note(table);
    add_empty_cells_note(table);
}

void field_by_samples(MeasuredTable& table, BenchRun& run, Results& results, Progress& progress) {
    FieldMeasuring m{table, run, results, progress};
    measure_by_samples(m, [&](const FieldScene& scene, const FieldWay& way, int samples, const FieldMeasurement& got) {
        const std::string setting = samples_text(samples);
        add_field_figure(m, scene, way, time_with, 1e3 * got.seconds_with, samples, setting);
        add_field_figure(m, scene, way, left_out_of_chart(rmse), got.error.rmse_percent(), samples, setting);
        add_field_figure(m, scene, way, left_out_of_chart(rays), rays_percent(got.with), samples, setting);
    });
    finish_field_table(m, {time_with}, "samples a pixel");
    add_rmse_note(table);
}

void field_labels(MeasuredTable& table, BenchRun& run, Results& results, Progress& progress) {
    FieldMeasuring m{table, run, results, progress};
    for (const std::string& name : field_scenes(m, "street")) {
        const auto scene = field_scene(m, name);
        FieldWay labels = field_ways(run, results).front();
        say(run, table, scene->label);
        const auto field = bake_field(m, *scene, labels.bake);
        if (!field) continue;
        labels.suffix = ", with labels";
        FieldWay visible = labels;
        visible.suffix = ", without labels";
        visible.culling = Culling::visible;
        for (const FieldWay& way : {labels, visible}) {
            const FieldMeasurement got = measure_field(m, *scene, *field, way, field_samples(run, 9));
            add_field_figure(m, *scene, way, time_with, 1e3 * got.seconds_with);
            add_field_figure(m, *scene, way, speed_up, got.speed_up());
            add_field_figure(m, *scene, way, rays, rays_percent(got.with));
        }
    }
    finish_field_table(m, {}, "");
    table.notes.emplace_back(
        "Without labels only visible regions are traced. The paper looks at the bistro's roofs, "
        "where the sky is wide; ours, unless a scene is given, is the street. The paper's times stand in its picture.");
}

void field_glossy(MeasuredTable& table, BenchRun& run, Results& results, Progress& progress) {
    FieldMeasuring m{table, run, results, progress};
    for (const std::string& name : field_scenes(m, "atrium")) {
        const auto scene = field_scene(m, name);
        for (FieldWay way : field_ways(run, results)) {
            way.roughness = 0.3f;
            add_picture(m, *scene, way, field_samples(run, 10));
        }
    }
    finish_field_table(m, {time_without, time_with, speed_up}, "");
    table.notes.emplace_back(
        "All surfaces have a roughness of 0.3 (GGX), samples drawn by what they reflect, labels ignored. The paper "
        "says "
        "neither its roughness nor its samples; its speed-ups follow from its times.");
    table.notes.emplace_back(
        "The speed-up is less than the rays that are saved: those that are left are the long ones.");
    table.notes.emplace_back(
        "RMSE: of what is reflected, times pi, in percent of the mean unshadowed irradiance of the same surfaces.");
}

void field_memory(MeasuredTable& table, BenchRun& run, Results& results, Progress& progress) {
    FieldMeasuring m{table, run, results, progress};
    constexpr FieldFigure packed{"memory, two bits a texel", "KiB", 0}, unique{"memory, alike masks once", "KiB", 0};
    for (const std::string& name : field_scenes(m, "atrium")) {
        const auto scene = field_scene(m, name);
        const FieldWay ours = field_ways(run, results).front();
        for (const FieldWay& each : {ours, with_finer_masks(ours)})
            for (const int cell_cm : cells_cm) {
                FieldWay way = each;
                const std::string setting = cells_text(cell_cm);
                say(run, table, scene->label + ", cells of " + setting + way.suffix);
                way.bake.cell_m = 0.01f * static_cast<float>(cell_cm);
                const auto field = bake_field(m, *scene, way.bake);
                if (!field) continue;
                const double bricks = static_cast<double>(field->bricks.size() * sizeof(FieldBrick));
                const double masks = 8.0 * field->cells * field->shape.words_per_mask;
                add_field_figure(m, *scene, way, dense, kibibytes(static_cast<double>(dense_bytes(field->shape))),
                                 cell_cm, setting);
                add_field_figure(m, *scene, way, packed, kibibytes(bricks + masks), cell_cm, setting);
                add_field_figure(m, *scene, way, unique, kibibytes(static_cast<double>(field->bytes())), cell_cm,
                                 setting);
            }
    }
    finish_field_table(m, {dense}, "cm");
    table.notes.emplace_back(
        "The same masks, bit for bit, in all three. Only cells that hold points have masks in ours; the paper has a "
        "byte "
        "a texel for every cell, with a margin of a texel. Its Sponza is 38 m long.");
    table.notes.emplace_back(
        "77 x 48 x 34 cells, as the paper says of Sponza, would take 49,088 KB in its layout, not the 49,008 that it "
        "prints.");
}

}  // namespace sightlines::tables
