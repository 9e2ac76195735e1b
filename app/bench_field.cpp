#include "app/bench_field.h"

#include <algorithm>
#include <filesystem>

#include "app/table.h"
#include "techniques/base/error.h"
#include "techniques/scene/environment.h"

namespace sightlines {

using namespace visibility_field;

namespace {

constexpr std::string_view plain = " (plain)", finer = " (finer)";
constexpr int finer_mask = 32;  // what fits into two vectors of 16 words

/// What the scene is called in the paper's figures and in rows.
std::string label_of(const std::string& name) {
    const std::string stem = std::filesystem::path(name).stem().string();
    for (const char* known : {"sponza", "bistro"})
        if (stem.find(known) != std::string::npos) return known;
    return stem;
}

Environment environment_of(const BenchRun& run) { return make_surroundings(run.base.environment); }

/// What is not varied by the table itself.
std::string setup_text(const BenchRun& run, const PaperTable& table, const BakeOptions& bake) {
    const std::string light = run.base.environment.file.empty()
                                  ? std::string("built-in sky")
                                  : std::filesystem::path(run.base.environment.file).filename().string();
    const bool by_samples = table.varied == "samples a pixel", draws = table.varied != "cm" || table.number > 0;
    std::string text;
    if (draws) text += std::to_string(run.base.size.width) + " x " + std::to_string(run.base.size.height) + " pixels";
    if (draws && !by_samples) text += ", " + std::to_string(field_samples(run, table.number)) + " samples each";
    if (draws) text += "; ";
    text += (table.varied == "point samples" ? "" : count_text(bake.points) + " ") + "points with " +
            std::to_string(bake.rays) + " rays each";
    if (table.varied != "cm") text += "; cells of " + fixed_text(100.0 * bake.cell_m, 0) + " cm";
    if (draws) text += "; light: " + light + ", 9 harmonics";
    return text + (run.quick ? "; quick: a small sample" : "");
}

}  // namespace

int field_samples(const BenchRun& run, int number) { return run.quick ? 32 : number == 9 ? 64 : 128; }

std::vector<FieldWay> field_ways(const BenchRun& run, const Results& results) {
    FieldWay ours;
    ours.bake.threads = results.threads();
    ours.bake.seed = run.base.seed;
    if (run.quick) {
        ours.bake.points = 40'000;
        ours.bake.rays = 32;
        ours.bake.cell_m = 1.0f;
    }
    FieldWay papers = ours;
    papers.suffix = plain;
    papers.bake.probes = 0;
    papers.bake.dilation = 1.0f;
    papers.bake.placement = Placement::random;
    papers.bake.label = LabelRule::texels;
    papers.order = RayOrder::pixel;
    return {ours, papers};
}

FieldWay with_finer_masks(FieldWay way) {
    way.suffix = finer;
    way.bake.mask_size = finer_mask;
    return way;
}

std::vector<std::string> field_scenes(const FieldMeasuring& m, const std::string& usual) {
    return m.run.scenes.empty() ? std::vector<std::string>{usual} : m.run.scenes;
}

std::shared_ptr<const FieldScene> field_scene(FieldMeasuring& m, const std::string& name) {
    std::shared_ptr<const FieldScene>& kept = m.run.field_scenes[name];
    if (kept) return kept;
    say(m.run, m.table, label_of(name) + ", reading and building");
    Session session = m.run.base;
    session.scene = name;
    auto made = std::make_shared<FieldScene>();
    made->label = label_of(name);
    made->scene = m.results.scene(session, m.progress);
    made->surfaces = m.results.surfaces(session, m.progress);
    const Environment environment = environment_of(m.run);
    m.table.notes.insert(m.table.notes.end(), environment.notes.begin(), environment.notes.end());
    made->light = rotated(project(environment), turn_about_up(turn_deg(m.run.base)));
    made->embree = build_embree_scene(made->scene->value, EmbreeUse::benchmark, m.results.threads(), m.progress);
    return kept = std::move(made);
}

std::optional<VisibilityField> bake_field(FieldMeasuring& m, const FieldScene& scene, const BakeOptions& options) {
    try {
        return bake(scene.scene->value, *scene.embree, options, m.progress);
    } catch (const EnvironmentError& error) {
        m.table.notes.push_back("Left out: " + scene.label + ", " + count_text(options.points) + " points, cells of " +
                                fixed_text(100.0 * options.cell_m, 0) + " cm: " + error.what());
        return std::nullopt;
    }
}

FieldMeasurement measure_field(FieldMeasuring& m, const FieldScene& scene, const VisibilityField& field,
                               const FieldWay& way, int samples) {
    const SamplePattern pattern = make_pattern(samples, m.run.base.seed);
    EnvironmentRequest request;
    request.surfaces = &scene.surfaces->value;
    request.pattern = &pattern;
    request.light = scene.light;
    request.culling = way.culling;
    request.order = way.order;
    request.glossy = way.roughness > 0.0f;
    request.roughness = way.roughness;
    if (request.glossy) request.sampling = Sampling::brdf;
    request.threads = m.results.threads();
    return measure(field, *scene.embree, request, m.run.repetitions, m.progress,
                   way.indirect ? &scene.scene->value : nullptr);
}

void add_field_figure(FieldMeasuring& m, const FieldScene& scene, const FieldWay& way, const FieldFigure& figure,
                      double ours, double at, const std::string& setting) {
    MeasuredRow& row = add_figure(m.table, scene.label, figure.quantity, ours, figure.unit, figure.digits, at, setting);
    row.quantity += way.suffix;
    row.in_chart = figure.in_chart;
    if (!way.suffix.empty()) row.paper.reset();
}

void finish_field_table(FieldMeasuring& m, const std::vector<FieldFigure>& figures, std::string_view setting_unit) {
    const PaperTable& known = find_table(m.table.name);
    bool added = false;
    for (const PaperFigure& printed : known.paper->figures(known.number)) {
        const bool measured = std::ranges::any_of(m.table.rows, [&](const MeasuredRow& row) {
            return row.scene == printed.scene && row.quantity == printed.quantity && row.at == printed.at;
        });
        const auto figure = std::ranges::find(figures, printed.quantity, &FieldFigure::quantity);
        if (measured || figure == figures.end()) continue;
        MeasuredRow row;
        row.scene = printed.scene;
        row.quantity = printed.quantity;
        row.at = printed.at;
        if (printed.at > 0.0)
            row.setting = count_text(static_cast<std::uint64_t>(printed.at)) + " " + std::string(setting_unit);
        row.unit = figure->unit;
        row.digits = figure->digits;
        row.paper = printed.value;
        row.in_chart = figure->in_chart;
        m.table.rows.push_back(row);
        added = true;
    }
    m.table.setup = setup_text(m.run, known, field_ways(m.run, m.results).front().bake);
    if (added)
        m.table.notes.emplace_back("A dash under ours: a scene or setting of the paper's that was not measured.");
    if (known.number > 0)
        m.table.notes.emplace_back(
            "The field runs on the CPU, and is compared with the same samples and Embree's packets without a field; "
            "the "
            "paper's ran on a GPU.");
    const auto has = [&](std::string_view suffix) {
        return std::ranges::any_of(m.table.rows,
                                   [&](const MeasuredRow& row) { return row.quantity.ends_with(suffix); });
    };
    if (has(finer)) m.table.notes.emplace_back("Finer: with masks of 32 x 32 texels instead of 18 x 18.");
    if (has(plain))
        m.table.notes.emplace_back(
            "Plain: as in the paper, with points at random, masks dilated by a texel, labels by equation 8, rays in "
            "the "
            "order of pixels; else the defaults of this program. The paper has 10 million points.");
}

}  // namespace sightlines
