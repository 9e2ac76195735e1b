#include "app/table.h"

#include <gtest/gtest.h>

namespace sightlines {
namespace {

TEST(Table, AlignsColumnsByCharactersNotBytes) {
    const TextTable table{{"name", "n"}, {TableAlign::left, TableAlign::right}, {{"ε", "1"}, {"abcdef", "23"}}};
    EXPECT_EQ(text_from(table), "name     n\nε        1\nabcdef  23\n");
    EXPECT_EQ(text_from({{}, {}, {{"a", ""}}}, 2), "  a\n");
}

TEST(Table, QuotesCsvCellsThatNeedIt) {
    EXPECT_EQ(csv_from({{"a", "b"}, {}, {{"x,y", "say \"so\""}}}), "a,b\n\"x,y\",\"say \"\"so\"\"\"\n");
}

TEST(Table, MarksRightAlignedColumnsInMarkdown) {
    EXPECT_EQ(markdown_from({{"a", "b"}, {TableAlign::left, TableAlign::right}, {{"1", "2"}}}),
              "| a | b |\n|---|---:|\n| 1 | 2 |\n");
}

TEST(Table, WritesNumbersWithUnits) {
    EXPECT_EQ(count_text(7), "7");
    EXPECT_EQ(count_text(1234), "1,234");
    EXPECT_EQ(count_text(12345678), "12,345,678");
    EXPECT_EQ(bytes_text(512), "512 B");
    EXPECT_EQ(bytes_text(2123366400), "2.0 GiB");
    EXPECT_EQ(seconds_text(0.0123), "12 ms");
    EXPECT_EQ(seconds_text(1.239), "1.24 s");
    EXPECT_EQ(rate_text(373.2e6), "373 M rays/s");
    EXPECT_EQ(percent_text(4.726), "4.73 %");
}

TEST(Table, WrapsTextAtSpaces) {
    EXPECT_EQ(wrapped("one two three", 7), (std::vector<std::string>{"one two", "three"}));
    EXPECT_EQ(wrapped("overlongword x", 4), (std::vector<std::string>{"overlongword", "x"}));
    EXPECT_TRUE(wrapped("", 4).empty());
}

}  // namespace
}  // namespace sightlines
