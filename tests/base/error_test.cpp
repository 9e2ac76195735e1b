#include "techniques/base/error.h"

#include <array>
#include <string_view>

#include <gtest/gtest.h>

namespace sightlines {
namespace {

TEST(InputError, SaysFilePlaceProblemAndRemedyOnOneLine) {
    const InputError error("a.glb", "accessors[3]", "reaches past its view", "write the file again");
    EXPECT_STREQ(error.what(), "a.glb: accessors[3]: reaches past its view (write the file again)");
    EXPECT_EQ(error.where, "a.glb");
    EXPECT_EQ(error.place, "accessors[3]");
    EXPECT_EQ(error.problem, "reaches past its view");
    EXPECT_EQ(error.remedy, "write the file again");
}

TEST(InputError, LeavesOutWhatIsEmpty) {
    EXPECT_STREQ(InputError("a.glb", "", "is empty").what(), "a.glb: is empty");
    EXPECT_STREQ(InputError("", "", "is empty").what(), "is empty");
    EXPECT_STREQ(InputError("", "line 3", "is empty").what(), "line 3: is empty");
}

TEST(InputError, StaysOnOnePrintableLineWhateverTheFileIsCalled) {
    const std::string line = InputError("evil\nname\x1b[31m\x7f", "a\tb", "c\rd").what();
    for (const char letter : line) EXPECT_TRUE(letter >= 0x20 && letter != 0x7f) << line;
}

TEST(EnvironmentError, SaysItsPartsOnOneLine) {
    EXPECT_STREQ(EnvironmentError("out/a.png", "disk full", "make room").what(), "out/a.png: disk full (make room)");
    EXPECT_STREQ(EnvironmentError("Vulkan", "no device").what(), "Vulkan: no device");
}

TEST(EditDistance, CountsInsertionsDeletionsReplacementsAndSwaps) {
    EXPECT_EQ(edit_distance("", ""), 0);
    EXPECT_EQ(edit_distance("abc", "abc"), 0);
    EXPECT_EQ(edit_distance("", "abc"), 3);
    EXPECT_EQ(edit_distance("abc", ""), 3);
    EXPECT_EQ(edit_distance("atrum", "atrium"), 1);
    EXPECT_EQ(edit_distance("atirum", "atrium"), 1);
    EXPECT_EQ(edit_distance("kitten", "sitting"), 3);
}

TEST(NearestName, OffersTheNameThatWasMeantAndNoneWhenNothingIsNear) {
    const std::array<std::string_view, 3> names{"cornell", "atrium", "trees"};
    EXPECT_EQ(nearest_name("atrum", names), "atrium");
    EXPECT_EQ(nearest_name("tree", names), "trees");
    EXPECT_EQ(nearest_name("cronell", names), "cornell");
    EXPECT_EQ(nearest_name("sponza", names), "");
    EXPECT_EQ(nearest_name("anything", std::array<std::string_view, 0>{}), "");
}

}  // namespace
}  // namespace sightlines
