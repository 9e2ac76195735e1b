#include "app/window/window.h"

#include <cstdlib>
#include <limits>
#include <utility>

#include "app/window/fonts.h"
#include "app/window/objects.h"

namespace sightlines {
namespace {

/// Fonts and style, where the look or the monitor's scale has changed.
void follow_look(Window::Objects& objects, const WindowLook& look) {
    const float scale = content_scale(objects.handle.get()) * look.text_scale;
    if (objects.look == look && objects.scale == scale) return;
    const bool other_fonts = !objects.look || objects.scale != scale;
    objects.look = look;
    objects.scale = scale;
    apply_style(look.theme, scale);
    if (!other_fonts) return;
    objects.fonts = load_fonts(scale);
    restart_drawing(objects.imgui);
}

void record_frame(Window::Objects& objects, VkFramebuffer framebuffer) {
    const VkCommandBuffer commands = objects.commands;
    begin_commands(*objects.graphics.device, commands);
    for (const auto& texture : objects.uploads) record_copy(*texture, commands);
    const ImVec4 page = ImGui::ColorConvertU32ToFloat4(colours(objects.look->theme).page);
    const VkClearValue clear{{{page.x, page.y, page.z, 1.0f}}};
    VkRenderPassBeginInfo begin{};
    begin.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO;
    begin.renderPass = objects.render_pass.get();
    begin.framebuffer = framebuffer;
    begin.renderArea.extent = {static_cast<std::uint32_t>(objects.drawn_size.width),
                               static_cast<std::uint32_t>(objects.drawn_size.height)};
    begin.clearValueCount = 1;
    begin.pClearValues = &clear;
    vkCmdBeginRenderPass(commands, &begin, VK_SUBPASS_CONTENTS_INLINE);
    record_imgui_frame(commands);
    vkCmdEndRenderPass(commands);
    if (objects.shared) record_read_back(*objects.shared, commands);
    check_drawing(vkEndCommandBuffer(commands), *objects.graphics.device, "recording the frame");
}

/// Starts the drawing. `waits_for` and `signals` are null where no swapchain is involved.
void submit(const Window::Objects& objects, VkSemaphore waits_for, VkSemaphore signals) {
    const compute::Device& device = *objects.graphics.device;
    const VkPipelineStageFlags stage = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT;
    const VkFence done = objects.done.get();
    VkSubmitInfo submit{};
    submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
    submit.waitSemaphoreCount = waits_for == VK_NULL_HANDLE ? 0 : 1;
    submit.pWaitSemaphores = &waits_for;
    submit.pWaitDstStageMask = &stage;
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &objects.commands;
    submit.signalSemaphoreCount = signals == VK_NULL_HANDLE ? 0 : 1;
    submit.pSignalSemaphores = &signals;
    check_drawing(vkResetFences(device.logical.get(), 1, &done), device, "drawing the frame");
    check_drawing(vkQueueSubmit(device.queue, 1, &submit, done), device, "drawing the frame");
}

void wait_until_drawn(const Window::Objects& objects) {
    const compute::Device& device = *objects.graphics.device;
    const VkFence done = objects.done.get();
    check_drawing(vkWaitForFences(device.logical.get(), 1, &done, VK_TRUE, std::numeric_limits<std::uint64_t>::max()),
                  device, "drawing the frame");
}

/// False where there is nothing to draw into at the moment.
bool draw_to_shared_screen(Window::Objects& objects, ImageSize size) {
    SharedScreen& screen = *objects.shared;
    if (!fit(screen, size, objects.render_pass.get())) return false;
    objects.drawn_size = screen.size;
    record_frame(objects, screen.framebuffer.get());
    submit(objects, VK_NULL_HANDLE, VK_NULL_HANDLE);
    wait_until_drawn(objects);
    show(screen);
    return true;
}

bool draw_to_swapchain(Window::Objects& objects, ImageSize size) {
    Swapchain& swapchain = objects.swapchain;
    const std::optional<std::uint32_t> index = next_image(swapchain, objects.graphics, size, objects.format,
                                                          objects.render_pass.get(), objects.acquired.get());
    if (!index) return false;
    const SwapchainImage& image = swapchain.images[*index];
    objects.drawn_size = swapchain.size;
    record_frame(objects, image.framebuffer.get());
    submit(objects, objects.acquired.get(), image.drawn.get());
    present(swapchain, objects.graphics, *index);
    wait_until_drawn(objects);
    return true;
}

}  // namespace

Window::Objects::Objects(const std::string& title, ImageSize size)
    : handle(make_glfw_window(title, size, input)),
      graphics(make_graphics(handle.get())),
      shared(share_screen(handle.get(), graphics)),
      format(choose_format(graphics)),
      render_pass(make_render_pass(*graphics.device, shared ? shared_screen_format : format.format,
                                   shared ? shared_screen_layout : VK_IMAGE_LAYOUT_PRESENT_SRC_KHR)),
      pictures(make_picture_pipeline(*graphics.device, render_pass.get())),
      acquired(make_semaphore(*graphics.device)),
      done(make_fence(*graphics.device)),
      commands(make_command_buffer(*graphics.device)),
      imgui(handle.get(), graphics, render_pass.get()) {}

void prepare_drivers() {
    // At its full width of 512 bits lavapipe computes faster (compute::find_devices asks for it), but compiling a
    // fragment shader then ends the process inside LLVM (Mesa 22.3). The width is read once in a process.
#ifdef __x86_64__
    if (__builtin_cpu_supports("avx512f")) setenv("LP_NATIVE_VECTOR_WIDTH", "256", 0);
#endif
}

Window::Window(const std::string& title, ImageSize size) : objects(std::make_unique<Objects>(title, size)) {
    // A driver compiles what it draws with at the first use: here, and not while a frame is waited for.
    follow_look(*objects, {});
    begin_imgui_frame(objects->imgui, {});
    ImGui::GetForegroundDrawList()->AddText(ImVec2(0.0f, 0.0f), colours(objects->look->theme).page, ".");
    end_frame(*this);
}
Window::~Window() = default;
Window::Window(Window&&) noexcept = default;
Window& Window::operator=(Window&&) noexcept = default;

WindowEvents begin_frame(Window& window, const WindowLook& look, double wait_s) {
    Window::Objects& objects = *window.objects;
    if (objects.in_frame) ImGui::EndFrame();  // something threw in between: that frame is not shown
    objects.draws.clear();
    survive_protocol_errors();
    wait_for_events(objects.handle.get(), objects.input, wait_s, objects.next_frame_s);
    follow_look(objects, look);
    begin_imgui_frame(objects.imgui, std::exchange(objects.input.key_places, {}));
    objects.in_frame = true;
    return std::exchange(objects.input.events, {});
}

void end_frame(Window& window) {
    Window::Objects& objects = *window.objects;
    ImGui::Render();
    objects.in_frame = false;
    const ImageSize size = framebuffer_size(window);
    if (objects.shared ? !draw_to_shared_screen(objects, size) : !draw_to_swapchain(objects, size)) return;
    objects.uploads.clear();
}

void wake(const Window& window) {
    window.objects->input.woken = true;
    glfwPostEmptyEvent();
}

float scale(const Window& window) { return window.objects->scale; }
ImageSize framebuffer_size(const Window& window) { return framebuffer_size(window.objects->handle.get()); }
bool key_held(const Window& window, int key) { return glfwGetKey(window.objects->handle.get(), key) == GLFW_PRESS; }

void set_title(Window& window, const std::string& title) {
    glfwSetWindowTitle(window.objects->handle.get(), title.c_str());
}
std::string_view device_name(const Window& window) { return window.objects->graphics.device->info.name; }
const Fonts& fonts(const Window& window) { return window.objects->fonts; }

void on_display_lost(Window& window, void (*save)(void*), void* argument) {
    window.objects->display_lost.save = save;
    window.objects->display_lost.argument = argument;
}

}  // namespace sightlines
