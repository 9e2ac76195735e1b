// One line a frame: how long it took, and what was being made meanwhile.
#pragma once

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>

namespace sightlines {

/// CSV with the columns frame, start_s (since the log began), milliseconds (from the end of the wait for events until
/// the picture was drawn and handed to the screen), working (stages under way, separated by "; ").
struct FrameLog {
    std::ofstream file;
    std::chrono::steady_clock::time_point began;
    std::uint64_t frames = 0;
};

/// EnvironmentError where the file cannot be written. An empty path gives a log that writes nothing.
FrameLog open_frame_log(const std::filesystem::path& file);
void log_frame(FrameLog& log, std::chrono::steady_clock::time_point start, const std::string& working);

}  // namespace sightlines
