// Pictures that are as they were when someone last looked at them and found them right.
#pragma once

#include <algorithm>
#include <filesystem>
#include <string>

#include "techniques/base/image.h"

namespace sightlines {

/// How a picture differs from tests/`folder`/golden/`name`.png; empty where it does not. Drivers round edges
/// differently: one pixel in a hundred may differ, the picture may not. Where it does, it is written where the answer
/// says.
inline std::string unlike_golden(const ImageRgba8& image, const std::string& folder, const std::string& name) {
    namespace fs = std::filesystem;
    const fs::path golden = fs::path(SIGHTLINES_SOURCE_FOLDER) / "tests" / folder / "golden" / (name + ".png");
    const fs::path candidate = fs::path(SIGHTLINES_TEST_OUTPUT_FOLDER) / (name + ".png");
    const auto differs = [&](const std::string& how) {
        fs::create_directories(candidate.parent_path());
        write_png(candidate, image);
        return how + " " + golden.string() + "; if " + candidate.string() + " is right, put it there";
    };
    if (!fs::exists(golden)) return differs("there is no");
    const ImageRgba8 expected = read_png(golden);
    if (image.size != expected.size) return differs("the size is not that of");
    std::size_t different = 0;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const glm::ivec4 difference = glm::abs(glm::ivec4(image.pixels[i]) - glm::ivec4(expected.pixels[i]));
        different += std::max({difference.r, difference.g, difference.b, difference.a}) > 24;
    }
    if (different > image.pixels.size() / 100) return differs(std::to_string(different) + " pixels differ from");
    return {};
}

}  // namespace sightlines
