// The window's picture in memory that the X server shares, for software rasterisers. Their swapchains do the same where
// the server has DRI3; where it has not (Xvfb, most servers for remote desktops) every frame would go through the
// server's socket, which costs more than drawing it.
#pragma once

#include <memory>
#include <optional>

#include "app/window/images.h"
#include "techniques/compute/buffer.h"

namespace sightlines {

struct SharedScreen {
    struct Server;  ///< the connection and the shared memory
    struct ServerDeleter {
        void operator()(Server* server) const;
    };

    std::unique_ptr<Server, ServerDeleter> server;
    std::shared_ptr<const compute::Device> device;
    ImageSize size{0, 0};
    OwnedImage image;
    DeviceOwned<VkFramebuffer, vkDestroyFramebuffer> framebuffer;
    compute::Buffer pixels;  ///< the image's bytes after the frame
};

/// The format and the layout that a render pass leaves its image in, for record_read_back.
constexpr VkFormat shared_screen_format = VK_FORMAT_B8G8R8A8_UNORM;
constexpr VkImageLayout shared_screen_layout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;

/// Nothing where the device is no software rasteriser, the display is not X, has DRI3, is on another machine, or has
/// other pixels than 32 bits with blue first.
std::optional<SharedScreen> share_screen(GLFWwindow* window, const Graphics& graphics);

/// Image, framebuffer and shared memory for a window of this size. False where the window has no pixels.
bool fit(SharedScreen& screen, ImageSize size, VkRenderPass render_pass);

/// Records the image's way into `pixels`. After the render pass.
void record_read_back(const SharedScreen& screen, VkCommandBuffer commands);

/// Puts what was read back on the window, and waits until the server has taken it. A server that is gone is left to
/// the window's own connection to notice.
void show(SharedScreen& screen);

}  // namespace sightlines
