// One line a case: what is typed, what the shell gets back, and what stands on standard error or output.
#include <algorithm>
#include <ostream>
#include <regex>

#include <gtest/gtest.h>

#include "run_program.h"

namespace sightlines {
namespace {

struct Case {
    const char* name;
    std::vector<std::string> arguments;
    int exit_code;
    const char* errors;  ///< regular expression, to be found in standard error
    const char* output;  ///< the same for standard output
};

void PrintTo(const Case& row, std::ostream* stream) { *stream << row.name; }

/// Flags of the smallest picture that shows anything.
std::vector<std::string> small(std::vector<std::string> arguments) {
    for (const char* flag :
         {"--scene", "cornell", "--size", "64x36", "--lights", "8", "--set", "resolution=32", "angle_step=6"})
        arguments.emplace_back(flag);
    return arguments;
}

const Case cases[] = {
    {"Help", {"--help"}, 0, "^$", "Example:\n  sightlines render"},
    {"HelpOfList", {"list", "--help"}, 0, "^$", "Example:\n  sightlines list"},
    {"HelpOfRender", {"render", "--help"}, 0, "^$", "Example:\n  sightlines render"},
    {"HelpOfTrace", {"trace", "--help"}, 0, "^$", "Example:\n  sightlines trace"},
    {"HelpOfFigure", {"figure", "--help"}, 0, "^$", "Example:\n  sightlines figure"},
    {"HelpOfBench", {"bench", "--help"}, 0, "^$", "Example:\n  sightlines bench"},
    {"HelpOfWorkspace", {"workspace", "--help"}, 0, "^$", "Example:\n  sightlines workspace"},
    {"UnknownCommand", {"rendr"}, 2, "^sightlines: rendr: is not known here \\(did you mean render\\?\\)\n$", "^$"},
    {"UnknownFlag",
     {"render", "--sice", "1x1", "--out", "a.png"},
     2,
     "--sice: is not known.*did you mean --size",
     "^$"},
    {"MissingArgument", {"render", "--out"}, 2, "^sightlines: .*--out", "^$"},
    {"MissingOut", {"render", "--scene", "cornell"}, 2, "^sightlines: --out is required", "^$"},
    {"EmptyFlag", {"render", "--scene", "", "--out", "a.png"}, 2, "^sightlines: --scene", "^$"},
    {"UnknownList", {"list", "scene"}, 2, "^sightlines: what: ", "^$"},
    {"UnknownTable", {"bench", "light-rays"}, 2, "^sightlines: table: ", "^$"},
    {"ListScenes", {"list", "scenes"}, 0, "^$", "cornell[^]*atrium[^]*trees"},
    {"ListTechniques", {"list", "techniques", "--json"}, 0, "^$", "\"name\": \"voxel_rows\""},
    {"ListLessons", {"list", "lessons"}, 0, "^$", "^There are no lessons yet.\n$"},
    {"ListLessonsJson", {"list", "lessons", "--json"}, 0, "^$", "^\\[\\]\n$"},
    {"ListFigures", {"list", "figures"}, 0, "^$", "voxel-row"},
    {"ListParameters", {"list", "parameters", "--technique", "voxel_rows"}, 0, "^$", "resolution +128 +32 to 256"},
    {"ListParametersOfNone", {"list", "parameters", "--technique", "voxel_row"}, 3, "did you mean voxel_rows", "^$"},
    {"ListDevices", {"list", "devices"}, 0, "", "--backend automatic is|no Vulkan driver"},
    {"BadSize", {"render", "--size", "0x5", "--out", "a.png"}, 3, "^sightlines: --size: '0x5' is not", "^$"},
    {"HugeSize", {"render", "--size", "16384x16384", "--out", "a.png"}, 3, "--size: 16384x16384 is too large", "^$"},
    {"WordSize", {"render", "--size", "large", "--out", "a.png"}, 3, "--size: 'large'.*640x360", "^$"},
    {"NegativeLights", {"render", "--lights", "-1", "--out", "a.png"}, 3, "^sightlines: --lights: '-1'", "^$"},
    {"TooManyLights", {"render", "--lights", "65537", "--out", "a.png"}, 3, "give 0 to 65536", "^$"},
    {"BadVirtualLights", {"render", "--virtual-lights", "-1", "--out", "a.png"}, 3, "--virtual-lights: '-1'", "^$"},
    {"HalfALight", {"render", "--lights", "1.5", "--out", "a.png"}, 3, "--lights: '1.5'", "^$"},
    {"BadPlacement", {"render", "--placement", "spere", "--out", "a.png"}, 3, "did you mean sphere", "^$"},
    {"BadTime", {"render", "--time", "nan", "--out", "a.png"}, 3, "--time: 'nan'", "^$"},
    {"BadSeed", {"render", "--seed", "-1", "--out", "a.png"}, 3, "--seed: '-1'", "^$"},
    {"BadThreads", {"render", "--threads", "0", "--out", "a.png"}, 3, "--threads: '0'", "^$"},
    {"BadBackend", {"render", "--backend", "vulcan", "--out", "a.png"}, 3, "did you mean vulkan", "^$"},
    {"UnknownTechnique", {"render", "--technique", "voxelrows", "--out", "a.png"}, 3, "did you mean voxel_rows", "^$"},
    {"UnknownScene", {"render", "--scene", "atrum", "--out", "a.png"}, 3, "^sightlines: .*atrum.*atrium", "^$"},
    {"MissingScene", {"render", "--scene", "no/such.glb", "--out", "a.png"}, 3, "no/such.glb", "^$"},
    {"UnknownParameter", {"render", "--set", "resolutoin=64", "--out", "a.png"}, 3, "did you mean resolution", "^$"},
    {"ParameterOutOfRange", {"render", "--set", "resolution=31", "--out", "a.png"}, 3, "resolution.*32 to 256", "^$"},
    {"ParameterWithoutValue", {"render", "--set", "resolution", "--out", "a.png"}, 3, "not name=value", "^$"},
    {"UnknownCamera", small({"render", "--camera", "nowhere", "--out", "a.png"}), 3, "nowhere", "^$"},
    {"CameraPose", small({"trace", "--pixel", "32,18", "--camera", "2.78,2.73,-8:2.78,2.73,2.8:40"}), 0, "", "."},
    {"CameraPoseCutShort", small({"trace", "--pixel", "32,18", "--camera", "1,2,3:4,5"}), 3,
     "^sightlines: --camera: '1,2,3:4,5' is not x,y,z:tx,ty,tz", "^$"},
    {"CameraPoseOfWords", small({"trace", "--camera", "1,2,x:4,5,6"}), 3, "--camera: .*a number .*part 3", "^$"},
    {"CameraPoseWithoutView", small({"trace", "--camera", "1,2,3:1,9,3"}), 3, "--camera: .*straight up", "^$"},
    {"CameraPoseTooWide", small({"trace", "--camera", "1,2,3:4,5,6:171"}), 3, "--camera: .*1 to 170", "^$"},
    {"NoFolder", {"render", "--out", "no/such/a.png"}, 4, "no/such does not exist", "^$"},
    {"OutIsFolder", {"render", "--out", "."}, 3, "ends in", "^$"},
    {"WrongExtension", {"render", "--out", "a.jpg"}, 3, "a.jpg: .*\\.png or \\.hdr", "^$"},
    {"SameFileTwice", {"render", "--out", "a.png", "--error-out", "./a.png"}, 3, "two outputs", "^$"},
    {"UnwritableReport", {"render", "--out", "a.png", "--report", "no/r.json"}, 4, "no does not exist", "^$"},
    {"PixelOutside", small({"trace", "--pixel", "64,0"}), 3, "--pixel: 64,0 lies outside.*63,35", "^$"},
    {"PixelMalformed", small({"trace", "--pixel", "64"}), 3, "--pixel: '64' is not two", "^$"},
    {"LightMissing", small({"trace", "--pixel", "32,30", "--light", "8"}), 3, "--light: 8 does not exist .0 to 7",
     "^$"},
    {"RayMissing", small({"trace", "--pixel", "32,30", "--ray", "99"}), 3, "--ray: '99'", "^$"},
    {"RayWithoutPixel", small({"trace", "--ray", "0"}), 3, "--ray: .*--pixel", "^$"},
    {"UnknownFigure", small({"figure", "voxel-raw", "--out", "f"}), 3, "did you mean voxel-row", "^$"},
    {"UnknownFormat", small({"figure", "voxel-row", "--format", "gif", "--out", "f"}), 3, "gif", "^$"},
    {"BadDpi", small({"figure", "voxel-row", "--dpi", "1e9", "--out", "f"}), 3, "--dpi", "^$"},
    {"BadRepetitions", {"bench", "shadow-rays", "--repetitions", "0"}, 3, "--repetitions", "^$"},
    {"WorkspaceMissing", {"workspace", "none.json", "--render", "a.png"}, 3, "none.json: no such file", "^$"},
    {"WorkspaceTwice", {"workspace", "s.json", "--render", "a.png", "--figure", "voxel-row"}, 2, "excludes", "^$"},
};

class CommandLine : public testing::TestWithParam<Case> {};

TEST_P(CommandLine, EndsWithItsExitCodeAndOneLine) {
    const Case& row = GetParam();
    const auto folder = fresh_folder();
    const ProgramRun run = run_program(row.arguments, folder);
    EXPECT_EQ(run.exit_code, row.exit_code) << run.errors;
    EXPECT_TRUE(std::regex_search(run.errors, std::regex(row.errors))) << run.errors;
    EXPECT_TRUE(std::regex_search(run.output, std::regex(row.output))) << run.output;
    if (row.exit_code == 0) return;
    EXPECT_EQ(std::count(run.errors.begin(), run.errors.end(), '\n'), 1) << run.errors;
    EXPECT_TRUE(files_in(folder).empty()) << files_in(folder).front();
}

INSTANTIATE_TEST_SUITE_P(, CommandLine, testing::ValuesIn(cases),
                         [](const testing::TestParamInfo<Case>& row) { return std::string(row.param.name); });

}  // namespace
}  // namespace sightlines
