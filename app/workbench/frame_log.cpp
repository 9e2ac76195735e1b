#include "app/workbench/frame_log.h"

#include <algorithm>

#include "app/table.h"
#include "techniques/base/error.h"

namespace sightlines {

FrameLog open_frame_log(const std::filesystem::path& file) {
    FrameLog log{{}, std::chrono::steady_clock::now(), 0};
    if (file.empty()) return log;
    log.file.open(file);
    log.file << "frame,start_s,milliseconds,working\n";
    if (!log.file.flush())
        throw EnvironmentError(file.string(), "cannot be written", "name another file with --frame-log");
    return log;
}

void log_frame(FrameLog& log, std::chrono::steady_clock::time_point start, const std::string& working) {
    if (!log.file.is_open()) return;
    const auto seconds = [](auto duration) { return std::chrono::duration<double>(duration).count(); };
    std::string quoted = working;
    std::ranges::replace(quoted, '"', '\'');
    log.file << log.frames++ << ',' << fixed_text(seconds(start - log.began), 4) << ','
             << fixed_text(1.0e3 * seconds(std::chrono::steady_clock::now() - start), 3) << ",\"" << quoted << '"'
             << std::endl;
}

}  // namespace sightlines
