#include <cstdio>
#include <cstdlib>

#include "techniques/compute/instance.h"
#include "window_testing.h"

namespace sightlines {
namespace {

constexpr glm::u8vec4 red{200, 10, 20, 255}, green{30, 180, 40, 255}, blue{50, 60, 220, 255}, white{250, 251, 252, 255};
const WindowLook dark{.theme = Theme::dark}, light{.theme = Theme::light};

/// By either way of a frame to the screen.
struct WindowPicture : testing::TestWithParam<PictureTransfer> {};
INSTANTIATE_TEST_SUITE_P(, WindowPicture, testing::Values(PictureTransfer::shared_memory, PictureTransfer::socket),
                         [](const auto& transfer) {
                             return transfer.param == PictureTransfer::shared_memory ? "SharedMemory" : "Socket";
                         });

ImageRgba8 four_pixels() {
    ImageRgba8 picture({2, 2});
    picture.pixels = {red, green, blue, white};
    return picture;
}

TEST_P(WindowPicture, ShowsImGuisColoursAsTheyAre) {
    const Xvfb server({1000, 700}, 96, GetParam());
    Window window("test", {800, 600});
    const auto draw = [](ImDrawList& list) { list.AddRectFilled({100, 50}, {300, 150}, IM_COL32(200, 10, 20, 255)); };
    const ImageRgba8 seen =
        show_until(server, window, dark, draw, [](const ImageRgba8& p) { return p.at(200, 100) == red; });
    EXPECT_EQ(seen.at(100, 50), red);
    EXPECT_EQ(seen.at(299, 149), red);
    const glm::u8vec4 page = pixel(colours(Theme::dark).page);
    EXPECT_EQ(seen.at(300, 150), page);
    EXPECT_EQ(seen.at(0, 0), page);
    EXPECT_EQ(seen.at(799, 599), page);
    EXPECT_EQ(framebuffer_size(window), (ImageSize{800, 600}));
    EXPECT_FALSE(device_name(window).empty());
}

TEST_P(WindowPicture, TexturesAreDrawnPixelForPixelWithoutTheirAlpha) {
    const Xvfb server({1000, 700}, 96, GetParam());
    Window window("test", {800, 600});
    ImageRgba8 picture = four_pixels();
    picture.at(1, 0).a = 0;
    WindowTexture texture;
    begin_frame(window, dark, 0.0);
    upload(window, texture, picture);
    end_frame(window);
    EXPECT_EQ(texture.size, (ImageSize{2, 2}));
    const auto draw = [&](ImDrawList& list) {
        draw_texture(window, list, texture, {100, 200}, {80, 40}, {0, 0}, {1, 1}, Sampling::nearest);
    };
    const ImageRgba8 seen =
        show_until(server, window, dark, draw, [](const ImageRgba8& p) { return p.at(100, 200) == red; });
    EXPECT_EQ(seen.at(139, 219), red);
    EXPECT_EQ(seen.at(140, 219), green);
    EXPECT_EQ(seen.at(179, 200), green);
    EXPECT_EQ(seen.at(100, 239), blue);
    EXPECT_EQ(seen.at(139, 220), blue);
    EXPECT_EQ(seen.at(140, 220), white);
    EXPECT_EQ(seen.at(179, 239), white);
    EXPECT_EQ(seen.at(180, 239), pixel(colours(Theme::dark).page));
    EXPECT_EQ(seen.at(99, 200), pixel(colours(Theme::dark).page));
}

TEST_P(WindowPicture, TexturesKeepToTheClipRectangleAndToTheAskedPart) {
    const Xvfb server({1000, 700}, 96, GetParam());
    Window window("test", {800, 600});
    WindowTexture texture;
    const auto draw = [&](ImDrawList& list) {
        if (!texture.objects) upload(window, texture, four_pixels());
        list.PushClipRect({120, 100}, {150, 190});
        draw_texture(window, list, texture, {100, 100}, {100, 100}, {0.5f, 0.0f}, {1.0f, 1.0f}, Sampling::nearest);
        list.PopClipRect();
        // What is drawn afterwards is ImGui's again.
        list.AddRectFilled({300, 100}, {320, 120}, IM_COL32(50, 60, 220, 255));
    };
    const ImageRgba8 seen =
        show_until(server, window, dark, draw, [](const ImageRgba8& p) { return p.at(120, 100) == green; });
    const glm::u8vec4 page = pixel(colours(Theme::dark).page);
    EXPECT_EQ(seen.at(119, 100), page);
    EXPECT_EQ(seen.at(149, 149), green);
    EXPECT_EQ(seen.at(150, 149), page);
    EXPECT_EQ(seen.at(120, 150), white);
    EXPECT_EQ(seen.at(120, 189), white);
    EXPECT_EQ(seen.at(120, 190), page);
    EXPECT_EQ(seen.at(310, 110), blue);
}

TEST_P(WindowPicture, FillsAreOpaqueAndKeepToTheClipRectangleAndToTheWindow) {
    const Xvfb server({1000, 700}, 96, GetParam());
    Window window("test", {800, 600});
    const auto draw = [&](ImDrawList& list) {
        list.PushClipRect({100, 100}, {900, 300});
        fill_opaque(window, list, {50, 150}, {2000, 50}, IM_COL32(200, 10, 20, 1));
        fill_opaque(window, list, {100, 400}, {50, 50}, IM_COL32(200, 10, 20, 255));  // outside the clip rectangle
        list.AddRectFilled({120, 160}, {130, 170}, IM_COL32(50, 60, 220, 255));
        list.PopClipRect();
    };
    const ImageRgba8 seen =
        show_until(server, window, dark, draw, [](const ImageRgba8& p) { return p.at(100, 150) == red; });
    const glm::u8vec4 page = pixel(colours(Theme::dark).page);
    EXPECT_EQ(seen.at(99, 150), page);
    EXPECT_EQ(seen.at(100, 149), page);
    EXPECT_EQ(seen.at(799, 199), red);
    EXPECT_EQ(seen.at(799, 200), page);
    EXPECT_EQ(seen.at(120, 420), page);
    EXPECT_EQ(seen.at(125, 165), blue);
}

TEST_P(WindowPicture, LinearSamplingBlendsBetweenPixels) {
    const Xvfb server({1000, 700}, 96, GetParam());
    Window window("test", {800, 600});
    ImageRgba8 ramp({2, 1});
    ramp.pixels = {{0, 0, 0, 255}, {200, 100, 40, 255}};
    WindowTexture texture;
    const auto draw = [&](ImDrawList& list) {
        if (!texture.objects) upload(window, texture, ramp);
        draw_texture(window, list, texture, {0, 0}, {400, 100});
    };
    const ImageRgba8 seen =
        show_until(server, window, dark, draw, [](const ImageRgba8& p) { return p.at(399, 50).r == 200; });
    EXPECT_NEAR(seen.at(200, 50).r, 100, 2);
    EXPECT_NEAR(seen.at(200, 50).g, 50, 2);
    EXPECT_EQ(seen.at(50, 50), (glm::u8vec4{0, 0, 0, 255}));
}

TEST_P(WindowPicture, AnUploadReplacesWhatATextureShowed) {
    const Xvfb server({1000, 700}, 96, GetParam());
    Window window("test", {800, 600});
    WindowTexture texture;
    const auto fill = [&](ImageSize size, glm::u8vec4 colour) {
        const auto draw = [&](ImDrawList& list) {
            upload(window, texture, ImageRgba8(size, colour));
            draw_texture(window, list, texture, {0, 0}, {200, 200});
        };
        return show_until(server, window, dark, draw, [&](const ImageRgba8& p) { return p.at(100, 100) == colour; })
            .at(199, 199);
    };
    EXPECT_EQ(fill({64, 64}, red), red);
    EXPECT_EQ(fill({64, 64}, green), green);
    EXPECT_EQ(fill({300, 7}, blue), blue);
}

TEST_P(WindowPicture, ATextureMayGoBeforeTheFrameThatShowsIt) {
    const Xvfb server({1000, 700}, 96, GetParam());
    Window window("test", {800, 600});
    const auto draw = [&](ImDrawList& list) {
        WindowTexture texture;
        draw_texture(window, list, texture, {0, 0}, {200, 200});  // nothing uploaded: nothing drawn
        upload(window, texture, ImageRgba8({16, 16}, red));
        draw_texture(window, list, texture, {300, 0}, {200, 200});
    };
    const ImageRgba8 seen =
        show_until(server, window, dark, draw, [](const ImageRgba8& p) { return p.at(400, 100) == red; });
    EXPECT_EQ(seen.at(400, 100), red);
    EXPECT_EQ(seen.at(100, 100), pixel(colours(Theme::dark).page));
}

TEST_P(WindowPicture, TheThemeChangesTheColours) {
    const Xvfb server({1000, 700}, 96, GetParam());
    Window window("test", {800, 600});
    const auto nothing = [](ImDrawList&) {};
    for (const WindowLook& look : {dark, light, dark}) {
        const glm::u8vec4 page = pixel(colours(look.theme).page);
        const ImageRgba8 seen =
            show_until(server, window, look, nothing, [&](const ImageRgba8& p) { return p.at(400, 300) == page; });
        EXPECT_EQ(seen.at(400, 300), page);
        EXPECT_EQ(ImGui::ColorConvertFloat4ToU32(ImGui::GetStyle().Colors[ImGuiCol_Text]), colours(look.theme).ink);
    }
}

/// Draws all there is to draw, and changes all there is to change.
[[noreturn]] void draw_everything_validated(PictureTransfer transfer) {
    setenv("SIGHTLINES_VULKAN_VALIDATION", "1", 1);
    std::fflush(stdout);
    dup2(STDERR_FILENO, STDOUT_FILENO);  // the layer writes to standard output, where nobody would look
    {
        const Xvfb server({1000, 700}, 96, transfer);
        Window window("test", {800, 600});
        WindowTexture texture;
        for (int frame = 0; frame < 8; ++frame) {
            begin_frame(window, {frame < 4 ? Theme::dark : Theme::light, frame < 6 ? 1.0f : 1.5f}, 0.0);
            ImGui::TextUnformatted("text");
            upload(window, texture, ImageRgba8({frame < 3 ? 64 : 99, 50}, red));
            draw_texture(window, *ImGui::GetForegroundDrawList(), texture, {0, 0}, {200, 200});
            fill_opaque(window, *ImGui::GetForegroundDrawList(), {-10, 300}, {2000, 200}, IM_COL32_WHITE);
            if (frame == 2)
                server.with_connection(
                    [](::Display* connection) { XResizeWindow(connection, Xvfb::top_window(connection), 900, 650); });
            end_frame(window);
        }
    }
    std::fflush(stdout);
    _exit(0);
}

TEST(WindowPictureDeathTest, TheValidationLayerFindsNothingToSay) {
    setenv("SIGHTLINES_VULKAN_VALIDATION", "1", 1);
    if (!compute::validation_wanted()) GTEST_SKIP() << "the validation layer is not installed";
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    for (const PictureTransfer transfer : {PictureTransfer::shared_memory, PictureTransfer::socket})
        EXPECT_EXIT(draw_everything_validated(transfer), testing::ExitedWithCode(0), "^$");
}

}  // namespace
}  // namespace sightlines
