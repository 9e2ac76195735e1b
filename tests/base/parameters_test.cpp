#include "techniques/base/parameters.h"

#include <array>
#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "techniques/base/error.h"

namespace sightlines {
namespace {

constexpr std::array<std::string_view, 3> methods{"direct", "fragments", "both"};

std::array<Parameter, 4> table() {
    std::array<Parameter, 4> rows;
    rows[0] = {.name = "resolution",
               .title = "Resolution",
               .unit = "voxels",
               .kind = ParameterKind::integer,
               .lowest = 32,
               .highest = 256,
               .default_value = 128,
               .paper_value = {},
               .help = ""};
    rows[1] = {.name = "angle_step",
               .title = "Angle step",
               .unit = "deg",
               .kind = ParameterKind::real,
               .lowest = 1,
               .highest = 6,
               .default_value = 2,
               .paper_value = {},
               .help = ""};
    rows[2] = {.name = "two_subrays",
               .title = "Two subrays",
               .unit = "",
               .kind = ParameterKind::boolean,
               .lowest = 0,
               .highest = 1,
               .default_value = 0,
               .paper_value = {},
               .help = ""};
    rows[3] = {.name = "build",
               .title = "Build",
               .unit = "",
               .kind = ParameterKind::choice,
               .lowest = 0,
               .highest = 2,
               .default_value = 1,
               .paper_value = {},
               .help = "",
               .choices = methods};
    return rows;
}

std::string complaint(std::string_view name, std::string_view text) {
    try {
        parse_parameter(table(), name, text);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

TEST(Parameters, ComeFromTheValuesElseFromTheTable) {
    const ParameterValues values{{"resolution", 64.0}};
    EXPECT_EQ(parameter_value(table(), values, "resolution"), 64.0);
    EXPECT_EQ(parameter_value(table(), values, "angle_step"), 2.0);
}

TEST(Parameters, AreReadAsPeopleWriteThem) {
    EXPECT_EQ(parse_parameter(table(), "resolution", "96"), 96.0);
    EXPECT_EQ(parse_parameter(table(), "angle_step", "1.5"), 1.5);
    EXPECT_EQ(parse_parameter(table(), "two_subrays", "true"), 1.0);
    EXPECT_EQ(parse_parameter(table(), "two_subrays", "off"), 0.0);
    EXPECT_EQ(parse_parameter(table(), "build", "fragments"), 1.0);
}

TEST(Parameters, AcceptTheEndsOfTheirRange) {
    EXPECT_EQ(parse_parameter(table(), "resolution", "32"), 32.0);
    EXPECT_EQ(parse_parameter(table(), "resolution", "256"), 256.0);
}

TEST(Parameters, NameTheRangeOfAValueOutsideIt) {
    EXPECT_EQ(complaint("resolution", "257"), "parameter resolution: 257 is outside its range (give 32 to 256 voxels)");
    EXPECT_EQ(complaint("angle_step", "-1"), "parameter angle_step: -1 is outside its range (give 1 to 6 deg)");
}

TEST(Parameters, RefuseWhatIsNoNumberOrNotFiniteOrNotWhole) {
    for (const char* text : {"", "abc", "12x", "1,5", "nan", "inf", "-inf", "1e999", "--5"})
        EXPECT_NE(complaint("angle_step", text), "") << text;
    EXPECT_NE(complaint("resolution", "128.5").find("not a whole number"), std::string::npos);
}

TEST(Parameters, OfferTheNearestNameAndChoice) {
    EXPECT_EQ(complaint("resoluton", "64"), "parameter resoluton: is not known (did you mean resolution?)");
    EXPECT_EQ(complaint("qqqqqq", "64"),
              "parameter qqqqqq: is not known (there are: resolution, angle_step, two_subrays, build)");
    EXPECT_EQ(complaint("build", "fragment"), "parameter build: has no choice fragment (did you mean fragments?)");
    EXPECT_NE(complaint("build", "qqqqqqqq").find("there are: direct, fragments, both"), std::string::npos);
    EXPECT_NE(complaint("two_subrays", "perhaps"), "");
}

TEST(Parameters, AreWrittenAsTheyAreRead) {
    for (const auto& [name, text] : {std::pair{"resolution", "128"},
                                     {"angle_step", "1.5"},
                                     {"angle_step", "3"},
                                     {"two_subrays", "true"},
                                     {"two_subrays", "false"},
                                     {"build", "both"}}) {
        const auto rows = table();
        for (const Parameter& row : rows)
            if (row.name == name) {
                EXPECT_EQ(parameter_text(row, parse_parameter(rows, name, text)), text);
            }
    }
}

TEST(Parameters, OfASessionAreCheckedAgainstTheTable) {
    EXPECT_NO_THROW(check_parameters(table(), {}));
    EXPECT_NO_THROW(check_parameters(table(), {{"resolution", 64.0}, {"angle_step", 1.25}}));
    EXPECT_THROW(check_parameters(table(), {{"unknown", 1.0}}), InputError);
    EXPECT_THROW(check_parameters(table(), {{"resolution", 64.5}}), InputError);
    EXPECT_THROW(check_parameters(table(), {{"build", 3.0}}), InputError);
    EXPECT_THROW(check_parameters(table(), {{"two_subrays", 0.5}}), InputError);
    EXPECT_THROW(check_parameters(table(), {{"angle_step", std::nan("")}}), InputError);
}

}  // namespace
}  // namespace sightlines
