#include "visualizers/bit_strip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>

#include "visualizers/theme.h"
#include "visualizers/view_marks.h"

namespace sightlines {
namespace {

void draw_cells(Canvas& canvas, const VoxelRowPicture& picture, const Palette& colours, const Rectangle& where,
                bool mark_extent) {
    const float pitch = where.size.x / static_cast<float>(picture.resolution);
    const float gap = std::min(0.12f * pitch, 0.6f);
    for (int u = 0; u < picture.resolution; ++u) {
        const bool set = is_set(picture, {u, picture.v, picture.w});
        const bool kept = !mark_extent || (u >= picture.first && u <= picture.last);
        const float inset = kept ? 0.0f : 0.22f * where.size.y;
        const Rectangle cell{where.corner + vec2(pitch * static_cast<float>(u) + 0.5f * gap, inset),
                             {pitch - gap, where.size.y - 2.0f * inset}};
        const float line = std::min(0.14f * pitch, 0.5f);
        const Rectangle inside{cell.corner + 0.5f * line, cell.size - line};
        if (set)
            fill_rectangle(canvas, cell, kept ? colours.set_bit : colours.set_bit_clipped);
        else
            draw_rectangle(canvas, inside,
                           {.colour = kept ? colours.clear_bit : colours.clear_bit_clipped, .width = line});
        const float digit = std::min(1.35f * pitch, 0.62f * where.size.y);
        if (digit < 5.5f) continue;
        const vec3 colour = set ? colours.page : kept ? colours.clear_bit : colours.clear_bit_clipped;
        draw_text(canvas,
                  where.corner + vec2(pitch * (static_cast<float>(u) + 0.5f), 0.5f * where.size.y + 0.36f * digit),
                  set ? "1" : "0", {.height = digit, .colour = colour, .font = Font::mono, .align = Align::centre});
    }
}

void draw_extent_marks(Canvas& canvas, const VoxelRowPicture& picture, const Palette& colours, const Rectangle& where,
                       float em) {
    if (picture.first > picture.last) return;
    const float pitch = where.size.x / static_cast<float>(picture.resolution);
    for (const bool end : {false, true}) {
        const float x = where.corner.x + pitch * static_cast<float>(end ? picture.last + 1 : picture.first);
        const float hook = end ? -0.45f * em : 0.45f * em;
        const float top = where.corner.y - 0.35f * em, bottom = where.corner.y + where.size.y + 0.35f * em;
        const std::array<vec2, 4> bracket{vec2(x + hook, top), vec2(x, top), vec2(x, bottom), vec2(x + hook, bottom)};
        draw_path(canvas, bracket, false, {.colour = colours.extent, .width = 0.15f * em});
    }
    // Inside the extent where it is long enough, else on either side of it.
    const float s_x = where.corner.x + pitch * static_cast<float>(picture.first);
    const float e_x = where.corner.x + pitch * static_cast<float>(picture.last + 1);
    TextStyle style{.height = em, .colour = colours.extent, .font = Font::mono, .bold = true, .align = Align::right};
    const bool apart = e_x - s_x > 7.5f * em;
    const float y = where.corner.y - 1.55f * em;
    const float left = where.corner.x, right = left + where.size.x, label = 3.6f * em;
    draw_text(canvas, {apart ? s_x + label : std::clamp(s_x - 0.2f * em, left + label, right - 2.0f * label), y},
              "s = " + std::to_string(picture.first), style);
    style.align = Align::left;
    draw_text(canvas, {apart ? e_x - label : std::clamp(e_x + 0.2f * em, left + 2.0f * label, right - label), y},
              "e = " + std::to_string(picture.last), style);
}

void draw_ray_above(Canvas& canvas, const VoxelRowPicture& picture, const Palette& colours, const Rectangle& where,
                    float em) {
    const mat4 voxels_from_world = glm::inverse(picture.world_from_voxels);
    const float pitch = where.size.x / static_cast<float>(picture.resolution);
    const auto x_of = [&](vec3 point) {
        const float u = vec3(voxels_from_world * vec4(point, 1.0f)).x;
        return where.corner.x + pitch * std::clamp(u, 0.0f, static_cast<float>(picture.resolution));
    };
    const float y = where.corner.y - 0.85f * em, from = x_of(picture.ray.origin), to = x_of(picture.ray.target);
    draw_line(canvas, {from, y}, {to, y}, {.colour = colours.ray, .width = 0.17f * em});
    fill_circle(canvas, {from, y}, 0.28f * em, colours.ray);
    fill_circle(canvas, {to, y}, 0.36f * em, colours.light);
    draw_circle(canvas, {to, y}, 0.36f * em, {.colour = colours.ray, .width = 0.12f * em});
}

}  // namespace

void draw_bit_strip(Canvas& canvas, const VoxelRowPicture& picture, const ViewState& state, const Rectangle& where,
                    float text_height) {
    const Palette colours = palette(state.theme);
    draw_cells(canvas, picture, colours, where, state.extent);
    if (state.ray) draw_ray_above(canvas, picture, colours, where, text_height);
    if (state.extent) draw_extent_marks(canvas, picture, colours, where, text_height);
    const float pitch = where.size.x / static_cast<float>(picture.resolution);
    const int step = std::max(picture.resolution / 8, 1);
    for (int u = 0; u < picture.resolution; u += step)
        draw_text(canvas,
                  where.corner + vec2(pitch * (static_cast<float>(u) + 0.5f), where.size.y + 1.3f * text_height),
                  std::to_string(u),
                  {.height = 0.85f * text_height, .colour = colours.muted, .font = Font::mono, .align = Align::centre});
}

namespace {

Verdict verdict_of(const VoxelRowPicture& picture) {
    int set = 0;
    for (int u = picture.first; u <= picture.last; ++u) set += is_set(picture, {u, picture.v, picture.w});
    const std::string count =
        std::to_string(set) + " of " + std::to_string(std::max(picture.last - picture.first + 1, 0)) + " voxels";
    const auto in_the_way = std::ranges::find_if(picture.objects, &ObjectPicture::blocked);
    const bool by_object = in_the_way != picture.objects.end();
    std::string embree, why;
    if (picture.truly_blocked) {
        embree = *picture.truly_blocked == picture.blocked ? " Embree agrees"
                 : *picture.truly_blocked                  ? " Embree says blocked"
                                                           : " Embree says open";
        if (*picture.truly_blocked != picture.blocked)
            why = *picture.truly_blocked ? (picture.objects.empty() ? ": the row missed it" : ": the rows missed it")
                                         : ": the voxels are too coarse here";
        embree += why + ".";
    }
    const std::string short_embree = embree.empty() ? "" : embree.substr(0, embree.size() - 1 - why.size()) + ".";
    if (by_object)
        return {picture.blocked,
                {"by " + in_the_way->name + ", which moves; " + count + " of what stands still." + embree,
                 "by " + in_the_way->name + "." + short_embree, "by " + in_the_way->name + "."}};
    return {picture.blocked,
            {count + " looked at " + (set == 1 ? "is" : "are") + " set." + embree, count + " set." + short_embree,
             short_embree.empty() ? count + " set." : short_embree.substr(1)}};
}

}  // namespace

float draw_verdict(Canvas& canvas, const VoxelRowPicture& picture, const ViewState& state, vec2 at, float width,
                   float text_height) {
    return draw_verdict(canvas, verdict_of(picture), palette(state.theme), at, width, text_height);
}

void draw_angle_wedge(Canvas& canvas, const VoxelRowPicture& picture, const ViewState& state, const Rectangle& where,
                      float text_height) {
    const Palette colours = palette(state.theme);
    const float em = text_height;
    constexpr float widest_deg = 12.0f;  // what fits the place
    int factor = 1;
    for (const int larger : {2, 5, 10, 20})
        if (picture.angular_error_deg * static_cast<float>(larger) <= widest_deg) factor = larger;
    const float opening = glm::radians(picture.angular_error_deg * static_cast<float>(factor));
    const vec2 apex = where.corner + vec2(0.0f, where.size.y);
    const auto at = [&](float turn, float reach) { return apex + reach * vec2(std::cos(turn), -std::sin(turn)); };
    const float length = where.size.x - 6.2f * em;
    draw_line(canvas, apex, at(0.0f, length),
              {.colour = colours.twin, .width = 0.16f * em, .dash = 0.6f * em, .gap = 0.3f * em});
    draw_line(canvas, apex, at(opening, length), {.colour = colours.ray, .width = 0.16f * em});
    std::array<vec2, 13> arc;
    for (std::size_t i = 0; i < arc.size(); ++i) arc[i] = at(opening * static_cast<float>(i) / 12.0f, 0.8f * length);
    draw_path(canvas, arc, false, {.colour = colours.ink, .width = 0.09f * em});
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.2f\u00b0", static_cast<double>(picture.angular_error_deg));
    draw_text(canvas, {apex.x + length + 0.6f * em, apex.y - 0.9f * em}, text.data(),
              {.height = em, .colour = colours.ink, .font = Font::mono, .bold = true});
    const std::string note = factor == 1 ? "drawn true" : "drawn \u00d7 " + std::to_string(factor);
    draw_text(canvas, {apex.x + length + 0.6f * em, apex.y + 0.2f * em}, note,
              {.height = 0.85f * em, .colour = colours.muted});
}

}  // namespace sightlines
