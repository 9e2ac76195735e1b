#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "app/bench_shadow_rays.h"
#include "app/commands/commands.h"
#include "app/commands/flags.h"
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

CommandOutput run_bench(const BenchFlags& flags, Progress& progress) {
    const Session session = bench_session(flags);
    const int repetitions = flags.repetitions.empty()
                                ? (flags.quick ? 3 : 7)
                                : static_cast<int>(whole_number("--repetitions", flags.repetitions, 1, 1000));
    if (!flags.out.empty()) check_folder(flags.out);
    Results results(thread_flag(flags.common), command_backend(session));
    const ShadowRayBench bench = bench_shadow_rays(session, repetitions, results, progress);
    progress.check();
    const TextTable table = table_from_bench(bench);
    const std::string json = json_text(json_from_bench(bench));
    if (!flags.out.empty()) {
        make_folder(flags.out);
        write_file(flags.out / "shadow-rays.csv", csv_from(table));
        write_file(flags.out / "shadow-rays.md", heading_from_bench(bench) + "\n" + markdown_from(table));
        write_file(flags.out / "shadow-rays.json", json);
    }
    if (flags.common.json) return {json, bench.notes};
    return {flags.common.quiet && !flags.out.empty() ? "" : heading_from_bench(bench) + "\n" + text_from(table),
            bench.notes};
}

}  // namespace

void add_bench_command(CLI::App& app, Command& chosen) {
    CLI::App& command = *app.add_subcommand("bench", "Measure: medians of interleaved repetitions");
    const auto flags = std::make_shared<BenchFlags>();
    command
        .add_option("table", flags->table,
                    "shadow-rays (voxel rows on both backends against Embree in every variant), or all")
        ->required()
        ->check(CLI::IsMember({"shadow-rays", "all"}));
    add_session_flags(command, flags->session);
    command.add_option("--repetitions", flags->repetitions, "How often each is measured; the median counts")
        ->type_name("R");
    command.add_flag("--quick", flags->quick, "A small picture with few lights: shows that it works, measures little");
    command.add_option("--out", flags->out, "Write the table as CSV, Markdown and JSON into this folder")
        ->type_name("FOLDER");
    add_common_flags(command, flags->common);
    command.footer("Example:\n  sightlines bench shadow-rays --scene atrium --lights 1024 --size 480x270");
    command.callback([flags, &chosen] {
        chosen = {[flags](Progress& progress) { return run_bench(*flags, progress); }, flags->common.quiet};
    });
}

}  // namespace sightlines
