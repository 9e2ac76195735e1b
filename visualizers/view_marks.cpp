#include "visualizers/view_marks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include <glm/gtc/constants.hpp>

namespace sightlines {
namespace {

void draw_light(Sheet& sheet, vec2 at) {
    const float em = sheet.em;
    for (int i = 0; i < 8; ++i) {
        const float turn = glm::quarter_pi<float>() * static_cast<float>(i);
        const vec2 way{std::cos(turn), std::sin(turn)};
        draw_line(sheet.canvas, at + 0.58f * em * way, at + 0.9f * em * way,
                  {.colour = sheet.colours.light, .width = 0.13f * em, .round_ends = true});
    }
    fill_circle(sheet.canvas, at, 0.42f * em, sheet.colours.light);
    draw_circle(sheet.canvas, at, 0.42f * em, {.colour = sheet.colours.ray, .width = 0.11f * em});
}

}  // namespace

std::string text_of(const char* format, double value) {
    std::array<char, 64> out{};
    std::snprintf(out.data(), out.size(), format, value);
    return out.data();
}

TextStyle label_style(const Sheet& sheet, vec3 colour, Font font) {
    return {.height = sheet.em, .colour = colour, .font = font, .bold = true, .halo = sheet.colours.page};
}

void place_label(Sheet& sheet, vec2 anchor, vec2 preferred, const std::string& text, const TextStyle& style) {
    const float width = text_width(sheet.canvas, text, style), em = sheet.em;
    const vec2 picture_size(sheet.camera.size.width, sheet.camera.size.height);
    for (float reach = 1.3f; reach < 14.0f; reach += 1.1f)
        for (const float turn : {0.0f, 0.6f, -0.6f, 1.2f, -1.2f, 2.0f, -2.0f, 3.1f}) {
            const vec2 way = glm::normalize(preferred);
            const vec2 direction{way.x * std::cos(turn) - way.y * std::sin(turn),
                                 way.x * std::sin(turn) + way.y * std::cos(turn)};
            const vec2 centre = anchor + direction * (reach * em + 0.5f * std::abs(direction.x) * width);
            const Rectangle box{centre - vec2(0.5f * width + 0.3f * em, 0.62f * em), {width + 0.6f * em, 1.24f * em}};
            const bool inside = glm::all(glm::greaterThanEqual(box.corner, vec2(0.2f * em))) &&
                                glm::all(glm::lessThanEqual(box.corner + box.size, picture_size - 0.2f * em));
            const bool free = std::none_of(sheet.taken.begin(), sheet.taken.end(),
                                           [&](const Rectangle& other) { return box.overlaps(other); });
            if (!inside || !free) continue;
            if (reach > 2.0f) {
                const vec2 end = glm::clamp(anchor, box.corner, box.corner + box.size);
                draw_line(sheet.canvas, anchor, end, {.colour = style.colour, .width = 0.07f * em, .alpha = 0.8f});
            }
            draw_text(sheet.canvas, box.corner + vec2(0.3f * em, 0.98f * em), text, style);
            sheet.taken.push_back(box);
            return;
        }
}

void draw_world_line(Sheet& sheet, vec3 from, vec3 to, Stroke stroke) {
    const auto ends = projected_segment(sheet.camera, from, to);
    if (!ends) return;
    Stroke halo = stroke;
    halo.colour = sheet.colours.page;
    halo.width = stroke.width + 0.1f * sheet.em;
    halo.alpha = 0.6f;
    halo.dash = 0.0f;
    draw_line(sheet.canvas, ends->from, ends->to, halo);
    draw_line(sheet.canvas, ends->from, ends->to, stroke);
}

void take_line(Sheet& sheet, vec3 from, vec3 to, float half_width) {
    const auto ends = projected_segment(sheet.camera, from, to);
    if (!ends) return;
    const int boxes = 40;
    for (int i = 0; i <= boxes; ++i) {
        const vec2 middle = glm::mix(ends->from, ends->to, static_cast<float>(i) / static_cast<float>(boxes));
        sheet.taken.push_back({middle - half_width, vec2(2.0f * half_width)});
    }
}

void draw_ray(Sheet& sheet, const Segment& ray) {
    const float em = sheet.em;
    draw_world_line(sheet, ray.origin, ray.target,
                    {.colour = sheet.colours.ray, .width = 0.14f * em, .round_ends = true});
    if (const auto from = projected(sheet.camera, ray.origin)) {
        fill_circle(sheet.canvas, vec2(*from), 0.36f * em, sheet.colours.page);
        fill_circle(sheet.canvas, vec2(*from), 0.26f * em, sheet.colours.ray);
    }
    if (const auto to = projected(sheet.camera, ray.target)) draw_light(sheet, vec2(*to));
}

void label_ray(Sheet& sheet, const Segment& ray, const std::string& end_name) {
    const auto from = projected(sheet.camera, ray.origin), to = projected(sheet.camera, ray.target);
    if (from) place_label(sheet, vec2(*from), {-0.6f, -1.0f}, "surface point", label_style(sheet, sheet.colours.ray));
    if (to) place_label(sheet, vec2(*to), {0.6f, -1.0f}, end_name, label_style(sheet, sheet.colours.ray));
}

void draw_orientation(Sheet& sheet, const std::optional<NamedAxis>& own) {
    const float em = sheet.em, letter = 0.75f * em;
    const vec2 centre{3.6f * em, static_cast<float>(sheet.camera.size.height) - 4.0f * em};
    const auto draw_axis = [&](vec3 axis, const char* name, vec3 colour, float width, float length) {
        const vec2 way{glm::dot(axis, sheet.camera.right), -glm::dot(axis, sheet.camera.up)};
        const vec2 tip = centre + way * length;
        draw_line(sheet.canvas, centre, tip, {.colour = colour, .width = width * em, .round_ends = true});
        const float reach = glm::length(way);
        if (reach < 0.15f) return;
        const TextStyle style{
            .height = 0.9f * em, .colour = colour, .bold = true, .align = Align::centre, .halo = sheet.colours.page};
        draw_text(sheet.canvas, tip + way / reach * letter + vec2(0.0f, 0.32f * em), name, style);
    };
    draw_axis({1.0f, 0.0f, 0.0f}, "X", sheet.colours.muted, 0.1f, 2.0f * em);
    draw_axis({0.0f, 1.0f, 0.0f}, "Y", sheet.colours.muted, 0.1f, 2.0f * em);
    draw_axis({0.0f, 0.0f, 1.0f}, "Z", sheet.colours.muted, 0.1f, 2.0f * em);
    if (own) draw_axis(own->direction, own->name, sheet.colours.set_bit, 0.15f, 2.7f * em);
    sheet.taken.push_back({centre - 3.4f * em, vec2(6.8f * em)});
}

void draw_scale_bar(Sheet& sheet, const OrbitCamera& orbit, const std::string& note) {
    const float em = sheet.em, unit_m = metres_per_pixel(sheet.camera, orbit.distance_m);
    const float wanted_m = 0.16f * static_cast<float>(sheet.camera.size.width) * unit_m;
    const float decade_m = std::pow(10.0f, std::floor(std::log10(wanted_m)));
    float length_m = decade_m;
    for (const float step : {2.0f, 5.0f})
        if (step * decade_m <= wanted_m) length_m = step * decade_m;
    const vec2 right{static_cast<float>(sheet.camera.size.width) - 1.6f * em,
                     static_cast<float>(sheet.camera.size.height) - 1.5f * em};
    const vec2 left = right - vec2(length_m / unit_m, 0.0f);
    for (const bool halo : {true, false}) {
        const Stroke stroke{.colour = halo ? sheet.colours.page : sheet.colours.ink,
                            .width = (halo ? 0.4f : 0.14f) * em};
        const vec2 tick{0.0f, 0.4f * em};
        const std::array<vec2, 4> bar{left - tick, left, right, right - tick};
        draw_path(sheet.canvas, bar, false, stroke);
    }
    draw_text(sheet.canvas, 0.5f * (left + right) - vec2(0.0f, 0.55f * em), text_of("%g m", length_m),
              {.height = em,
               .colour = sheet.colours.ink,
               .font = Font::mono,
               .align = Align::centre,
               .halo = sheet.colours.page});
    draw_text(sheet.canvas, right + vec2(0.0f, 1.1f * em), note,
              {.height = 0.8f * em, .colour = sheet.colours.muted, .align = Align::right, .halo = sheet.colours.page});
    sheet.taken.push_back({left - vec2(em, 2.0f * em), right - left + vec2(2.0f * em, 4.0f * em)});
}

float draw_verdict(Canvas& canvas, const Verdict& verdict, const Palette& colours, vec2 at, float width,
                   float text_height) {
    const float em = text_height;
    const std::string word = verdict.blocked ? "BLOCKED" : "OPEN";
    const TextStyle word_style{.height = em, .colour = verdict.blocked ? colours.page : colours.ink, .bold = true};
    const Rectangle pill{at - vec2(0.0f, 1.1f * em), {text_width(canvas, word, word_style) + 1.0f * em, 1.5f * em}};
    if (verdict.blocked)
        fill_rectangle(canvas, pill, colours.set_bit);
    else
        draw_rectangle(canvas, pill, {.colour = colours.ink, .width = 0.1f * em});
    draw_text(canvas, at + vec2(0.5f * em, 0.0f), word, word_style);

    const TextStyle style{.height = em, .colour = colours.ink};
    const vec2 start = at + vec2(pill.size.x + 0.8f * em, 0.0f);
    const auto end_of = [&](const std::string& sentence) {
        return start.x - at.x + text_width(canvas, sentence, style);
    };
    const auto fitting =
        std::ranges::find_if(verdict.sentences, [&](const std::string& sentence) { return end_of(sentence) <= width; });
    if (fitting == verdict.sentences.end()) return pill.size.x;
    draw_text(canvas, start, *fitting, style);
    return end_of(*fitting);
}

}  // namespace sightlines
