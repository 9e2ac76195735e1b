// What an open window consists of, for the files of this folder. Members go in the reverse order of their making.
#pragma once

#include <optional>

#include "app/window/display_lost.h"
#include "app/window/imgui_backend.h"
#include "app/window/picture_pipeline.h"
#include "app/window/shared_screen.h"
#include "app/window/style.h"
#include "app/window/swapchain.h"

namespace sightlines {

struct Window::Objects {
    Objects(const std::string& title, ImageSize size);

    WindowInput input;
    GlfwLibrary library;
    DisplayLost display_lost;
    GlfwWindow handle;
    Graphics graphics;
    std::optional<SharedScreen> shared;  ///< in place of the swapchain
    VkSurfaceFormatKHR format;
    DeviceOwned<VkRenderPass, vkDestroyRenderPass> render_pass;
    Swapchain swapchain;
    ImageSize drawn_size{0, 0};  ///< of the image that the frame is drawn into
    PicturePipeline pictures;
    DeviceOwned<VkSemaphore, vkDestroySemaphore> acquired;
    DeviceOwned<VkFence, vkDestroyFence> done;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    ImGuiBackend imgui;

    std::optional<WindowLook> look;  ///< of the fonts and the style that ImGui has now
    float scale = 1.0f;              ///< likewise
    Fonts fonts;
    double next_frame_s = 0.0;
    bool in_frame = false;
    std::vector<std::shared_ptr<WindowTexture::Objects>> uploads;  ///< to be copied before the frame is drawn
    std::deque<QuadDraw> draws;  ///< of this frame; a deque's elements stay where they are
};

}  // namespace sightlines
