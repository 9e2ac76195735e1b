// Pictures and plain grounds inside ImGui windows. Drawn by a pipeline of our own out of an ImDrawList callback,
// because the ImGui 1.86 backend knows no texture but the font's; the same works with later ones.
#pragma once

#include <memory>

#include <imgui.h>

#include "app/window/window.h"
#include "techniques/base/image.h"

namespace sightlines {

/// A picture on the graphics side. Belongs to its window, and is let go before it.
struct WindowTexture {
    struct Objects;
    std::shared_ptr<Objects> objects;  ///< null: nothing uploaded yet
    ImageSize size{0, 0};
};

/// Fills a rectangle with a colour, opaque whatever its alpha, clipped as textures are: for the grounds of panes.
/// ImGui's own rectangles look a texture up and blend at every pixel, which costs a software device ten times as much
/// (so give such a pane ImGuiWindowFlags_NoBackground).
void fill_opaque(Window& window, ImDrawList& list, ImVec2 corner, ImVec2 size, ImU32 colour);

enum class Sampling { nearest, linear };

/// Replaces the texture's content (sRGB bytes, shown as they are; alpha is ignored). Between begin_frame and end_frame.
void upload(Window& window, WindowTexture& texture, const ImageRgba8& picture);

/// Draws the part (uv0, uv1) of the texture over the rectangle (corner, corner + size), in the window's pixels, clipped
/// by the draw list's current clip rectangle. Nothing where nothing was uploaded. The texture must stay until
/// end_frame.
void draw_texture(Window& window, ImDrawList& list, const WindowTexture& texture, ImVec2 corner, ImVec2 size,
                  ImVec2 uv0 = {0.0f, 0.0f}, ImVec2 uv1 = {1.0f, 1.0f}, Sampling sampling = Sampling::linear);

}  // namespace sightlines
