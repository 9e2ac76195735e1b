#include "visualizers/canvas.h"

#include <gtest/gtest.h>

#include <string>

#include "techniques/base/error.h"

namespace sightlines {
namespace {

std::string text_of(const std::vector<std::uint8_t>& bytes) { return {bytes.begin(), bytes.end()}; }

TEST(Canvas, APictureKeepsItsPixelsWhereNothingIsDrawn) {
    ImageRgba8 picture({4, 2}, glm::u8vec4(10, 200, 30, 255));
    picture.at(3, 1) = {0, 0, 0, 0};
    Canvas canvas = make_picture_canvas(picture);
    fill_rectangle(canvas, {{0.0f, 0.0f}, {1.0f, 1.0f}}, {1.0f, 0.0f, 0.0f});
    const ImageRgba8 out = finished_picture(canvas);
    EXPECT_EQ(out.at(0, 0), glm::u8vec4(255, 0, 0, 255));
    EXPECT_EQ(out.at(1, 1), glm::u8vec4(10, 200, 30, 255));
    EXPECT_EQ(out.at(3, 1), glm::u8vec4(0, 0, 0, 0));
}

TEST(Canvas, TheResolutionOfAPngScalesThePage) {
    Canvas canvas = make_page_canvas(CanvasFormat::png, {72.0f, 36.0f}, 144.0f);
    fill_rectangle(canvas, {{36.0f, 0.0f}, {36.0f, 36.0f}}, {0.0f, 0.0f, 1.0f});
    const ImageRgba8 out = finished_picture(canvas);
    EXPECT_EQ(out.size, (ImageSize{144, 72}));
    EXPECT_EQ(out.at(71, 40).a, 0);
    EXPECT_EQ(out.at(72, 40), glm::u8vec4(0, 0, 255, 255));
}

TEST(Canvas, TheOffsetMovesEverything) {
    Canvas canvas = make_picture_canvas(ImageRgba8({8, 8}));
    canvas.offset = {4.0f, 4.0f};
    fill_rectangle(canvas, {{0.0f, 0.0f}, {2.0f, 2.0f}}, {0.0f, 1.0f, 0.0f});
    const ImageRgba8 out = finished_picture(canvas);
    EXPECT_EQ(out.at(0, 0).a, 0);
    EXPECT_EQ(out.at(5, 5), glm::u8vec4(0, 255, 0, 255));
}

TEST(Canvas, TextInSvgStaysTextAndIsEscaped) {
    Canvas canvas = make_page_canvas(CanvasFormat::svg, {100.0f, 50.0f}, 72.0f);
    draw_text(canvas, {10.0f, 20.0f}, "\u03b8 < 3 & \"more\"", {.height = 8.0f, .bold = true});
    const std::string svg = text_of(finished_file(canvas));
    EXPECT_NE(svg.find("\u03b8 &lt; 3 &amp; &quot;more&quot;</text>"), std::string::npos);
    EXPECT_NE(svg.find("font-weight=\"bold\""), std::string::npos);
    EXPECT_LT(svg.find("<text"), svg.rfind("</svg>"));
}

TEST(Canvas, GreekTextIsDrawn) {
    Canvas canvas = make_picture_canvas(ImageRgba8({60, 30}));
    draw_text(canvas, {5.0f, 22.0f}, "\u03b8\u03c6", {.height = 20.0f, .colour = {0.0f, 0.0f, 0.0f}});
    const ImageRgba8 out = finished_picture(canvas);
    int inked = 0;
    for (const glm::u8vec4& pixel : out.pixels) inked += pixel.a > 128;
    EXPECT_GT(inked, 40);
    EXPECT_GT(text_width(canvas, "\u03b8\u03c6", {.height = 20.0f}), 10.0f);
}

TEST(Canvas, APageTooLargeForCairoIsRefused) {
    EXPECT_THROW(make_page_canvas(CanvasFormat::png, {5000.0f, 5000.0f}, 1200.0f), InputError);
    EXPECT_THROW(make_page_canvas(CanvasFormat::png, {0.0f, 10.0f}, 72.0f), InputError);
}

}  // namespace
}  // namespace sightlines
