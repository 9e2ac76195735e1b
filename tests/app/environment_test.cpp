// Scenes that are lit by their surroundings, through the program.
#include <algorithm>
#include <array>
#include <fstream>
#include <limits>

#include <gtest/gtest.h>

#include "app/report.h"
#include "app/selection.h"
#include "run_program.h"
#include "techniques/base/error.h"

namespace sightlines {
namespace {

namespace fs = std::filesystem;
using Arguments = std::vector<std::string>;

/// A session that is quick to make.
Session small_session() {
    Session session;
    session.scene = "cornell";
    session.size = {32, 20};
    session.technique = "visibility_field";
    session.parameters["visibility_field"] = {{"points", 2000.0}, {"rays_per_point", 16.0}, {"samples", 24.0}};
    return session;
}

ProgramRun rendered(const fs::path& folder, const Arguments& more) {
    Arguments arguments{"render",    "--technique", "visibility_field", "--size", "32x20",       "--out",
                        "a.png",     "--report",    "r.json",           "--set",  "points=2000", "rays_per_point=16",
                        "samples=24"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_program(arguments, folder);
}

Json report_in(const fs::path& folder) { return Json::parse(text_of(folder / "r.json")); }

/// A Radiance picture, 4 x 2, all texels alike: `bytes` is one of them.
void write_hdr(const fs::path& file, std::array<unsigned char, 4> texel, const std::string& size = "-Y 2 +X 4") {
    std::ofstream out(file, std::ios::binary);
    out << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n" << size << "\n";
    for (int k = 0; k < 8; ++k)
        for (const unsigned char byte : texel) out.put(static_cast<char>(byte));
}

/// A scene of the given triangles' corners, as a file with its data inside.
void write_gltf(const fs::path& file, const std::vector<float>& corners) {
    constexpr const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string bytes(reinterpret_cast<const char*>(corners.data()), corners.size() * sizeof(float)), base64;
    while (bytes.size() % 3 != 0) bytes += '\0';
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const auto at = [&](std::size_t k) { return static_cast<unsigned>(static_cast<unsigned char>(bytes[i + k])); };
        const unsigned all = at(0) << 16u | at(1) << 8u | at(2);
        for (unsigned shift : {18u, 12u, 6u, 0u}) base64 += digits[all >> shift & 63u];
    }
    vec3 low(std::numeric_limits<float>::max()), high(std::numeric_limits<float>::lowest());
    for (std::size_t i = 0; i < corners.size(); i += 3) {
        const vec3 point(corners[i], corners[i + 1], corners[i + 2]);
        low = glm::min(low, point);
        high = glm::max(high, point);
    }
    const std::size_t count = corners.size() / 3;
    const Json json = {
        {"asset", {{"version", "2.0"}}},
        {"scene", 0},
        {"scenes", {{{"nodes", {0}}}}},
        {"nodes", {{{"mesh", 0}}}},
        {"meshes", {{{"primitives", {{{"attributes", {{"POSITION", 0}}}}}}}}},
        {"accessors",
         {{{"bufferView", 0},
           {"componentType", 5126},
           {"count", count},
           {"type", "VEC3"},
           {"min", {low.x, low.y, low.z}},
           {"max", {high.x, high.y, high.z}}}}},
        {"bufferViews", {{{"buffer", 0}, {"byteLength", 12 * count}}}},
        {"buffers", {{{"byteLength", bytes.size()}, {"uri", "data:application/octet-stream;base64," + base64}}}}};
    std::ofstream(file) << json;
}

/// A floor and a wall, `side` metres long.
std::vector<float> corner_of_a_room(float side) {
    return {0, 0, 0, 0, 0, side, side, 0, 0, 0, 0, 0, side, 0, 0, 0, side, 0};
}

TEST(EnvironmentLit, TheRaysOfAPixelAreTheVerdictsOfThePictureAndOfTheReference) {
    Session session = small_session();
    session.reference = true;
    Progress progress;
    Results results(2, Backend::cpu);
    const auto ours = results.picture(session, progress), truth = results.reference(session, progress);
    int rays = 0;
    for (int y = 1; y < 20; y += 4) {
        for (int x = 2; x < 32; x += 6) {
            const auto p = static_cast<std::size_t>(y * 32 + x);
            if (ours->value.rays_asked.pixels[p] == 0) continue;
            session.selection.pixel = ivec2(x, y);
            const PixelRays of_pixel = pixel_rays(session, results, progress);
            ASSERT_EQ(of_pixel.rows.size(), ours->value.rays_asked.pixels[p]);
            for (const RayRow& row : of_pixel.rows) {
                ASSERT_EQ(row.blocked, ours->value.verdicts.blocked(p, row.light));
                ASSERT_EQ(row.truly_blocked, truth->value.verdicts.blocked(p, row.light));
                ++rays;
            }
        }
    }
    EXPECT_GT(rays, 300);
}

TEST(EnvironmentLit, PicturesKeepTheirStructureWhenTheSunMovesAndIgnoreTheLights) {
    Session session = small_session();
    Progress progress;
    Results results(2, Backend::cpu);
    const auto structure = results.structure(session, progress);
    const auto picture = results.picture(session, progress);
    session.lights.count = 12;
    EXPECT_EQ(results.picture(session, progress), picture);
    EXPECT_TRUE(results.lights(session, progress)->value.empty());
    session.environment.sun_elevation_deg = 10.0f;
    const auto low = results.picture(session, progress);
    EXPECT_NE(low->value.radiance.pixels, picture->value.radiance.pixels);
    EXPECT_EQ(results.structure(session, progress), structure);
}

TEST(EnvironmentLit, TheTracedChannelOfATechniqueThatTracesAllOrNothingSaysSo) {
    Session session = small_session();
    session.channel = Channel::rays_traced;
    Progress progress;
    Results results(2, Backend::cpu);
    const auto picture = [&](const std::string& technique) {
        session.technique = technique;
        const auto result = results.picture(session, progress);
        session.channel = Channel::rays_traced;
        const ChannelSource from{&result->value, nullptr, nullptr,
                                 rays_per_pixel(session, results.lights(session, progress)->value)};
        const ImageRgba8 traced = shown_channel(Channel::rays_traced, {}, from, {0, 0, 32, 20});
        const ImageRgba8 asked = shown_channel(Channel::rays, {}, from, {0, 0, 32, 20});
        return traced.pixels == asked.pixels;
    };
    EXPECT_TRUE(picture("ray_tracing"));
    session.parameters["voxel_rows"] = {{"resolution", 32.0}, {"angle_step", 6.0}};
    EXPECT_FALSE(picture("voxel_rows"));
    EXPECT_FALSE(picture("visibility_field"));
}

TEST(EnvironmentProgram, RendersComparesAndTracesBySky) {
    const fs::path folder = fresh_folder();
    const ProgramRun run = rendered(folder, {"--scene", "cornell", "--reference", "--sun", "30,-40", "--turn", "15",
                                             "--lights", "9", "--set", "points=40000", "rays_per_point=64"});
    ASSERT_EQ(run.exit_code, 0) << run.errors;
    EXPECT_NE(run.errors.find("lights are left out"), std::string::npos) << run.errors;
    const Json report = report_in(folder);
    EXPECT_EQ(report["samples"], 24);
    EXPECT_EQ(report["environment"]["turn_deg"], 15.0);
    EXPECT_LT(report["rays"]["traced"], report["rays"]["asked"]);
    EXPECT_LT(report["error"]["visibility_percent"].get<double>(), 2.0);
    const ProgramRun trace = run_program({"trace", "--technique", "visibility_field", "--scene", "cornell", "--size",
                                          "32x20", "--set", "points=2000", "rays_per_point=16", "samples=24"},
                                         folder);
    ASSERT_EQ(trace.exit_code, 0) << trace.errors;
    EXPECT_NE(trace.output.find("sample "), std::string::npos);
    EXPECT_NE(trace.output.find("Algorithm 2, line 8"), std::string::npos) << trace.output;
}

TEST(EnvironmentProgram, SaysThatAnEnvironmentIsLeftOutByTechniquesThatKnowLights) {
    const ProgramRun run = run_program({"render", "--technique", "ray_tracing", "--scene", "cornell", "--size", "16x9",
                                        "--sun", "10,20", "--out", "a.png"},
                                       fresh_folder());
    ASSERT_EQ(run.exit_code, 0) << run.errors;
    EXPECT_NE(run.errors.find("environment is left out"), std::string::npos) << run.errors;
}

TEST(EnvironmentProgram, TakesAFileAndIsBrighterWhereThatIs) {
    const fs::path folder = fresh_folder();
    write_hdr(folder / "grey.hdr", {128, 128, 128, 128});
    write_hdr(folder / "bright.hdr", {128, 128, 128, 131});
    const auto mean = [&](const std::string& file) {
        EXPECT_EQ(rendered(folder, {"--scene", "cornell", "--environment", file}).exit_code, 0);
        const ImageRgba8 picture = read_png(folder / "a.png");
        double sum = 0.0;
        for (const auto& pixel : picture.pixels) sum += pixel.x;
        return sum / static_cast<double>(picture.pixels.size());
    };
    const double grey = mean("grey.hdr");
    EXPECT_GT(mean("bright.hdr"), grey + 5.0);
    EXPECT_EQ(report_in(folder)["environment"]["name"], "bright.hdr");
}

TEST(EnvironmentProgram, PaintsByTheBrightestTexelsThatAFileCanHold) {
    // RGBE has no signs and no numbers that are not finite; 65504 is the largest of half floats, which many files hold.
    const fs::path folder = fresh_folder();
    write_hdr(folder / "half.hdr", {255, 255, 255, 144});
    write_hdr(folder / "largest.hdr", {255, 255, 255, 255});
    write_hdr(folder / "least.hdr", {2, 2, 2, 1});
    const auto bright_pixels = [&](const std::string& file, bool put_right) {
        const ProgramRun run = rendered(folder, {"--scene", "cornell", "--environment", file, "--reference"});
        EXPECT_EQ(run.exit_code, 0) << run.errors;
        EXPECT_EQ(run.errors.find("were put right") != std::string::npos, put_right) << run.errors;
        EXPECT_TRUE(report_in(folder)["error"]["rmse"].is_number()) << file;
        const ImageRgba8 picture = read_png(folder / "a.png");
        return std::ranges::count_if(picture.pixels, [](const auto& pixel) { return pixel.x > 250; });
    };
    EXPECT_GT(bright_pixels("half.hdr", false), 300);
    EXPECT_GT(bright_pixels("largest.hdr", true), 300);
    EXPECT_LT(bright_pixels("least.hdr", false), 100);  // the lamp
}

TEST(EnvironmentProgram, PaintsOnVulkanToo) {
    const ProgramRun devices = run_program({"list", "devices", "--json"}, fresh_folder());
    if (devices.output.find("name") == std::string::npos) GTEST_SKIP() << "no usable Vulkan device";
    const fs::path folder = fresh_folder();
    const ProgramRun run = rendered(folder, {"--scene", "cornell", "--reference", "--backend", "vulkan", "--set",
                                             "points=40000", "rays_per_point=64"});
    ASSERT_EQ(run.exit_code, 0) << run.errors;
    const Json report = report_in(folder);
    EXPECT_EQ(report["backend"], "vulkan");
    EXPECT_LT(report["rays"]["traced"], report["rays"]["asked"]);
    EXPECT_LT(report["error"]["visibility_percent"].get<double>(), 2.0);
}

TEST(EnvironmentProgram, RefusesWhatIsNoEnvironmentInOneLine) {
    const fs::path folder = fresh_folder();
    std::ofstream(folder / "text.hdr") << "not a picture";
    write_hdr(folder / "empty.hdr", {1, 1, 1, 128}, "-Y 0 +X 0");
    write_hdr(folder / "cut.hdr", {1, 1, 1, 128}, "-Y 64 +X 64");
    write_hdr(folder / "fine.hdr", {1, 1, 1, 128});
    const std::vector<Arguments> all{{"--environment", "none.hdr"},
                                     {"--environment", "text.hdr"},
                                     {"--environment", "empty.hdr"},
                                     {"--environment", "cut.hdr"},
                                     {"--environment", "fine.hdr", "--sun", "10,10"},
                                     {"--sun", "100,0"},
                                     {"--sun", "10"},
                                     {"--turn", "far"},
                                     {"--set", "cell_size=0"},
                                     {"--set", "samples=0"}};
    for (const Arguments& arguments : all) {
        Arguments more{"--scene", "cornell"};
        more.insert(more.end(), arguments.begin(), arguments.end());
        const ProgramRun run = rendered(folder, more);
        EXPECT_EQ(run.exit_code, 3) << arguments.back() << "\n" << run.errors;
        EXPECT_EQ(std::ranges::count(run.errors, '\n'), 1) << run.errors;
        EXPECT_FALSE(fs::exists(folder / "a.png"));
    }
}

TEST(EnvironmentProgram, PaintsScenesOfAnySizeOrSaysWhichCellsWouldFit) {
    const fs::path folder = fresh_folder();
    for (const float side_m : {1e-4f, 1.0f, 20.0f}) {
        write_gltf(folder / "room.gltf", corner_of_a_room(side_m));
        const ProgramRun run = rendered(folder, {"--scene", "room.gltf", "--reference", "--set", "points=100000"});
        ASSERT_EQ(run.exit_code, 0) << side_m << " " << run.errors;
        EXPECT_GT(report_in(folder)["rays"]["asked"], 0) << side_m;
        EXPECT_LT(report_in(folder)["error"]["visibility_percent"].get<double>(), 10.0) << side_m;
    }
    write_gltf(folder / "room.gltf", corner_of_a_room(1e5f));
    const ProgramRun large = rendered(folder, {"--scene", "room.gltf"});
    if (large.exit_code != 0) {
        EXPECT_EQ(large.exit_code, 4);
        EXPECT_NE(large.errors.find("would fit"), std::string::npos) << large.errors;
    }
    const ProgramRun fitting = rendered(folder, {"--scene", "room.gltf", "--set", "cell_size=1000"});
    ASSERT_EQ(fitting.exit_code, 0) << fitting.errors;
    EXPECT_GT(report_in(folder)["rays"]["asked"], 0);
}

TEST(EnvironmentProgram, PaintsASingleTriangle) {
    const fs::path folder = fresh_folder();
    write_gltf(folder / "one.gltf", {0, 0, 0, 1, 0, 0, 0, 1, 0});
    const ProgramRun run = rendered(folder, {"--scene", "one.gltf", "--reference"});
    ASSERT_EQ(run.exit_code, 0) << run.errors;
    EXPECT_GT(report_in(folder)["rays"]["asked"], 0);
    EXPECT_EQ(report_in(folder)["blocked_percent"], 0.0);
}

}  // namespace
}  // namespace sightlines
