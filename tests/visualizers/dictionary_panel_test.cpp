#include "visualizers/dictionary_panel.h"

#include <gtest/gtest.h>

#include "techniques/base/error.h"
#include "tests/visualizers/visualizer_testing.h"
#include "visualizers/figure.h"
#include "visualizers/theme.h"

namespace sightlines {
namespace {

/// The furnished picture, whose row holds 6, 12 and 14, and a dictionary's row.
DictionaryPicture mapped_to(const std::vector<int>& bits, int step) {
    DictionaryPicture picture;
    picture.row = furnished_picture();
    picture.mapped.assign(16, 0);
    for (const int u : bits) picture.mapped[static_cast<std::size_t>(u)] = 1;
    picture.mapped_index = 1234;
    picture.frequency = 50;
    picture.step = step;
    DictionarySummary summary{{700, 200, 90, 8}, 2, {1000, 100, 50, 1}, {}};
    summary.most_used.assign(3, std::vector<std::uint8_t>(16, 1));
    picture.summary = std::make_shared<const DictionarySummary>(summary);
    return picture;
}

std::string svg_of(const DictionaryPicture& picture) {
    VoxelRowView view;
    const auto bytes = dictionary_figure(view, picture, {}, CanvasFormat::svg, {.dpi = 72.0f});
    return {bytes.begin(), bytes.end()};
}

void expect_labels(const std::string& svg, const std::vector<std::string>& labels) {
    for (const std::string& label : labels) EXPECT_NE(svg.find(">" + label + "<"), std::string::npos) << label;
}

TEST(DictionaryPanel, SaysWhichStepMappedTheRowAndWhatItChanged) {
    expect_labels(
        svg_of(mapped_to({15}, 4)),
        {"Compression changed the answer: blocked became open",
         "Left over: matches no row at any step; row 1,234 of the dictionary stands for it", "4 bits differ"});
    expect_labels(
        svg_of(mapped_to({7, 12, 14}, 1)),
        {"Both rows answer: blocked", "Mapped by step 1 to row 1,234 of the dictionary: the same down-sampled by 2",
         "2 bits differ", "groups of 2: any bit set"});
    expect_labels(
        svg_of(mapped_to({6, 12, 14}, 0)),
        {"Mapped by step 0: it is row 1,234 of the dictionary, which the array holds 50 times", "no bit differs"});
}

TEST(DictionaryPanel, ChartsTheWholeArray) {
    expect_labels(svg_of(mapped_to({7, 12, 14}, 1)),
                  {"Rows mapped by step", "70.0 %", "20.0 %", "9.0 %", "0.8 %", "0.2 %", "left over",
                   "How often each occurs", "The most used rows", "1,000", "100"});
}

TEST(DictionaryPanel, LeavesTheViewInSpaceItsPart) {
    EXPECT_EQ(dictionary_panel_height({600.0f, 100.0f}, 12.0f), 0.0f);
    const float rows = dictionary_panel_height({600.0f, 300.0f}, 12.0f);
    const float charts = dictionary_panel_height({600.0f, 600.0f}, 12.0f);
    EXPECT_GT(rows, 0.0f);
    EXPECT_LE(rows, 200.0f);
    EXPECT_GT(charts, rows);
    EXPECT_EQ(dictionary_panel_height({600.0f, 2000.0f}, 12.0f), charts);
}

TEST(DictionaryPanel, FramesTheVoxelsThatDifferInSpace) {
    const DictionaryPicture picture = mapped_to({7, 12, 14}, 1);
    const auto boxes = differing_voxels(picture);
    ASSERT_EQ(boxes.size(), 2u);
    EXPECT_EQ(boxes[0].points[0], vec3(6.0f, 8.0f, 8.0f));
    EXPECT_EQ(boxes[1].points[0], vec3(7.0f, 8.0f, 8.0f));
    EXPECT_TRUE(differing_voxels(mapped_to({6, 12, 14}, 0)).empty());
}

TEST(DictionaryPanel, FitsEveryPaneAndAnswersAPickOnlyAboveItself) {
    InsideView view;
    const InsidePicture picture = mapped_to({7, 12, 14}, 1);
    for (const ImageSize size : {ImageSize{1, 1}, ImageSize{60, 40}, ImageSize{200, 500}, ImageSize{700, 600}})
        EXPECT_EQ(render(view, picture, {}, {}, size, 1, 1.0f).size, size);
    const ImageSize size{700, 600};
    const float panel = dictionary_panel_height({700.0f, 600.0f}, 12.0f);
    bool above = false, below = false;
    for (int y = 5; y < size.height; y += 10)
        for (int x = 5; x < size.width; x += 10) {
            const bool picked = pick(picture, {}, {}, size, vec2(x, y)).voxel.has_value();
            (static_cast<float>(y) < 600.0f - panel ? above : below) |= picked;
        }
    EXPECT_TRUE(above);
    EXPECT_FALSE(below);
}

TEST(DictionaryFigure, HasNoDataForVtkAndSaysWhere) {
    InsideView view;
    EXPECT_THROW(write_figure(view, mapped_to({6}, 1), "dictionary", {}, {.format = FigureFormat::vtk},
                              std::filesystem::temp_directory_path()),
                 InputError);
}

}  // namespace
}  // namespace sightlines
