// Dear ImGui's context and its two backends. What differs between its versions (1.86 to 1.91) is in the .cpp.
#pragma once

#include <vector>

#include <imgui.h>

#include "app/window/graphics.h"

namespace sightlines {

/// The context, fed by `window` and drawn by `graphics` inside the render pass. Starts without fonts: call
/// `restart_drawing` before the first frame.
struct ImGuiBackend {
    ImGuiBackend(GLFWwindow* window, const Graphics& graphics, VkRenderPass render_pass);
    ~ImGuiBackend();
    ImGuiBackend(const ImGuiBackend&) = delete;
    ImGuiBackend& operator=(const ImGuiBackend&) = delete;

    const Graphics& graphics;
    VkRenderPass render_pass;
    DeviceOwned<VkDescriptorPool, vkDestroyDescriptorPool> descriptors;
    std::vector<int> short_taps;  ///< keys that are shown to ImGui as down although they are up again
};

/// Takes the fonts of ImGui's atlas (built) over to the device, in place of those before. Between frames.
void restart_drawing(ImGuiBackend& backend);

/// ImGui::NewFrame with everything that comes before. `keys` went down since the last one.
void begin_imgui_frame(ImGuiBackend& backend, const std::vector<int>& keys);

/// Records what ImGui was given, inside the render pass.
void record_imgui_frame(VkCommandBuffer commands);

}  // namespace sightlines
