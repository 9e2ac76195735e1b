// Wang 2017, tables 5 to 8, 10 and 11: times and memory.
#include <algorithm>
#include <any>
#include <array>
#include <memory>
#include <utility>

#include "app/bench_paper.h"
#include "app/bench_tables.h"
#include "app/table.h"
#include "techniques/baselines/baselines.h"
#include "techniques/voxel_rows/voxel_rows.h"

namespace sightlines::tables {
namespace {

constexpr std::array<std::string_view, 6> paper_scenes{"trees", "garden", "cathedral", "planes", "bear", "park"};
constexpr int embree_variants = 4;

/// What the measurements of one table go through.
struct Measuring {
    MeasuredTable& table;
    BenchRun& run;
    Results& results;
    Progress& progress;
    std::string device = "";  ///< what made the latest picture
};
using Ask = std::function<double()>;

/// Two moments of a scene that moves, whose structures are built by turns, each with what the one before has left.
struct Moments {
    Session session;
    std::array<Shared<Scene>, 2> scenes;
    std::any kept = {};
    std::size_t built = 0;
};

std::shared_ptr<Moments> two_moments(const Session& session, Measuring& m) {
    constexpr double frame_s = 1.0 / 30.0;
    Session later = session;
    later.time_s += frame_s;
    const auto first = m.results.scene(session, m.progress);
    return std::make_shared<Moments>(Moments{session, {first, m.results.scene(later, m.progress)}});
}

Structure build_anew(const Session& session, const Scene& scene, const std::any& kept, Measuring& m) {
    BuildRequest request;
    request.scene = &scene;
    request.parameters = technique_parameters(session);
    request.backend = m.results.backend(session);
    request.threads = m.results.threads();
    request.kept = kept;
    return find_technique(session.technique).build(request, m.progress);
}

/// Seconds of the next moment's structure.
double build_next(Moments& moments, Measuring& m) {
    const Technique& technique = find_technique(moments.session.technique);
    const Scene& scene = moments.scenes[moments.built++ % moments.scenes.size()]->value;
    const Structure structure = build_anew(moments.session, scene, std::exchange(moments.kept, {}), m);
    if (technique.kept) moments.kept = technique.kept(structure);
    return technique.statistics(structure).build_seconds;
}

/// Statistics of a structure that is built and let go.
Statistics build_once(const Session& session, Measuring& m) {
    const auto scene = m.results.scene(session, m.progress);
    return find_technique(session.technique).statistics(build_anew(session, scene->value, {}, m));
}

/// A picture, and where there are moments, the next one's structure.
Ask picture_ask(const Prepared& prepared, const std::shared_ptr<Moments>& moments, Measuring& m) {
    return [prepared, moments, &m] {
        const double building = moments ? build_next(*moments, m) : 0.0;
        return building + render_seconds(prepared, m.results, m.progress, m.device);
    };
}

Prepared prepare_for(std::string_view scene, const Variant& variant, Measuring& m, std::uint32_t lights = 0) {
    return prepare(session_of(m.run, scene, variant, lights), m.results, m.progress);
}

void add_device(Measuring& m, const std::string& device) {
    m.table.notes.push_back("Voxel rows ran on: " + device + "; all others on the CPU.");
}

void add_deforming_note(MeasuredTable& table) {
    table.notes.push_back(
        "Voxel rows are compressed. Where the scene deforms (bear, park) they are not, and building them for the next "
        "of "
        "two moments is part of the time: what has moved, where the paper builds the whole scene.");
}

/// The coarsest shadow maps that err at most as much as `limit_percent`; the finest where none does.
int matching_shadow_maps(std::string_view scene, double limit_percent, Measuring& m) {
    const std::vector<int> resolutions =
        m.run.quick ? std::vector{32, 64, 128} : std::vector{32, 64, 96, 128, 192, 256, 384, 512};
    for (const int resolution : resolutions) {
        say(m.run, m.table, std::string(scene) + ", shadow maps of " + std::to_string(resolution) + " texels");
        const Variant maps{"shadow_maps", {{"resolution", resolution}}};
        const MeanErrors errors = errors_of(m.run, session_of(m.run, scene, maps), m.results, m.progress);
        if (errors.visibility <= limit_percent) return resolution;
    }
    m.table.notes.push_back(std::string(scene) + ": no shadow maps up to " + std::to_string(resolutions.back()) +
                            " texels err as little as voxel rows; compared with the last.");
    return resolutions.back();
}

/// What a light costs in `row`, as a multiple of what it costs in `base`.
MeasuredRow time_per_light(const MeasuredRow& row, const MeasuredRow& base, std::string_view quantity) {
    const auto relative = [&](const std::optional<double>& time, const std::optional<double>& base_time) {
        return time && base_time ? std::optional(*time / row.at / (*base_time / base.at)) : std::nullopt;
    };
    MeasuredRow made = row;
    made.quantity = quantity;
    made.unit = "×";
    made.digits = 2;
    made.in_chart = false;
    made.ours = relative(row.ours, base.ours);
    made.paper = relative(row.paper, base.paper);
    return made;
}

/// Times of a picture by the number of lights.
struct TimesByLights {
    std::vector<double> whole, rebuild, asking;  ///< seconds; the latter two where the scene deforms, whole their sum
};

/// From the medians of pictures or, where the scene deforms, of rebuilds and pictures by turns.
TimesByLights parted(const std::vector<double>& medians, bool deforming) {
    if (!deforming) return {medians, {}, {}};
    TimesByLights times;
    for (std::size_t i = 0; i + 1 < medians.size(); i += 2) {
        times.rebuild.push_back(medians[i]);
        times.asking.push_back(medians[i + 1]);
        times.whole.push_back(medians[i] + medians[i + 1]);
    }
    return times;
}

/// The times by the number of lights, and what a light costs at each number beside one of `base_lights`.
void add_times(MeasuredTable& table, std::string_view scene, const std::vector<std::uint32_t>& counts,
               std::uint32_t base_lights, const std::vector<double>& seconds, std::string_view what,
               std::string_view per_light) {
    const std::size_t first = table.rows.size();
    for (std::size_t i = 0; i < counts.size(); ++i)
        add_figure(table, scene, what, 1e3 * seconds[i], "ms", 1, counts[i], count_text(counts[i]) + " lights");
    const MeasuredRow base =
        table.rows[first + static_cast<std::size_t>(std::ranges::find(counts, base_lights) - counts.begin())];
    for (std::size_t i = 0; i < counts.size(); ++i)
        if (counts[i] != base_lights) table.rows.push_back(time_per_light(table.rows[first + i], base, per_light));
}

QueryCount counted(const Prepared& prepared, Measuring& m,
                   QueryCount (*count)(const Structure&, const RenderRequest&)) {
    const PictureRequest asked =
        m.results.request(prepared.session, prepared.surfaces->value, prepared.lights->value, m.progress);
    return count(prepared.structure->value.structure, asked.request);
}

}  // namespace

void times_by_scene(MeasuredTable& table, BenchRun& run, Results& results, Progress& progress) {
    Measuring m{table, run, results, progress};
    std::string rows_device;
    for (const std::string& scene : scenes_for(table, run, paper_scenes)) {
        const MeanErrors errors = errors_of(run, session_of(run, scene, rows_for(scene)), results, progress);
        const int texels = matching_shadow_maps(scene, errors.visibility, m);
        say(run, table, scene + ", times");
        const Prepared rows = prepare_for(scene, rows_for(scene), m);
        const Prepared maps = prepare_for(scene, {"shadow_maps", {{"resolution", texels}}}, m);
        const Prepared tracing = prepare_for(scene, {"ray_tracing", {}}, m);
        const auto rows_moments = deforms(scene) ? two_moments(rows.session, m) : nullptr;
        const auto traced_moments = moves(scene) ? two_moments(tracing.session, m) : nullptr;
        std::vector<Ask> asks{picture_ask(maps, nullptr, m), picture_ask(rows, rows_moments, m)};
        for (int variant = 0; variant < embree_variants; ++variant)
            asks.push_back(picture_ask(with_values(tracing, {{"variant", variant}}), traced_moments, m));
        const std::vector<double> seconds = median_seconds(run, asks, progress);
        render_seconds(rows, results, progress, rows_device);
        const double traced = *std::min_element(seconds.begin() + 2, seconds.end());
        add_figure(table, scene, quantity::render_time, 1e3 * seconds[1], "ms", 1);
        add_figure(table, scene, quantity::over_ray_tracing, traced / seconds[1], "×", 2);
        add_figure(table, scene, quantity::over_shadow_maps, seconds[0] / seconds[1], "×", 2);
        add_figure(table, scene, quantity::shadow_map_resolution, texels, "texels", 0);
    }
    add_device(m, rows_device);
    add_deforming_note(table);
    table.notes.push_back(
        "Ray tracing: the fastest of Embree's variants; where anything moves (planes, bear, park) with the building of "
        "its hierarchy. Shadow maps: of the resolution whose visibility error is at most that of voxel rows.");
}

void times_by_lights(MeasuredTable& table, BenchRun& run, Results& results, Progress& progress) {
    const std::vector<std::uint32_t> counts = run.quick ? std::vector<std::uint32_t>{128, 256, 512}
                                                        : std::vector<std::uint32_t>{64, 512, 1024, 2048, 4096, 10000};
    const std::uint32_t base_lights = run.quick ? 512 : 1024;
    Measuring m{table, run, results, progress};
    for (const std::string& scene : scenes_for(table, run, std::span(paper_scenes).first(5))) {
        say(run, table, scene);
        const auto moments = deforms(scene) ? two_moments(session_of(run, scene, rows_for(scene)), m) : nullptr;
        std::vector<Ask> asks;
        for (const std::uint32_t lights : counts)
            asks.push_back(picture_ask(prepare_for(scene, rows_for(scene), m, lights), nullptr, m));
        if (moments)
            for (std::size_t i = 0; i < counts.size(); ++i)  // before each picture, as where things move
                asks.insert(asks.begin() + static_cast<std::ptrdiff_t>(2 * i),
                            [moments, &m] { return build_next(*moments, m); });
        const TimesByLights times = parted(median_seconds(run, asks, progress), moments != nullptr);
        add_times(table, scene, counts, base_lights, times.whole, quantity::render_time, quantity::time_per_light);
        if (!moments) continue;
        for (std::size_t i = 0; i < counts.size(); ++i)
            add_figure(table, scene, quantity::rebuild_time, 1e3 * times.rebuild[i], "ms", 1, counts[i],
                       count_text(counts[i]) + " lights");
        add_times(table, scene, counts, base_lights, times.asking, quantity::asking_time,
                  quantity::asking_time_per_light);
    }
    add_device(m, m.device);
    add_deforming_note(table);
    if (std::ranges::any_of(table.rows, [](const MeasuredRow& row) { return row.quantity == quantity::rebuild_time; }))
        table.notes.push_back(
            "There the time is also given in its two parts: the rebuild, which does not depend on the lights, and "
            "asking; the whole is the sum of their medians.");
    table.notes.push_back("Time per light: to that of " + count_text(base_lights) + " lights; 1 is exactly linear.");
}

void times_of_marching(MeasuredTable& table, BenchRun& run, Results& results, Progress& progress) {
    Measuring m{table, run, results, progress};
    for (const std::string& scene : scenes_for(table, run, paper_scenes)) {
        say(run, table, scene);
        Session on_cpu = session_of(run, scene, rows_for(scene));
        on_cpu.backend = BackendChoice::cpu;
        const Prepared rows = prepare(on_cpu, results, progress);
        const Prepared voxels = prepare_for(scene, {"voxel_marching", {}}, m);
        const Prepared segments = prepare_for(scene, {"row_marching", {}}, m);
        const std::vector<double> seconds =
            median_seconds(run,
                           {[&] { return counted(rows, m, voxel_rows::count_blocked).seconds; },
                            [&] { return counted(voxels, m, baselines::count_by_voxel_marching).seconds; },
                            [&] { return counted(segments, m, baselines::count_by_row_marching).seconds; }},
                           progress);
        add_figure(table, scene, quantity::row_query_time, 1e3 * seconds[0], "ms", 1);
        add_figure(table, scene, quantity::voxel_marching_time, 1e3 * seconds[1], "ms", 1);
        add_figure(table, scene, quantity::row_marching_time, 1e3 * seconds[2], "ms", 1);
        add_figure(table, scene, quantity::over_voxel_marching, seconds[1] / seconds[0], "×", 2);
        add_figure(table, scene, quantity::over_row_marching, seconds[2] / seconds[0], "×", 2);
    }
    table.notes.push_back(
        "Ours: on the CPU, asking and counting only, neither shading nor building. The paper's times are of whole "
        "pictures.");
}

void memory_by_resolution(MeasuredTable& table, BenchRun& run, Results& results, Progress& progress) {
    constexpr double mebibyte = 1024.0 * 1024.0;
    Measuring m{table, run, results, progress};
    const std::vector<int> resolutions = fitting_resolutions(table, run);
    for (const std::string& scene : scenes_for(table, run, std::span(paper_scenes).first(1)))
        for (const int resolution : resolutions) {
            say(run, table, scene + ", " + std::to_string(resolution) + " voxels a side");
            const Variant variant = rows_with(true, {{"resolution", resolution}});
            const Statistics built = build_once(session_of(run, scene, variant), m);
            const std::string setting = std::to_string(resolution) + "³ voxels";
            add_figure(table, scene, quantity::uncompressed, static_cast<double>(built.uncompressed_bytes) / mebibyte,
                       "MiB", 1, resolution, setting);
            add_figure(table, scene, quantity::compressed, static_cast<double>(built.structure_bytes) / mebibyte, "MiB",
                       1, resolution, setting);
        }
    table.notes.push_back("The paper does not say which scene its Table 8 is of, and writes MB for MiB.");
}

void times_of_building(MeasuredTable& table, BenchRun& run, Results& results, Progress& progress) {
    Measuring m{table, run, results, progress};
    for (const std::string& scene : scenes_for(table, run, std::span(paper_scenes).first(3))) {
        say(run, table, scene);
        const Session plain = session_of(run, scene, rows_with(false));
        const Session packed = session_of(run, scene, rows_with(true));
        const std::vector<double> seconds = median_seconds(run,
                                                           {[&] { return build_once(plain, m).build_seconds; },
                                                            [&] { return build_once(packed, m).compress_seconds; }},
                                                           progress);
        add_figure(table, scene, quantity::voxelization_time, seconds[0], "s", 2);
        add_figure(table, scene, quantity::compression_time, seconds[1], "s", 2);
    }
    table.notes.push_back("The paper voxelizes on the GPU and compresses on one thread of the CPU.");
}

void times_of_compression(MeasuredTable& table, BenchRun& run, Results& results, Progress& progress) {
    Measuring m{table, run, results, progress};
    for (const std::string& scene : scenes_for(table, run, std::span(paper_scenes).first(3))) {
        say(run, table, scene);
        const Prepared plain = prepare_for(scene, rows_with(false), m);
        const Prepared packed = prepare_for(scene, rows_with(true), m);
        const std::vector<double> seconds =
            median_seconds(run, {picture_ask(plain, nullptr, m), picture_ask(packed, nullptr, m)}, progress);
        add_figure(table, scene, quantity::uncompressed, 1.0 / seconds[0], "frames/s", 2);
        add_figure(table, scene, quantity::compressed, 1.0 / seconds[1], "frames/s", 2);
    }
    add_device(m, m.device);
}

}  // namespace sightlines::tables
