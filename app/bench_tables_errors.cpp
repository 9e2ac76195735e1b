// Wang 2017, tables 1 to 4 and 9 and Figure 7: how many rays are answered wrongly.
#include <algorithm>
#include <array>
#include <iterator>
#include <optional>
#include <span>
#include <utility>

#include "app/bench_paper.h"
#include "app/bench_tables.h"
#include "app/table.h"

namespace sightlines::tables {
namespace {

constexpr std::array<std::string_view, 6> paper_scenes{"trees", "garden", "cathedral", "planes", "bear", "park"};

void add_errors(MeasuredTable& table, std::string_view scene, const MeanErrors& errors, double at,
                const std::string& setting) {
    add_figure(table, scene, quantity::visibility, errors.visibility, "%", 1, at, setting);
    add_figure(table, scene, quantity::shadow, errors.shadow, "%", 1, at, setting);
}

/// Of the rays that are asked, and of all lights, as the paper's example counts.
void add_both_ways(MeasuredTable& table, std::string_view scene, std::string_view name, double of_asked,
                   double of_all) {
    const std::optional<double> paper = add_figure(table, scene, name, of_asked, "%", 1).paper;
    add_figure(table, scene, std::string(name) + quantity::of_all_lights, of_all, "%", 1).paper = paper;
}

struct ImperfectMaps {
    int points = 11000;
    int texels = 128;  ///< a side
};

constexpr std::array<int, 10> point_counts{100, 200, 500, 1000, 2000, 5000, 11000, 20000, 50000, 100000};
constexpr std::array<int, 3> map_sizes{128, 64, 32};

Variant variant_of(const ImperfectMaps& maps) {
    return {"imperfect_shadow_maps", {{"points", double(maps.points)}, {"resolution", double(maps.texels)}}};
}

MeanErrors errors_of_maps(const std::string& scene, const ImperfectMaps& maps, BenchRun& run, Results& results,
                          Progress& progress) {
    return errors_of(run, session_of(run, scene, variant_of(maps)), results, progress);
}

/// The most points with which maps of this size take no longer for a picture than voxel rows; nothing where all do.
std::optional<int> points_in_equal_time(const Prepared& rows, const std::string& scene, int texels, BenchRun& run,
                                        Results& results, Progress& progress) {
    std::string device;
    const auto fits = [&](int points) {
        const Prepared maps = prepare(session_of(run, scene, variant_of({points, texels})), results, progress);
        const std::vector<double> medians =
            median_seconds(run,
                           {[&] { return render_seconds(rows, results, progress, device); },
                            [&] { return render_seconds(maps, results, progress, device); }},
                           progress);
        return medians[1] <= medians[0];
    };
    const auto end = std::ranges::partition_point(point_counts, fits);
    return end == point_counts.begin() ? std::nullopt : std::optional(*std::prev(end));
}

/// Of the maps that take no longer than voxel rows those that err least; the cheapest where all take longer.
void add_equal_time(MeasuredTable& table, const std::string& scene, BenchRun& run, Results& results,
                    Progress& progress) {
    const Prepared rows = prepare(session_of(run, scene, rows_for(scene)), results, progress);
    std::optional<std::pair<ImperfectMaps, MeanErrors>> best;
    for (const int texels : std::span(map_sizes).first(run.quick ? 1 : map_sizes.size())) {
        say(run, table, scene + ", imperfect maps of " + std::to_string(texels) + " texels in equal time");
        const std::optional<int> points = points_in_equal_time(rows, scene, texels, run, results, progress);
        if (!points) continue;
        const ImperfectMaps maps{*points, texels};
        const MeanErrors errors = errors_of_maps(scene, maps, run, results, progress);
        if (!best || errors.visibility < best->second.visibility) best = {maps, errors};
    }
    if (!best) {
        const ImperfectMaps cheapest{point_counts.front(), map_sizes.back()};
        best = {cheapest, errors_of_maps(scene, cheapest, run, results, progress)};
    }
    add_figure(table, scene, quantity::equal_time_points, best->first.points, "points", 0).in_chart = false;
    add_figure(table, scene, quantity::equal_time_texels, best->first.texels, "texels", 0).in_chart = false;
    add_figure(table, scene, quantity::equal_time_visibility, best->second.visibility, "%", 1);
    add_figure(table, scene, quantity::equal_time_shadow, best->second.shadow, "%", 1);
}

}  // namespace

void errors_by_scene(MeasuredTable& table, BenchRun& run, Results& results, Progress& progress) {
    for (const std::string& scene : scenes_for(table, run, paper_scenes)) {
        say(run, table, scene);
        const MeanErrors rows = errors_of(run, session_of(run, scene, rows_for(scene)), results, progress);
        const MeanErrors maps = errors_of_maps(scene, {}, run, results, progress);
        add_both_ways(table, scene, quantity::visibility, rows.visibility, rows.visibility_of_all);
        add_both_ways(table, scene, quantity::imperfect_visibility, maps.visibility, maps.visibility_of_all);
        add_both_ways(table, scene, quantity::shadow, rows.shadow, rows.shadow_of_all);
        add_both_ways(table, scene, quantity::imperfect_shadow, maps.shadow, maps.shadow_of_all);
        add_equal_time(table, scene, run, results, progress);
    }
    table.notes.push_back(
        "Voxel rows are compressed, except in scenes that deform (bear, park). Imperfect shadow maps have 11,000 "
        "points and 128 texels a side. Errors are shares of the rays that are asked, to lights in front of the "
        "surface; of all lights: as the paper's example counts, where a light behind it is a right answer. Equal "
        "time: of maps of 32, 64 and 128 texels a side (128 with --quick) those that err least, with the most points "
        "with which a picture takes no longer than by voxel rows, without building; where all take longer the "
        "cheapest.");
}

void errors_by_lights(MeasuredTable& table, BenchRun& run, Results& results, Progress& progress) {
    const std::vector<std::uint32_t> counts = run.quick ? std::vector<std::uint32_t>{64, 128, 512}
                                                        : std::vector<std::uint32_t>{64, 512, 1024, 2048, 4096, 10000};
    const std::uint32_t enough_lights = run.quick ? 512 : 1024;
    for (const std::string& scene : scenes_for(table, run, std::span(paper_scenes).first(2)))
        for (const std::uint32_t lights : counts) {
            say(run, table, scene + ", " + count_text(lights) + " lights");
            const Session session = session_of(run, scene, rows_for(scene), lights);
            add_errors(table, scene, mean_errors(run, session, light_sets(lights, enough_lights), results, progress),
                       lights, count_text(lights) + " lights");
        }
    std::string sets;
    for (const std::uint32_t lights : counts)
        if (const std::uint32_t count = light_sets(lights, enough_lights); count > 1)
            sets += (sets.empty() ? "" : ", ") + std::to_string(count) + " of " + count_text(lights);
    table.notes.push_back("Of few lights the mean over several random sets, by as many seeds from the session's on: " +
                          sets + " lights.");
}

void errors_by_resolution(MeasuredTable& table, BenchRun& run, Results& results, Progress& progress) {
    const std::vector<int> resolutions = fitting_resolutions(table, run);
    for (const std::string& scene : scenes_for(table, run, std::span(paper_scenes).first(3)))
        for (const int resolution : resolutions) {
            const Variant variant = rows_with(true, {{"resolution", resolution}});
            say(run, table, scene + ", " + std::to_string(resolution) + " voxels a side");
            add_errors(table, scene, errors_of(run, session_of(run, scene, variant), results, progress), resolution,
                       std::to_string(resolution) + "³ voxels");
        }
}

void errors_by_angle(MeasuredTable& table, BenchRun& run, Results& results, Progress& progress) {
    const std::vector<int> steps = run.quick ? std::vector{6, 3} : std::vector{6, 3, 2};
    for (const std::string& scene : scenes_for(table, run, std::span(paper_scenes).first(2)))
        for (const int step : steps) {
            say(run, table, scene + ", " + std::to_string(step) + " degrees");
            const Session session = session_of(run, scene, rows_with(true, {{"angle_step", step}}));
            add_errors(table, scene, errors_of(run, session, results, progress), step, std::to_string(step) + "°");
        }
}

void errors_of_compression(MeasuredTable& table, BenchRun& run, Results& results, Progress& progress) {
    for (const std::string& scene : scenes_for(table, run, std::span(paper_scenes).first(4))) {
        say(run, table, scene);
        const MeanErrors plain = errors_of(run, session_of(run, scene, rows_with(false)), results, progress);
        const MeanErrors packed = errors_of(run, session_of(run, scene, rows_with(true)), results, progress);
        add_figure(table, scene, quantity::plain_visibility, plain.visibility, "%", 2);
        add_figure(table, scene, quantity::compressed_visibility, packed.visibility, "%", 2);
        add_figure(table, scene, quantity::plain_shadow, plain.shadow, "%", 2);
        add_figure(table, scene, quantity::compressed_shadow, packed.shadow, "%", 2);
    }
}

void errors_by_samples(MeasuredTable& table, BenchRun& run, Results& results, Progress& progress) {
    const std::vector<int> samples = run.quick ? std::vector{1000, 11000, 50000}
                                               : std::vector{1000, 2000, 5000, 11000, 20000, 50000, 100000, 200000};
    for (const std::string& scene : scenes_for(table, run, std::span(paper_scenes).first(2))) {
        const MeanErrors rows = errors_of(run, session_of(run, scene, rows_for(scene)), results, progress);
        for (const int points : samples) {
            say(run, table, scene + ", " + count_text(static_cast<std::uint64_t>(points)) + " points");
            const std::string setting = count_text(static_cast<std::uint64_t>(points)) + " points";
            const MeanErrors maps = errors_of_maps(scene, {points}, run, results, progress);
            add_figure(table, scene, quantity::imperfect_shadow, maps.shadow, "%", 1, points, setting);
            add_figure(table, scene, quantity::shadow, rows.shadow, "%", 1, points, setting);
        }
    }
    table.notes.push_back(
        "Voxel rows have no points: their error is the same line for all. The paper draws Figure 7 "
        "without figures; those of its Table 1 stand at 11,000 points.");
}

}  // namespace sightlines::tables
