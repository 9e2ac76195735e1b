#include "app/window/imgui_backend.h"

#include <imgui/backends/imgui_impl_glfw.h>
#include <imgui/backends/imgui_impl_vulkan.h>

#include "techniques/base/error.h"
#include "techniques/compute/instance.h"

namespace sightlines {
namespace {

DeviceOwned<VkDescriptorPool, vkDestroyDescriptorPool> make_descriptor_pool(const compute::Device& device) {
    const VkDescriptorPoolSize sizes{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 8};
    VkDescriptorPoolCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
    create.flags = VK_DESCRIPTOR_POOL_CREATE_FREE_DESCRIPTOR_SET_BIT;
    create.maxSets = 8;
    create.poolSizeCount = 1;
    create.pPoolSizes = &sizes;
    VkDescriptorPool pool = VK_NULL_HANDLE;
    check_drawing(vkCreateDescriptorPool(device.logical.get(), &create, nullptr, &pool), device,
                  "making a descriptor pool");
    return {pool, {device.logical.get()}};
}

void on_backend_result(VkResult result) {
    if (result < 0)
        throw EnvironmentError("Vulkan", "drawing failed (" + compute::result_name(result) + ")",
                               "start again; the session is saved");
}

ImGui_ImplVulkan_InitInfo init_info(const ImGuiBackend& backend) {
    const compute::Device& device = *backend.graphics.device;
    ImGui_ImplVulkan_InitInfo info{};
    info.Instance = device.instance.get();
    info.PhysicalDevice = device.physical;
    info.Device = device.logical.get();
    info.QueueFamily = device.queue_family;
    info.Queue = device.queue;
    info.DescriptorPool = backend.descriptors.get();
    // How many sets of vertices it keeps: two are the least it takes, one frame in flight needs no more.
    info.MinImageCount = info.ImageCount = 2;
    info.MSAASamples = VK_SAMPLE_COUNT_1_BIT;
    info.CheckVkResultFn = on_backend_result;
    return info;
}

void start_vulkan_backend(const ImGuiBackend& backend) {
    ImGui_ImplVulkan_InitInfo info = init_info(backend);
#if IMGUI_VERSION_NUM >= 19030
    info.RenderPass = backend.render_pass;
    ImGui_ImplVulkan_Init(&info);
#else
    ImGui_ImplVulkan_Init(&info, backend.render_pass);
#endif
#if IMGUI_VERSION_NUM >= 19000
    ImGui_ImplVulkan_CreateFontsTexture();
#else
    run_once(*backend.graphics.device, [](VkCommandBuffer commands) { ImGui_ImplVulkan_CreateFontsTexture(commands); });
    ImGui_ImplVulkan_DestroyFontUploadObjects();
#endif
}

// Before 1.87 ImGui looks at the keys once a frame, and does not see those that went down and up again in between.
#if IMGUI_VERSION_NUM < 18700
void update_modifiers(ImGuiIO& io) {
    io.KeyCtrl = io.KeysDown[GLFW_KEY_LEFT_CONTROL] || io.KeysDown[GLFW_KEY_RIGHT_CONTROL];
    io.KeyShift = io.KeysDown[GLFW_KEY_LEFT_SHIFT] || io.KeysDown[GLFW_KEY_RIGHT_SHIFT];
    io.KeyAlt = io.KeysDown[GLFW_KEY_LEFT_ALT] || io.KeysDown[GLFW_KEY_RIGHT_ALT];
}

void hide_short_taps(ImGuiBackend& backend) {
    if (backend.short_taps.empty()) return;
    for (const int key : backend.short_taps) ImGui::GetIO().KeysDown[key] = false;
    update_modifiers(ImGui::GetIO());
    backend.short_taps.clear();
}

void show_short_taps(ImGuiBackend& backend, const std::vector<int>& keys) {
    ImGuiIO& io = ImGui::GetIO();
    for (const int key : keys) {
        if (io.KeysDown[key]) continue;
        io.KeysDown[key] = true;
        backend.short_taps.push_back(key);
    }
    if (!backend.short_taps.empty()) update_modifiers(io);
}
#else
void hide_short_taps(ImGuiBackend&) {}
void show_short_taps(ImGuiBackend&, const std::vector<int>&) {}
#endif

}  // namespace

ImGuiBackend::ImGuiBackend(GLFWwindow* window, const Graphics& graphics_, VkRenderPass render_pass_)
    : graphics(graphics_), render_pass(render_pass_), descriptors(make_descriptor_pool(*graphics_.device)) {
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;  // the session remembers, not ImGui
    io.LogFilename = nullptr;
    io.ConfigWindowsMoveFromTitleBarOnly = true;
    ImGui_ImplGlfw_InitForVulkan(window, true);
}

ImGuiBackend::~ImGuiBackend() {
    vkQueueWaitIdle(graphics.device->queue);
    if (ImGui::GetIO().BackendRendererUserData) ImGui_ImplVulkan_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
}

void restart_drawing(ImGuiBackend& backend) {
    // The backend of 1.86 has no way to let an old font texture go but to end it as a whole.
    if (ImGui::GetIO().BackendRendererUserData) {
        vkQueueWaitIdle(backend.graphics.device->queue);
        ImGui_ImplVulkan_Shutdown();
        vkResetDescriptorPool(backend.graphics.device->logical.get(), backend.descriptors.get(), 0);
    }
    start_vulkan_backend(backend);
}

void begin_imgui_frame(ImGuiBackend& backend, const std::vector<int>& keys) {
    hide_short_taps(backend);
    show_short_taps(backend, keys);
    ImGui_ImplVulkan_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
}

void record_imgui_frame(VkCommandBuffer commands) { ImGui_ImplVulkan_RenderDrawData(ImGui::GetDrawData(), commands); }

}  // namespace sightlines
