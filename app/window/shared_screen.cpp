#include "app/window/shared_screen.h"

#include <cstdlib>
#include <cstring>
#include <string_view>

#include <sys/ipc.h>
#include <sys/shm.h>
#include <xcb/shm.h>
#include <xcb/xcb.h>

#define GLFW_EXPOSE_NATIVE_X11
#include <GLFW/glfw3native.h>

#include "techniques/base/error.h"

namespace sightlines {

/// A connection of our own: the window may be drawn on from any.
struct SharedScreen::Server {
    explicit Server(xcb_window_t shown_on) : window(shown_on) {}
    Server(const Server&) = delete;
    Server& operator=(const Server&) = delete;
    ~Server() {
        release();
        xcb_disconnect(connection);
    }

    void release() {
        if (memory == nullptr) return;
        xcb_shm_detach(connection, segment);
        shmdt(memory);
        memory = nullptr;
    }

    xcb_connection_t* connection = xcb_connect(nullptr, nullptr);
    xcb_window_t window;
    xcb_gcontext_t context = 0;
    std::uint8_t depth = 0;
    xcb_shm_seg_t segment = 0;
    void* memory = nullptr;
};

void SharedScreen::ServerDeleter::operator()(Server* server) const { delete server; }

namespace {

struct Freed {
    void operator()(void* reply) const { std::free(reply); }
};
template <class Reply>
using Owned = std::unique_ptr<Reply, Freed>;

bool has_extension(xcb_connection_t* connection, std::string_view name) {
    const auto cookie = xcb_query_extension(connection, static_cast<std::uint16_t>(name.size()), name.data());
    const Owned<xcb_query_extension_reply_t> reply(xcb_query_extension_reply(connection, cookie, nullptr));
    return reply != nullptr && reply->present != 0;
}

bool succeeds(xcb_connection_t* connection, xcb_void_cookie_t request) {
    return Owned<xcb_generic_error_t>(xcb_request_check(connection, request)) == nullptr &&
           xcb_connection_has_error(connection) == 0;
}

/// Whether pixels of this visual are 0xxxRRGGBB words in the order of this machine's memory.
bool is_blue_first(const xcb_setup_t& setup, xcb_visualid_t wanted) {
    if (setup.image_byte_order != XCB_IMAGE_ORDER_LSB_FIRST) return false;
    for (auto screen = xcb_setup_roots_iterator(&setup); screen.rem != 0; xcb_screen_next(&screen))
        for (auto depth = xcb_screen_allowed_depths_iterator(screen.data); depth.rem != 0; xcb_depth_next(&depth))
            for (auto visual = xcb_depth_visuals_iterator(depth.data); visual.rem != 0; xcb_visualtype_next(&visual))
                if (visual.data->visual_id == wanted)
                    return visual.data->red_mask == 0xff0000u && visual.data->blue_mask == 0xffu;
    return false;
}

bool has_32_bits(const xcb_setup_t& setup, std::uint8_t depth) {
    for (auto format = xcb_setup_pixmap_formats_iterator(&setup); format.rem != 0; xcb_format_next(&format))
        if (format.data->depth == depth) return format.data->bits_per_pixel == 32;
    return false;
}

/// Memory of at least `bytes` that the server has attached to; false where it cannot (it runs on another machine).
bool attach(SharedScreen::Server& server, std::size_t bytes) {
    server.release();
    const int id = shmget(IPC_PRIVATE, bytes, IPC_CREAT | 0600);
    if (id < 0) return false;
    void* const memory = shmat(id, nullptr, 0);
    server.segment = xcb_generate_id(server.connection);
    const auto cookie = xcb_shm_attach_checked(server.connection, server.segment, static_cast<std::uint32_t>(id), 1);
    const bool attached = succeeds(server.connection, cookie);
    shmctl(id, IPC_RMID, nullptr);                            // goes when both have let go of it, however they end
    if (memory == reinterpret_cast<void*>(-1)) return false;  // NOLINT: shmat's failure
    if (!attached) {
        shmdt(memory);
        return false;
    }
    server.memory = memory;
    return true;
}

bool is_drawable(SharedScreen::Server& server) {
    xcb_connection_t* const connection = server.connection;
    if (xcb_connection_has_error(connection) != 0) return false;
    if (!has_extension(connection, "MIT-SHM") || has_extension(connection, "DRI3")) return false;
    const Owned<xcb_get_geometry_reply_t> geometry(
        xcb_get_geometry_reply(connection, xcb_get_geometry(connection, server.window), nullptr));
    const Owned<xcb_get_window_attributes_reply_t> attributes(
        xcb_get_window_attributes_reply(connection, xcb_get_window_attributes(connection, server.window), nullptr));
    if (!geometry || !attributes) return false;
    const xcb_setup_t& setup = *xcb_get_setup(connection);
    if (!is_blue_first(setup, attributes->visual) || !has_32_bits(setup, geometry->depth)) return false;
    server.depth = geometry->depth;
    server.context = xcb_generate_id(connection);
    return succeeds(connection, xcb_create_gc_checked(connection, server.context, server.window, 0, nullptr));
}

}  // namespace

std::optional<SharedScreen> share_screen(GLFWwindow* window, const Graphics& graphics) {
    if (graphics.device->info.kind != compute::DeviceKind::cpu) return {};
    const auto id = static_cast<xcb_window_t>(glfwGetX11Window(window));
    if (id == 0) return {};
    SharedScreen screen;
    screen.server.reset(new SharedScreen::Server(id));
    if (!is_drawable(*screen.server) || !attach(*screen.server, 4096)) return {};
    screen.device = graphics.device;
    return screen;
}

bool fit(SharedScreen& screen, ImageSize size, VkRenderPass render_pass) {
    if (size.pixels() == 0) return false;
    if (screen.size == size) return true;
    const compute::Device& device = *screen.device;
    const std::size_t bytes = 4 * size.pixels();
    if (!attach(*screen.server, bytes))
        throw EnvironmentError("the display", "no memory to share with it (" + compute::bytes_text(bytes) + ")",
                               "raise the limit of shared memory (kernel.shmmax, kernel.shmall)");
    screen.image = make_image(device, size, shared_screen_format,
                              VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
    screen.framebuffer = make_framebuffer(device, screen.image.view.get(), size, render_pass);
    screen.pixels = compute::make_buffer(screen.device, bytes, compute::MemoryPlace::host);
    screen.size = size;
    return true;
}

void record_read_back(const SharedScreen& screen, VkCommandBuffer commands) {
    const VkBufferImageCopy region = whole_copy(screen.size);
    vkCmdCopyImageToBuffer(commands, screen.image.image.get(), shared_screen_layout, screen.pixels.handle.get(), 1,
                           &region);
    VkMemoryBarrier barrier{};
    barrier.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
    barrier.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
    barrier.dstAccessMask = VK_ACCESS_HOST_READ_BIT;
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &barrier, 0,
                         nullptr, 0, nullptr);
}

void show(SharedScreen& screen) {
    const SharedScreen::Server& server = *screen.server;
    std::memcpy(server.memory, screen.pixels.mapped.data(), 4 * screen.size.pixels());
    const auto width = static_cast<std::uint16_t>(screen.size.width);
    const auto height = static_cast<std::uint16_t>(screen.size.height);
    const auto cookie =
        xcb_shm_put_image_checked(server.connection, server.window, server.context, width, height, 0, 0, width, height,
                                  0, 0, server.depth, XCB_IMAGE_FORMAT_Z_PIXMAP, 0, server.segment, 0);
    [[maybe_unused]] const bool shown = succeeds(server.connection, cookie);
}

}  // namespace sightlines
