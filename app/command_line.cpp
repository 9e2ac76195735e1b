#include "app/command_line.h"

#include <cstdio>
#include <iostream>
#include <new>
#include <string>
#include <vector>

#include <unistd.h>

#include <CLI/CLI.hpp>

#include "app/commands/commands.h"
#include "app/watch.h"

namespace sightlines {
namespace {

void complain(const std::string& message) { std::fprintf(stderr, "sightlines: %s\n", message.c_str()); }

/// One line for a malformed command line. CLI11's messages may hold several.
std::string one_line(std::string message) {
    for (char& letter : message)
        if (static_cast<unsigned char>(letter) < 0x20) letter = ' ';
    return message;
}

/// What the user may have meant by an argument that nothing expects: a command, or a flag of the command given.
std::string nearest_argument(const CLI::App& app, const std::string& wrong) {
    std::vector<std::string> names;
    const auto chosen = app.get_subcommands();
    if (chosen.empty())
        for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
    else
        for (const CLI::Option* option : chosen.front()->get_options()) names.push_back(option->get_name());
    return nearest_name(wrong, names);
}

/// EnvironmentError where standard output cannot take it (a full disk).
void print(const std::string& text) {
    if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
        throw EnvironmentError("standard output", "cannot be written", "is the disk full?");
}

ExitCode refuse_command_line(const CLI::App& app, const CLI::ParseError& error) {
    const auto chosen = app.get_subcommands();
    const std::string help = "see sightlines " + (chosen.empty() ? "" : chosen.front()->get_name() + " ") + "--help";
    const std::vector<std::string> extra = app.remaining(true);
    if (extra.empty()) {
        complain(one_line(error.what()) + " (" + help + ")");
        return ExitCode::bad_command_line;
    }
    const std::string near = nearest_argument(app, extra.front());
    complain(one_line(extra.front()) + ": is not known here (" + (near.empty() ? help : "did you mean " + near + "?") +
             ")");
    return ExitCode::bad_command_line;
}

/// Runs the command; its end, whatever it is, becomes an exit code.
ExitCode run(const Command& command) {
    try {
        CommandOutput output;
        run_watched([&](Progress& progress) { output = command.work(progress); },
                    !command.quiet && isatty(STDERR_FILENO) == 1);
        for (const std::string& note : output.notes)
            if (!command.quiet) complain(one_line("note: " + note));
        print(output.text);
        return ExitCode::success;
    } catch (const InputError& error) {
        complain(error.what());
        return ExitCode::bad_input;
    } catch (const EnvironmentError& error) {
        complain(error.what());
        return ExitCode::environment;
    } catch (const Cancelled&) {
        complain("stopped");
        return ExitCode::cancelled;
    } catch (const std::bad_alloc&) {
        complain("out of memory (a smaller picture, fewer lights or a lower resolution)");
        return ExitCode::environment;
    } catch (const std::exception& error) {
        complain(one_line(std::string("our own fault, please report it: ") + error.what()));
        return ExitCode::our_fault;
    }
}

}  // namespace

ExitCode run_command_line(int argc, const char* const* argv) {
    CLI::App app("Sightlines: how renderers decide what can see what");
    Command chosen;
    app.require_subcommand(0, 1);
    app.footer(
        "Without a command: opens the window.\n\n"
        "Example:\n  sightlines render --scene atrium --lights 1024 --size 640x360 --out atrium.png");
    add_window_flags(app, chosen);
    add_list_command(app, chosen);
    add_render_command(app, chosen);
    add_trace_command(app, chosen);
    add_figure_command(app, chosen);
    add_bench_command(app, chosen);
    add_workspace_command(app, chosen);
    add_sample_command(app, chosen);
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& asked_for_help) {
        return static_cast<ExitCode>(app.exit(asked_for_help));
    } catch (const CLI::ParseError& error) {
        return refuse_command_line(app, error);
    }
    return run(chosen);
}

}  // namespace sightlines
