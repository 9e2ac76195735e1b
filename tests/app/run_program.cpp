#include "run_program.h"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <thread>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <gtest/gtest.h>

namespace sightlines {

namespace fs = std::filesystem;
namespace {

void set(const std::string& name, const std::optional<std::string>& value) {
    if (value)
        setenv(name.c_str(), value->c_str(), 1);
    else
        unsetenv(name.c_str());
}

}  // namespace

std::string text_of(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
}

std::vector<std::string> files_in(const fs::path& folder) {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename().string());
    std::ranges::sort(names);
    return names;
}

VariableSet::VariableSet(const std::string& name_, const std::optional<std::string>& value) : name(name_) {
    if (const char* const text = std::getenv(name.c_str())) before = text;
    set(name, value);
}

VariableSet::~VariableSet() { set(name, before); }

fs::path fresh_folder() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    std::string name = std::string(test->test_suite_name()) + "." + test->name();
    std::ranges::replace(name, '/', '-');
    const fs::path folder = fs::path(SIGHTLINES_TEST_OUTPUT_FOLDER) / name;
    fs::remove_all(folder);
    fs::create_directories(folder);
    return folder;
}

ProgramRun run_program(const std::vector<std::string>& arguments, const fs::path& folder,
                       std::optional<SendSignal> send) {
    const fs::path logs = fs::path(folder.string() + ".logs");
    fs::create_directories(logs);
    const std::string out = (logs / "stdout").string(), err = (logs / "stderr").string();
    std::vector<char*> argv{const_cast<char*>(SIGHTLINES_PROGRAM)};
    for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    const pid_t child = fork();
    if (child == 0) {
        const int out_file = open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
        const int err_file = open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
        if (chdir(folder.c_str()) != 0 || dup2(out_file, STDOUT_FILENO) < 0 || dup2(err_file, STDERR_FILENO) < 0)
            _exit(126);
        execv(SIGHTLINES_PROGRAM, argv.data());
        _exit(127);
    }
    if (send) {
        std::this_thread::sleep_for(std::chrono::duration<double>(send->after_s));
        kill(child, send->signal);
    }
    int status = 0;
    waitpid(child, &status, 0);
    ProgramRun run;
    run.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    run.output = text_of(out);
    run.errors = text_of(err);
    return run;
}

}  // namespace sightlines
