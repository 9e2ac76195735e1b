// Fields of scenes that move: baking a moment from what stands still, against baking everything anew.
#include <array>
#include <cmath>

#include "app/bench_field.h"
#include "app/table.h"
#include "techniques/visibility_field/moving_bake.h"

namespace sightlines::tables {

using namespace visibility_field;

namespace {

constexpr std::array<std::string_view, 3> moving_scenes{"planes", "bear", "park"};
constexpr float cell_m = 1.0f;  // the paper's for its outdoor scene
constexpr double step_s = 0.1;  // from one moment to the other

constexpr FieldFigure anew{"baking all anew", "s", 2}, moment{"baking the moment", "s", 2},
    speed_up{"speed-up by what stands still", "×", 1}, once{"baking what stands still, once", "s", 2, false},
    cells{"cells baked again", "%", 1, false}, rays{"rays cast again", "%", 1, false};

/// A moment of a scene, with its tree.
struct BenchMoment {
    Shared<Scene> moving;
    Scene still;  ///< the same, but nothing in it is said to move
    std::shared_ptr<const EmbreeScene> embree;
};

BenchMoment moment_at(FieldMeasuring& m, const std::string& name, double time_s) {
    Session session = m.run.base;
    session.scene = name;
    session.time_s = time_s;
    BenchMoment made{m.results.scene(session, m.progress), {}, {}};
    made.still = made.moving->value;
    for (Part& part : made.still.parts) part.moves = part.deforms = false;
    made.still.bounds = bounds_of_motion(made.still);  // the same grid
    made.embree = build_embree_scene(made.still, EmbreeUse::benchmark, m.results.threads(), m.progress);
    return made;
}

double seconds_of(const VisibilityField& field) { return field.place_seconds + field.cast_seconds; }

double percent(double part, double whole) { return whole > 0.0 ? 100.0 * part / whole : 0.0; }

void measure_moments(FieldMeasuring& m, const std::string& name, const BakeOptions& options) {
    const std::array<BenchMoment, 2> moments{moment_at(m, name, m.run.base.time_s),
                                             moment_at(m, name, m.run.base.time_s + step_s)};
    const auto fixed = bake_fixed(moments[0].moving->value, options, m.progress);
    VisibilityField latest;
    std::size_t asked = 0;
    const std::vector<double> seconds = median_seconds(
        m.run,
        {[&] { return seconds_of(bake(moments[asked % 2].still, *moments[asked % 2].embree, options, m.progress)); },
         [&] {
             const BenchMoment& at = moments[asked++ % 2];
             latest = bake_moment(*fixed, at.moving->value, *at.embree, options, m.progress);
             return seconds_of(latest);
         }},
        m.progress);
    FieldScene scene;
    scene.label = name;
    const FieldWay way{"", options};
    add_field_figure(m, scene, way, anew, seconds[0]);
    add_field_figure(m, scene, way, moment, seconds[1]);
    add_field_figure(m, scene, way, speed_up, seconds[0] / seconds[1]);
    add_field_figure(m, scene, way, once, fixed->seconds);
    add_field_figure(m, scene, way, cells, percent(latest.cells - latest.kept_cells, latest.cells));
    add_field_figure(m, scene, way, rays,
                     percent(static_cast<double>(latest.rays_again), static_cast<double>(latest.rays)));
}

}  // namespace

void field_moments(MeasuredTable& table, BenchRun& run, Results& results, Progress& progress) {
    FieldMeasuring m{table, run, results, progress};
    std::vector<std::string> names(moving_scenes.begin(), moving_scenes.end());
    if (!run.scenes.empty()) names = run.scenes;
    BakeOptions options = field_ways(run, results).front().bake;
    options.cell_m = cell_m;
    options.probes = 0;  // moments are dilated, so all anew is, too
    table.setup = count_text(options.points) + " points with " + std::to_string(options.rays) +
                  " rays each; cells of 100 cm" + (run.quick ? "; quick: a small sample" : "");
    for (const std::string& name : names) {
        say(run, table, name + ", moment after moment");
        measure_moments(m, name, options);
    }
    table.notes.emplace_back(
        "Two moments a tenth of a second apart, by turns. A moment's time holds the samples and the tree of what "
        "moves; the tree of the whole scene, which pictures need too, is in neither.");
    table.notes.emplace_back(
        "Cells baked again: those whose masks are not what they would be if only what stands still were there. The "
        "paper leaves scenes that move to future work.");
}

}  // namespace sightlines::tables
