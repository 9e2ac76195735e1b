#include "app/window/texture.h"

#include <cassert>
#include <cstring>
#include <utility>

#include "app/window/objects.h"

namespace sightlines {
namespace {

void add_quad(Window::Objects& objects, ImDrawList& list, QuadDraw quad) {
    assert(objects.in_frame);
    quad.pipeline = &objects.pictures;
    quad.commands = &objects.commands;
    quad.framebuffer = &objects.drawn_size;
    objects.draws.push_back(std::move(quad));
    list.AddCallback(record_quad, &objects.draws.back());
    list.AddCallback(ImDrawCallback_ResetRenderState, nullptr);
}

}  // namespace

void upload(Window& window, WindowTexture& texture, const ImageRgba8& picture) {
    Window::Objects& objects = *window.objects;
    assert(objects.in_frame && !picture.empty());
    if (!texture.objects || texture.objects->size != picture.size)
        texture.objects = make_texture_objects(objects.graphics.device, objects.pictures, picture.size);
    texture.size = picture.size;
    // No frame is in flight between begin_frame and end_frame, so nobody reads the staging memory now.
    std::memcpy(texture.objects->staging.mapped.data(), picture.pixels.data(), 4 * picture.size.pixels());
    if (texture.objects->copy_pending) return;
    texture.objects->copy_pending = true;
    objects.uploads.push_back(texture.objects);
}

void draw_texture(Window& window, ImDrawList& list, const WindowTexture& texture, ImVec2 corner, ImVec2 size,
                  ImVec2 uv0, ImVec2 uv1, Sampling sampling) {
    if (!texture.objects) return;
    add_quad(
        *window.objects, list,
        {.texture = texture.objects, .corner = corner, .size = size, .uv0 = uv0, .uv1 = uv1, .sampling = sampling});
}

void fill_opaque(Window& window, ImDrawList& list, ImVec2 corner, ImVec2 size, ImU32 colour) {
    add_quad(*window.objects, list, {.corner = corner, .size = size, .colour = colour});
}

}  // namespace sightlines
