#include <algorithm>
#include <cstdio>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "app/bench_first_hits.h"
#include "app/bench_output.h"
#include "app/bench_shadow_rays.h"
#include "app/bench_tables.h"
#include "app/commands/commands.h"
#include "app/commands/flags.h"
#include "techniques/base/error.h"
#include "techniques/base/files.h"

namespace sightlines {
namespace {

struct BenchFlags {
    std::string table, repetitions;
    SessionFlags session;
    CommonFlags common;
    std::filesystem::path out;
    bool quick = false;
};

/// The session that a table is measured on where the flags leave it open: the main job's lights, and a picture that is
/// large enough to be steady (small with --quick).
Session bench_session(const BenchFlags& flags) {
    Session session;
    session.lights.count = flags.quick ? 256 : 1024;
    session.size = flags.quick ? ImageSize{160, 90} : ImageSize{480, 270};
    return session_with_flags(session, flags.session);
}

int repetitions_of(const BenchFlags& flags, int when_quick, int otherwise) {
    if (flags.repetitions.empty()) return flags.quick ? when_quick : otherwise;
    return static_cast<int>(whole_number("--repetitions", flags.repetitions, 1, 1000));
}

/// A bench of its own, as the command prints it, and as JSON.
struct BenchOutput {
    std::string text;
    Json json;
    std::vector<std::string> notes;
};

/// Writes what was measured into the folder, where one is asked for.
BenchOutput written(const BenchFlags& flags, const std::string& name, const auto& bench) {
    const TextTable table = table_from_bench(bench);
    const Json json = json_from_bench(bench);
    if (!flags.out.empty()) {
        make_folder(flags.out);
        write_file(flags.out / (name + ".csv"), csv_from(table));
        write_file(flags.out / (name + ".md"), heading_from_bench(bench) + "\n" + markdown_from(table));
        write_file(flags.out / (name + ".json"), json_text(json));
    }
    return {heading_from_bench(bench) + "\n" + text_from(table), json, {}};
}

BenchOutput run_shadow_rays(const BenchFlags& flags, Progress& progress) {
    const Session session = bench_session(flags);
    const int repetitions = repetitions_of(flags, 3, 7);
    Results results(thread_flag(flags.common), command_backend(session));
    const ShadowRayBench bench = bench_shadow_rays(session, repetitions, results, progress);
    progress.check();
    BenchOutput output = written(flags, "shadow-rays", bench);
    output.notes = bench.notes;
    return output;
}

BenchOutput run_first_hits(const BenchFlags& flags, Progress& progress) {
    Session session = bench_session(flags);
    session.backend = BackendChoice::cpu;
    if (session.technique != "voxel_rows") throw InputError("--technique", "", "has no first hits", "leave it out");
    session.parameters["voxel_rows"].try_emplace("first_hits", 1.0);  // then objects that move are in the array
    Results results(thread_flag(flags.common), Backend::cpu);
    return written(flags, "first-hits", bench_first_hits(session, results, progress));
}

/// What the papers' tables are measured with where the flags leave it open.
BenchRun table_run(const BenchFlags& flags) {
    if (!flags.session.technique.empty() && flags.session.technique != "voxel_rows")
        throw InputError("--technique", "", "is not for this table, which says itself what it compares",
                         "leave it out");
    BenchRun run;
    run.quick = flags.quick;
    run.repetitions = repetitions_of(flags, 1, 3);
    run.own_lights = !flags.quick && flags.session.lights.empty();
    run.base.lights.count = flags.quick ? 128 : 1024;
    run.base.size = flags.quick ? ImageSize{160, 90} : ImageSize{480, 270};
    if (flags.quick) run.base.parameters["voxel_rows"] = {{"resolution", 64.0}, {"angle_step", 6.0}};
    run.base = session_with_flags(run.base, flags.session);
    make_surroundings(run.base.environment);  // a bad one is refused now, not hours later
    if (!flags.session.scene.empty()) run.scenes = {run.base.scene};
    if (!flags.common.quiet)
        run.say = [](const std::string& what) { std::fprintf(stderr, "sightlines: %s\n", what.c_str()); };
    return run;
}

/// Each table's files are written as soon as it is measured.
std::vector<BenchOutput> run_tables(const BenchFlags& flags, std::span<const PaperTable> tables, Progress& progress) {
    BenchRun run = table_run(flags);
    Results results(thread_flag(flags.common), command_backend(run.base));
    std::vector<BenchOutput> outputs;
    for (const PaperTable& table : tables) {
        const MeasuredTable measured = measure_table(table, run, results, progress);
        progress.check();
        if (!flags.out.empty()) {
            make_folder(flags.out);
            write_measured(measured, flags.out);
        }
        outputs.push_back({text_from_measured(measured), json_from_measured(measured), {}});
    }
    return outputs;
}

CommandOutput run_bench(const BenchFlags& flags, Progress& progress) {
    if (!flags.out.empty()) check_folder(flags.out);
    std::vector<BenchOutput> outputs;
    if (flags.table == "all") {
        outputs = run_tables(flags, paper_tables(), progress);
        outputs.insert(outputs.begin(), {run_shadow_rays(flags, progress), run_first_hits(flags, progress)});
    } else if (flags.table == "first-hits") {
        outputs.push_back(run_first_hits(flags, progress));
    } else if (flags.table == "shadow-rays") {
        outputs.push_back(run_shadow_rays(flags, progress));
    } else if (flags.table.ends_with("/all")) {
        outputs =
            run_tables(flags, tables_of(std::string_view(flags.table).substr(0, flags.table.find('/'))), progress);
    } else {
        outputs = run_tables(flags, {&find_table(flags.table), 1}, progress);
    }
    CommandOutput output;
    Json all = Json::array();
    for (const BenchOutput& each : outputs) {
        output.text += (output.text.empty() ? "" : "\n") + each.text;
        output.notes.insert(output.notes.end(), each.notes.begin(), each.notes.end());
        all.push_back(each.json);
    }
    if (flags.common.quiet && !flags.out.empty()) output.text.clear();
    if (flags.common.json) output.text = json_text(outputs.size() == 1 ? all.front() : all);
    return output;
}

/// CLI11's form: what is wrong with the name, empty where nothing is.
std::string wrong_table(const std::string& name) {
    std::vector<std::string> names{"shadow-rays", "first-hits", "voxel-rows/all", "visibility-field/all", "all"};
    for (const PaperTable& table : paper_tables()) names.emplace_back(table.name);
    if (std::ranges::find(names, name) != names.end()) return "";
    const std::string near = nearest_name(name, names);
    return name + " is not known" + (near.empty() ? "" : ": did you mean " + near + "?");
}

/// One line for each table.
std::string listed_tables() {
    std::string text =
        "Tables:\n  shadow-rays               voxel rows on both backends against Embree in every variant\n"
        "  first-hits                where rays hit first by voxel rows, against Embree\n";
    for (const PaperTable& table : paper_tables()) {
        const std::string name(table.name);
        text +=
            "  " + name + std::string(name.size() < 26 ? 26 - name.size() : 1, ' ') + std::string(table.title) + "\n";
    }
    return text +
           "  voxel-rows/all            those of the one technique\n"
           "  visibility-field/all      those of the other\n"
           "  all                       all of these\n";
}

}  // namespace

void add_bench_command(CLI::App& app, Command& chosen) {
    CLI::App& command = *app.add_subcommand("bench", "Measure: medians of interleaved repetitions");
    const auto flags = std::make_shared<BenchFlags>();
    command.add_option("table", flags->table, "One of those below, or all")
        ->required()
        ->check(wrong_table, "", "TABLE");
    add_session_flags(command, flags->session);
    command.add_option("--repetitions", flags->repetitions, "How often each is measured; the median counts")
        ->type_name("R");
    command.add_flag("--quick", flags->quick, "A small picture with few lights: shows that it works, measures little");
    command
        .add_option("--out", flags->out,
                    "Write each table into this folder: Markdown and CSV, and a chart (SVG) or JSON")
        ->type_name("FOLDER");
    add_common_flags(command, flags->common);
    command.footer("Example:\n  sightlines bench shadow-rays --scene atrium --lights 1024 --size 480x270\n\n" +
                   listed_tables());
    command.callback([flags, &chosen] {
        chosen = {[flags](Progress& progress) { return run_bench(*flags, progress); }, flags->common.quiet};
    });
}

}  // namespace sightlines
