// The built-in living room at night, lit by a television whose screen is 1,024 lights.
#include <array>
#include <cmath>
#include <numbers>

#include "techniques/scene/builtin_models.h"
#include "techniques/scene/builtin_posed.h"
#include "techniques/scene/builtin_shapes.h"

namespace sightlines {
namespace {

enum MaterialIndex : std::uint32_t {
    wall,
    wall_accent,
    ceiling,
    trim,
    oak,
    oak_light,
    oak_dark,
    walnut,
    sofa_cloth,
    cushion_rust,
    cushion_cream,
    blanket,
    rug_base,
    rug_dark,
    rug_light,
    rug_red,
    black_plastic,
    screen,
    brass,
    lampshade,
    curtain_cloth,
    night_glass,
    clay,
    soil,
    ceramic,
    popcorn,
    paper,
    leaf_dark,
    leaf_mid,
    leaf_light,
    first_book,
};
constexpr std::uint32_t book_tones = 9;

constexpr float pi = std::numbers::pi_v<float>;
constexpr double duration_s = 24.0;
constexpr float room_x = 2.9f, room_front = -2.4f, room_back = 2.9f, room_height = 2.65f;
constexpr int lamps_each_way = 32;
constexpr vec2 screen_half(0.95f, 0.535f);
constexpr vec3 screen_middle(0.0f, 1.20f, room_front + 0.125f);
constexpr float screen_radiance = 3.0f;  ///< of white, W/(sr m^2): so bright is it shown
constexpr float light_radiance = 15.0f;  ///< so bright does it light the room: eyes adapt to each, a picture cannot

std::vector<Material> materials() {
    std::vector<Material> all = {
        diffuse("wall", {0.56f, 0.53f, 0.48f}),
        diffuse("accent wall", {0.30f, 0.38f, 0.40f}),
        diffuse("ceiling", {0.74f, 0.73f, 0.70f}),
        diffuse("trim", {0.72f, 0.71f, 0.68f}),
        diffuse("oak", {0.40f, 0.25f, 0.13f}),
        diffuse("light oak", {0.45f, 0.29f, 0.155f}),
        diffuse("dark oak", {0.34f, 0.205f, 0.105f}),
        diffuse("walnut", {0.17f, 0.095f, 0.055f}),
        diffuse("sofa cloth", {0.25f, 0.30f, 0.34f}),
        diffuse("rust cushion", {0.52f, 0.19f, 0.07f}),
        diffuse("cream cushion", {0.68f, 0.62f, 0.50f}),
        diffuse("blanket", {0.62f, 0.48f, 0.16f}),
        diffuse("rug", {0.48f, 0.40f, 0.30f}),
        diffuse("dark rug", {0.11f, 0.13f, 0.18f}),
        diffuse("light rug", {0.62f, 0.56f, 0.46f}),
        diffuse("red rug", {0.40f, 0.09f, 0.06f}),
        diffuse("black plastic", {0.02f, 0.02f, 0.022f}),
        diffuse("screen", vec3(0.01f)),
        diffuse("brass", {0.50f, 0.36f, 0.14f}, 0.4f),
        diffuse("lampshade", {0.74f, 0.66f, 0.52f}),
        diffuse("curtain", {0.36f, 0.16f, 0.13f}),
        diffuse("night window", {0.012f, 0.018f, 0.035f}, 0.1f),
        diffuse("clay", {0.48f, 0.22f, 0.12f}),
        diffuse("soil", {0.06f, 0.04f, 0.03f}),
        diffuse("ceramic", {0.75f, 0.74f, 0.70f}, 0.3f),
        diffuse("popcorn", {0.82f, 0.72f, 0.42f}),
        diffuse("paper", {0.74f, 0.71f, 0.62f}),
        diffuse("dark leaf", {0.045f, 0.15f, 0.04f}),
        diffuse("leaf", {0.08f, 0.23f, 0.05f}),
        diffuse("light leaf", {0.15f, 0.33f, 0.07f}),
    };
    constexpr std::array<vec3, book_tones> books = {
        vec3(0.40f, 0.06f, 0.05f), vec3(0.07f, 0.14f, 0.32f), vec3(0.08f, 0.26f, 0.16f),
        vec3(0.62f, 0.42f, 0.10f), vec3(0.58f, 0.54f, 0.46f), vec3(0.12f, 0.11f, 0.13f),
        vec3(0.36f, 0.20f, 0.30f), vec3(0.60f, 0.26f, 0.10f), vec3(0.22f, 0.36f, 0.42f)};
    for (const vec3 book : books) all.push_back(diffuse("book " + std::to_string(all.size() - first_book + 1), book));
    for (Material& material : all) material.double_sided = false;
    for (const auto sheet : {curtain_cloth, blanket, leaf_dark, leaf_mid, leaf_light, rug_light, lampshade})
        all[sheet].double_sided = true;
    all[lampshade].emissive = {0.05f, 0.035f, 0.018f};
    all[screen].emissive = vec3(screen_radiance);
    all[screen].emissive_texture = TextureLookup{};
    return all;
}

/// What the television shows: a sail passes before a setting sun. u to the right, v down, the day runs from 0 to 1 and
/// round. Linear, in [0, 1].
vec3 picture_at(vec2 uv, float day) {
    const float turn = 2.0f * pi * day;
    const float horizon = 0.60f;
    const vec2 sun(0.62f + 0.06f * std::cos(turn), 0.38f + 0.13f * std::sin(turn));
    const float low = glm::clamp((sun.y - 0.25f) / 0.26f, 0.0f, 1.0f);
    const vec3 zenith = glm::mix(vec3(0.05f, 0.16f, 0.50f), vec3(0.10f, 0.05f, 0.30f), low);
    const vec3 glow = glm::mix(vec3(0.95f, 0.62f, 0.22f), vec3(1.0f, 0.24f, 0.06f), low);
    const vec2 stretch(16.0f / 9.0f, 1.0f);
    const float far = glm::length((uv - sun) * stretch);
    if (uv.y < horizon) {
        vec3 colour = glm::mix(zenith, glow, std::pow(uv.y / horizon, 1.6f));
        const vec2 drift(0.8f * std::cos(turn), 0.8f * std::sin(turn));
        const float cloud = 0.6f * smooth_noise(vec2(5.0f, 13.0f) * uv + drift, 91) +
                            0.4f * smooth_noise(vec2(12.0f, 30.0f) * uv - drift, 92);
        colour = glm::mix(colour, vec3(1.0f, 0.55f, 0.45f), 0.8f * glm::smoothstep(0.52f, 0.80f, cloud));
        colour = glm::mix(colour, vec3(1.0f, 0.86f, 0.50f), std::exp(-9.0f * far * far / 0.16f));
        if (far < 0.085f) colour = vec3(1.0f, 0.93f, 0.66f);
        const float hill = 0.50f + 0.06f * std::sin(7.0f * uv.x + 1.0f) + 0.035f * std::sin(17.0f * uv.x);
        if (uv.y > hill && uv.x < 0.42f) colour = vec3(0.05f, 0.04f, 0.10f);
        const vec2 sail = uv - vec2(0.5f + 0.28f * std::sin(turn), 0.585f);
        if (sail.y > -0.24f && sail.y < 0.0f && sail.x > 0.0f && sail.x < 0.42f * (sail.y + 0.24f))
            colour = vec3(0.92f, 0.16f, 0.10f);
        return colour;
    }
    const float depth = (uv.y - horizon) / (1.0f - horizon);
    const float waves = smooth_noise(vec2(9.0f * uv.x, 46.0f * uv.y) + vec2(std::cos(turn), std::sin(turn)), 93);
    vec3 sea = glm::mix(0.55f * glow, vec3(0.02f, 0.10f, 0.24f), std::pow(depth, 0.45f));
    const float path = std::exp(-std::pow((uv.x - sun.x) / (0.05f + 0.10f * depth), 2.0f));
    sea = glm::mix(sea, vec3(1.0f, 0.72f, 0.32f), path * (0.35f + 0.65f * glm::smoothstep(0.45f, 0.65f, waves)));
    return sea * (0.72f + 0.45f * waves);
}

std::uint8_t stored(float linear) {
    const float c = glm::clamp(linear, 0.0f, 1.0f);
    const float srgb = c <= 0.0031308f ? 12.92f * c : 1.055f * std::pow(c, 1.0f / 2.4f) - 0.055f;
    return static_cast<std::uint8_t>(std::lround(255.0f * srgb));
}

Texture picture_texture(float day) {
    Texture picture;
    picture.wrap_u = picture.wrap_v = Wrap::clamp;
    const ImageSize size{192, 108};
    picture.texels = Image<glm::u8vec4>(size);
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) {
            const vec3 c = picture_at({(static_cast<float>(x) + 0.5f) / static_cast<float>(size.width),
                                       (static_cast<float>(y) + 0.5f) / static_cast<float>(size.height)},
                                      day);
            picture.texels.pixels[static_cast<std::size_t>(y * size.width + x)] = {stored(c.r), stored(c.g),
                                                                                   stored(c.b), 255};
        }
    return picture;
}

/// A light before the middle of each of 32 x 32 fields of the screen, as strong as the field.
std::vector<Light> screen_lights(float day) {
    std::vector<Light> lights;
    constexpr float field_m2 =
        4.0f * screen_half.x * screen_half.y / static_cast<float>(lamps_each_way * lamps_each_way);
    for (int y = 0; y < lamps_each_way; ++y)
        for (int x = 0; x < lamps_each_way; ++x) {
            const vec2 uv = (vec2(x, y) + 0.5f) / static_cast<float>(lamps_each_way);
            Light light;
            light.position =
                screen_middle + vec3((2.0f * uv.x - 1.0f) * screen_half.x, (1.0f - 2.0f * uv.y) * screen_half.y, 0.02f);
            light.intensity = light_radiance * field_m2 * picture_at(uv, day);
            lights.push_back(light);
        }
    return lights;
}

Mesh floor_mesh() {
    Mesh mesh;
    Draws draws{701};
    add_quad(mesh, {-room_x, -0.02f, room_back}, {2.0f * room_x, 0, 0}, {0, 0, room_front - room_back}, walnut);
    constexpr float width = 0.145f;
    for (float x = -room_x; x < room_x - 0.01f; x += width) {
        for (float z = room_front - draws.between(0.0f, 1.2f); z < room_back;) {
            const float end = z + draws.between(0.9f, 1.9f);
            const vec3 low(x + 0.001f, -0.02f, std::max(z + 0.001f, room_front));
            const vec3 high(std::min(x + width - 0.001f, room_x), 0.0f, std::min(end - 0.001f, room_back));
            if (high.z > low.z + 0.02f && high.x > low.x + 0.02f)
                add_tile(mesh, {low, high}, 0.003f, oak + draws.below(3));
            z = end;
        }
    }
    return mesh;
}

Mesh shell_mesh() {
    Mesh mesh;
    const float depth = room_back - room_front;
    add_quad(mesh, {-room_x, 0, room_front}, {2 * room_x, 0, 0}, {0, room_height, 0}, wall_accent);
    add_quad(mesh, {room_x, 0, room_back}, {-2 * room_x, 0, 0}, {0, room_height, 0}, wall);
    add_quad(mesh, {-room_x, 0, room_back}, {0, 0, -depth}, {0, room_height, 0}, wall);
    add_quad(mesh, {room_x, 0, room_front}, {0, 0, depth}, {0, room_height, 0}, wall);
    add_quad(mesh, {-room_x, room_height, room_front}, {2 * room_x, 0, 0}, {0, 0, depth}, ceiling);
    // Skirting and cornice run round the room, the wall on their right.
    const float inset = 0.001f;
    const std::array<vec3, 4> around = {
        vec3(-room_x + inset, 0, room_front + inset), vec3(-room_x + inset, 0, room_back - inset),
        vec3(room_x - inset, 0, room_back - inset), vec3(room_x - inset, 0, room_front + inset)};
    for (std::size_t i = 0; i < 4; ++i) {
        const std::array<vec3, 2> side = {around[i], around[(i + 1) % 4]};
        const std::array<vec2, 5> skirting = {vec2(0, 0), vec2(0, 0.11f), vec2(-0.008f, 0.12f), vec2(-0.018f, 0.10f),
                                              vec2(-0.018f, 0)};
        add_sweep(mesh, side, {0, 1, 0}, skirting, false, trim);
        const std::array<vec2, 6> cornice = {vec2(0, room_height - 0.12f),      vec2(0, room_height),
                                             vec2(-0.12f, room_height),         vec2(-0.11f, room_height - 0.03f),
                                             vec2(-0.05f, room_height - 0.06f), vec2(-0.03f, room_height - 0.11f)};
        add_sweep(mesh, side, {0, 1, 0}, cornice, false, trim);
    }
    return mesh;
}

/// The set itself, without the screen's face.
Mesh television_mesh() {
    Mesh mesh;
    const vec3 c = screen_middle;
    add_box(mesh,
            {{c.x - screen_half.x - 0.02f, c.y - screen_half.y - 0.02f, c.z - 0.06f},
             {c.x + screen_half.x + 0.02f, c.y + screen_half.y + 0.02f, c.z - 0.004f}},
            black_plastic);
    const std::array<vec3, 4> border = {
        c + vec3(-screen_half.x, -screen_half.y, 0), c + vec3(screen_half.x, -screen_half.y, 0),
        c + vec3(screen_half.x, screen_half.y, 0), c + vec3(-screen_half.x, screen_half.y, 0)};
    for (std::size_t i = 0; i < 4; ++i) {
        const vec3 along = glm::normalize(border[(i + 1) % 4] - border[i]);
        add_beam(mesh, border[i] - 0.018f * along, border[(i + 1) % 4] + 0.018f * along, 0.012f, 0.018f, black_plastic,
                 glm::cross(along, vec3(0, 0, 1)));
    }
    add_box(mesh, {{-0.25f, c.y - 0.2f, room_front}, {0.25f, c.y + 0.2f, c.z - 0.06f}}, black_plastic);
    return mesh;
}

Mesh screen_mesh() {
    Mesh mesh;
    add_quad(mesh, screen_middle - vec3(screen_half, 0.0f), {2 * screen_half.x, 0, 0}, {0, 2 * screen_half.y, 0},
             screen);
    return mesh;
}

Mesh bench_mesh() {
    Mesh mesh;
    const float z0 = room_front + 0.02f, z1 = room_front + 0.46f;
    add_box(mesh, {{-1.15f, 0.40f, z0}, {1.15f, 0.44f, z1 + 0.02f}}, oak_light);
    add_box(mesh, {{-1.13f, 0.14f, z0}, {1.13f, 0.398f, z1 - 0.02f}}, walnut);
    for (int k = 0; k < 4; ++k) {
        const float x = -1.11f + 0.56f * static_cast<float>(k);
        add_box(mesh, {{x, 0.152f, z1 - 0.02f}, {x + 0.54f, 0.388f, z1}}, oak_light);
        add_rod(mesh, {x + 0.20f, 0.33f, z1 + 0.02f}, {x + 0.34f, 0.33f, z1 + 0.02f}, 0.007f, 6, brass);
    }
    for (const float x : {-1.05f, 1.05f})
        for (const float z : {z0 + 0.05f, z1 - 0.07f}) add_rod(mesh, {x, 0, z}, {x, 0.14f, z}, 0.022f, 8, walnut);
    add_box(mesh, {{0.55f, 0.44f, z0 + 0.12f}, {0.90f, 0.50f, z0 + 0.36f}}, black_plastic);
    for (const float side : {-1.0f, 1.0f}) {
        const float x = side * 1.42f;
        add_box(mesh, {{x - 0.11f, 0.0f, z0 + 0.03f}, {x + 0.11f, 0.92f, z0 + 0.30f}}, walnut);
        for (const float y : {0.28f, 0.52f, 0.76f}) {
            Mesh cone;
            const float radius = y > 0.7f ? 0.045f : 0.082f;
            const std::array<vec2, 4> profile = {vec2(radius, 0.0f), vec2(radius, 0.012f), vec2(0.8f * radius, 0.004f),
                                                 vec2(0.0f, -0.02f)};
            add_revolution(cone, profile, 24, black_plastic);
            append(mesh, cone, framed({1, 0, 0}, {0, 0, 1}, {0, -1, 0}, {x, y, z0 + 0.301f}));
        }
    }
    return mesh;
}

Mesh sofa_mesh(int seats) {
    Mesh mesh;
    const float seat = 0.66f, half = 0.5f * seat * static_cast<float>(seats), arm = 0.20f;
    add_cushion(mesh, {{-half - arm, 0.10f, -0.44f}, {half + arm, 0.30f, 0.44f}}, 0.04f, 4, sofa_cloth);
    add_cushion(mesh, {{-half - arm, 0.10f, 0.28f}, {half + arm, 0.80f, 0.50f}}, 0.08f, 6, sofa_cloth);
    for (const float side : {-1.0f, 1.0f}) {
        const float x = side * (half + 0.5f * arm);
        add_cushion(mesh, {{x - 0.5f * arm, 0.10f, -0.45f}, {x + 0.5f * arm, 0.60f, 0.48f}}, 0.08f, 6, sofa_cloth);
        for (const float z : {-0.36f, 0.40f}) add_rod(mesh, {x, 0, z}, {x, 0.11f, z}, 0.024f, 8, walnut);
    }
    for (int k = 0; k < seats; ++k) {
        const float x = -half + seat * (static_cast<float>(k) + 0.5f);
        add_cushion(mesh, {{x - 0.495f * seat, 0.30f, -0.46f}, {x + 0.495f * seat, 0.47f, 0.26f}}, 0.06f, 6,
                    sofa_cloth);
        Mesh back;
        add_cushion(back, {{-0.49f * seat, 0.0f, -0.09f}, {0.49f * seat, 0.44f, 0.09f}}, 0.085f, 6, sofa_cloth);
        append(mesh, back, placed({x, 0.46f, 0.19f}) * turned_about({1, 0, 0}, 0.20f));
    }
    return mesh;
}

Mesh pillow_mesh(std::uint32_t material) {
    Mesh mesh;
    add_surface(
        mesh, {32, 20}, true,
        [](vec2 uv) {
            // A square with pointed corners, thick in the middle.
            const float angle = -2.0f * pi * uv.x, height = pi * (uv.y - 0.5f);
            const float ring = uv.y <= 0.0f || uv.y >= 1.0f ? 0.0f : std::cos(height);
            const float c = std::cos(angle), s = std::sin(angle);
            const float square = 1.0f / std::pow(std::pow(std::abs(c), 5.0f) + std::pow(std::abs(s), 5.0f), 0.2f);
            const float out = std::sqrt(ring);
            return vec3(0.22f * square * out * c, 0.075f * std::sin(height) * (1.0f - 0.3f * out),
                        0.22f * square * out * s);
        },
        material);
    return mesh;
}

Mesh rug_mesh() {
    Mesh mesh;
    const vec2 half(1.35f, 0.92f);
    add_box(mesh, {{-half.x, 0.001f, -half.y}, {half.x, 0.012f, half.y}}, rug_base);
    Draws draws{711};
    for (int i = 0; i < 15000; ++i) {
        const vec2 place(draws.between(-half.x, half.x), draws.between(-half.y, half.y));
        const vec2 away = half - glm::abs(place);
        const float edge = std::min(away.x, away.y);
        const vec2 cell = glm::abs(glm::fract(place / 0.45f) - 0.5f);
        const float lozenge = cell.x + cell.y;
        std::uint32_t tone = lozenge < 0.17f ? rug_red : lozenge > 0.44f && lozenge < 0.56f ? rug_dark : rug_light;
        if (edge < 0.20f) tone = edge < 0.06f ? rug_dark : edge < 0.14f ? rug_red : rug_dark;
        const vec3 off = sphere_direction(0.5f * draws.unit(), draws.unit());
        const vec3 direction = glm::normalize(off + vec3(0, 0.5f, 0));
        const vec3 side = glm::normalize(glm::cross(direction, vec3(0.3f, 1.0f, 0.1f)));
        add_leaf(mesh, {place.x, 0.010f, place.y}, direction, side, draws.between(0.022f, 0.036f), 0.014f, tone);
    }
    return mesh;
}

Mesh table_mesh() {
    Mesh mesh;
    add_cushion(mesh, {{-0.55f, 0.36f, -0.30f}, {0.55f, 0.40f, 0.30f}}, 0.018f, 3, oak);
    add_box(mesh, {{-0.48f, 0.16f, -0.24f}, {0.48f, 0.18f, 0.24f}}, oak_dark);
    for (const float x : {-0.49f, 0.49f})
        for (const float z : {-0.25f, 0.25f}) add_rod(mesh, {x, 0, z}, {x, 0.365f, z}, 0.022f, 10, oak_dark);
    Mesh bowl;
    constexpr std::array<vec2, 9> profile = {vec2(0.05f, 0.0f),   vec2(0.06f, 0.012f), vec2(0.11f, 0.04f),
                                             vec2(0.145f, 0.09f), vec2(0.15f, 0.115f), vec2(0.142f, 0.115f),
                                             vec2(0.132f, 0.09f), vec2(0.10f, 0.05f),  vec2(0.0f, 0.03f)};
    add_revolution(bowl, profile, 36, ceramic);
    Draws draws{721};
    for (int i = 0; i < 70; ++i) {
        const float radius = 0.115f * std::sqrt(draws.unit()), angle = 2.0f * pi * draws.unit();
        const vec3 place(radius * std::cos(angle), 0.095f + 0.045f * (1.0f - radius / 0.115f) * draws.unit(),
                         radius * std::sin(angle));
        add_ball(bowl, place, vec3(draws.between(0.012f, 0.02f), 0.013f, draws.between(0.012f, 0.02f)), 8, popcorn);
    }
    append(mesh, bowl, placed({-0.18f, 0.40f, 0.03f}));
    Mesh mug;
    constexpr std::array<vec2, 6> cup = {vec2(0.036f, 0),      vec2(0.04f, 0.01f),  vec2(0.04f, 0.095f),
                                         vec2(0.035f, 0.095f), vec2(0.035f, 0.07f), vec2(0.0f, 0.07f)};
    add_revolution(mug, cup, 24, cushion_rust);
    std::vector<TubeRing> handle;
    for (int i = 0; i <= 10; ++i) {
        const float angle = -0.5f * pi + pi * static_cast<float>(i) / 10.0f;
        handle.push_back({{0.036f + 0.03f * std::cos(angle), 0.05f + 0.03f * std::sin(angle), 0}, 0.006f});
    }
    add_tube(mug, handle, 6, cushion_rust);
    append(mesh, mug, placed({0.34f, 0.40f, -0.12f}, 40.0f));
    for (int k = 0; k < 3; ++k) {
        Mesh magazine;
        add_box(magazine, {{-0.11f, 0, -0.15f}, {0.11f, 0.008f, 0.15f}},
                k == 1 ? static_cast<std::uint32_t>(paper) : first_book + static_cast<std::uint32_t>(k));
        append(mesh, magazine,
               placed({0.18f + 0.02f * static_cast<float>(k), 0.40f + 0.0085f * static_cast<float>(k), 0.10f},
                      12.0f + 17.0f * static_cast<float>(k)));
    }
    Mesh remote;
    add_cushion(remote, {{-0.022f, 0, -0.09f}, {0.022f, 0.018f, 0.09f}}, 0.008f, 3, black_plastic);
    append(mesh, remote, placed({0.05f, 0.40f, -0.18f}, 62.0f));
    return mesh;
}

Mesh bookcase_mesh() {
    Mesh mesh;
    Draws draws{731};
    constexpr float half = 0.62f, deep = 0.30f, high = 2.05f;
    for (const float x : {-half, half}) add_box(mesh, {{x - 0.015f, 0, 0}, {x + 0.015f, high, deep}}, oak_dark);
    add_box(mesh, {{-half + 0.015f, 0.0f, 0.0f}, {half - 0.015f, high, 0.012f}}, walnut);
    constexpr int shelves = 6;
    for (int shelf = 0; shelf < shelves; ++shelf) {
        const float y = 0.05f + 0.39f * static_cast<float>(shelf);
        add_box(mesh, {{-half + 0.015f, y, 0.012f}, {half - 0.015f, y + 0.025f, deep}}, oak_dark);
        if (shelf == shelves - 1) break;
        float x = -half + 0.03f;
        while (x < half - 0.10f) {
            if (draws.unit() < 0.07f) {
                const vec3 middle(x + 0.09f, y + 0.115f, 0.17f);
                add_ball(mesh, middle, {0.07f, 0.09f, 0.07f}, 20, draws.unit() < 0.5f ? ceramic : clay);
                x += 0.19f;
                continue;
            }
            const float thick = draws.between(0.016f, 0.045f), tall = draws.between(0.20f, 0.31f),
                        out = draws.between(0.15f, 0.21f);
            Mesh book;
            const std::uint32_t tone = first_book + draws.below(book_tones);
            add_box(book, {{0, 0, 0}, {thick, tall, out}}, tone);
            add_box(book, {{0.2f * thick, tall, 0.004f}, {0.8f * thick, tall + 0.001f, out - 0.004f}}, paper);
            if (draws.unit() < 0.6f)
                add_box(book, {{0.15f * thick, 0.7f * tall, out}, {0.85f * thick, 0.78f * tall, out + 0.001f}}, brass);
            append(mesh, book,
                   placed({x, y + 0.025f, 0.05f}) * turned_about({0, 0, 1}, draws.unit() < 0.06f ? -0.12f : 0.0f));
            x += thick + 0.003f;
        }
    }
    return mesh;
}

Mesh lamp_mesh() {
    Mesh mesh;
    constexpr std::array<vec2, 7> stand = {vec2(0.16f, 0),      vec2(0.16f, 0.02f),  vec2(0.03f, 0.035f),
                                           vec2(0.012f, 0.06f), vec2(0.012f, 1.45f), vec2(0.02f, 1.47f),
                                           vec2(0, 1.48f)};
    add_revolution(mesh, stand, 28, brass);
    constexpr std::array<vec2, 2> shade = {vec2(0.24f, 1.34f), vec2(0.15f, 1.68f)};
    add_revolution(mesh, shade, 40, lampshade);
    return mesh;
}

Mesh curtain_mesh(float side) {
    Mesh mesh;
    add_surface(
        mesh, {60, 24}, false,
        [side](vec2 uv) {
            const float fold = 2.0f * pi * 7.0f * uv.x;
            const float flare = 0.8f + 0.35f * uv.y;
            return vec3(side * (0.62f + 0.42f * uv.x * flare), 2.42f - 2.38f * uv.y,
                        0.10f + 0.045f * flare * std::sin(fold + 0.7f * std::sin(3.0f * uv.y)));
        },
        curtain_cloth);
    return mesh;
}

/// A window by night with curtains, on z = 0 facing +z.
Mesh window_mesh() {
    Mesh mesh;
    add_quad(mesh, {-0.75f, 0.80f, 0.004f}, {1.5f, 0, 0}, {0, 1.45f, 0}, night_glass);
    for (const float x : {-0.78f, 0.0f, 0.78f})
        add_box(mesh, {{x - 0.035f, 0.77f, 0.0f}, {x + 0.035f, 2.28f, 0.05f}}, trim);
    for (const float y : {0.77f, 1.50f, 2.25f})
        add_box(mesh, {{-0.815f, y - 0.033f, 0.0f}, {0.815f, y + 0.033f, 0.045f}}, trim);
    add_box(mesh, {{-0.90f, 0.70f, 0.0f}, {0.90f, 0.74f, 0.14f}}, trim);
    for (const float side : {-1.0f, 1.0f}) append(mesh, curtain_mesh(side), mat4(1.0f));
    add_rod(mesh, {-1.25f, 2.44f, 0.10f}, {1.25f, 2.44f, 0.10f}, 0.014f, 10, brass);
    return mesh;
}

/// A framed picture of fields, on z = 0 facing +z.
Mesh painting_mesh(vec2 half, std::uint32_t seed) {
    Mesh mesh;
    Draws draws{seed};
    add_box(mesh, {{-half.x, -half.y, 0}, {half.x, half.y, 0.012f}}, paper);
    const vec2 inner = half - 0.05f;
    constexpr int fields = 4;
    for (int y = 0; y < fields; ++y)
        for (int x = 0; x < fields; ++x) {
            const vec2 low = -inner + 2.0f * inner * vec2(x, y) / static_cast<float>(fields);
            const vec2 high = low + 2.0f * inner / static_cast<float>(fields) *
                                        vec2(draws.between(0.7f, 0.98f), draws.between(0.7f, 0.98f));
            add_box(mesh, {{low.x, low.y, 0.012f}, {high.x, high.y, 0.014f}}, first_book + draws.below(book_tones));
        }
    for (const float side : {-1.0f, 1.0f}) {
        add_box(mesh, {{side * half.x - 0.015f, -half.y - 0.015f, 0}, {side * half.x + 0.015f, half.y + 0.015f, 0.03f}},
                black_plastic);
        add_box(mesh, {{-half.x + 0.015f, side * half.y - 0.015f, 0}, {half.x - 0.015f, side * half.y + 0.015f, 0.03f}},
                black_plastic);
    }
    return mesh;
}

/// A potted plant with broad leaves.
Mesh plant_mesh(std::uint32_t seed) {
    Mesh mesh;
    Draws draws{seed};
    constexpr std::array<vec2, 7> pot = {vec2(0.13f, 0),     vec2(0.15f, 0.02f), vec2(0.19f, 0.32f), vec2(0.20f, 0.34f),
                                         vec2(0.18f, 0.34f), vec2(0.17f, 0.30f), vec2(0, 0.30f)};
    add_revolution(mesh, pot, 32, clay);
    for (int k = 0; k < 26; ++k) {
        const float azimuth = 2.4f * static_cast<float>(k) + draws.between(-0.3f, 0.3f),
                    lean = draws.between(0.15f, 0.8f);
        const float tall = draws.between(0.45f, 1.0f);
        const vec3 outward(std::cos(azimuth), 0, std::sin(azimuth)), side(-outward.z, 0, outward.x);
        std::vector<TubeRing> stalk;
        for (int i = 0; i <= 5; ++i) {
            const float t = static_cast<float>(i) / 5.0f;
            stalk.push_back(
                {vec3(0, 0.28f + tall * t * (1.0f - 0.25f * lean * t), 0) + 0.6f * lean * tall * t * t * outward,
                 0.008f - 0.004f * t});
        }
        add_tube(mesh, stalk, 5, leaf_dark);
        const vec3 base = stalk.back().centre;
        const float length = draws.between(0.22f, 0.36f);
        add_surface(
            mesh, {4, 8}, false,
            [&](vec2 uv) {
                const float width = 0.30f * length * std::sin(pi * std::pow(uv.y, 0.7f)) + 0.002f;
                const float droop = 0.55f * uv.y * uv.y;
                const float across = 2.0f * uv.x - 1.0f;
                return base + length * (uv.y * (outward + vec3(0, 0.35f, 0)) - vec3(0, droop, 0)) +
                       width * across * side + vec3(0, 0.25f * width * std::abs(across), 0);
            },
            leaf_dark + draws.below(3));
    }
    return mesh;
}

Mesh blanket_mesh() {
    Mesh mesh;
    add_surface(
        mesh, {30, 40}, false,
        [](vec2 uv) {  // over the arm of the sofa
            const float around = 0.75f * (uv.y - 0.5f), fold = 0.015f * std::sin(19.0f * uv.x + 2.0f * uv.y);
            const float x = glm::clamp(around, -0.11f, 0.11f), y = 0.615f - std::max(std::abs(around) - 0.11f, 0.0f);
            return vec3(x * 1.02f + (around > 0 ? fold : -fold) + (around > 0 ? 0.012f : -0.012f), y + 0.3f * fold,
                        0.5f * (uv.x - 0.5f) + 0.02f * std::sin(4.0f * around));
        },
        blanket);
    return mesh;
}

void furnish(PartBuilder& builder) {
    builder.add(floor_mesh(), "floor");
    builder.add(shell_mesh(), "walls");
    builder.add(television_mesh(), "television");
    builder.add(bench_mesh(), "television bench");
    builder.add(rug_mesh(), "rug", {placed({0, 0, 0.15f})});
    builder.add(table_mesh(), "table", {placed({0.05f, 0, 0.10f}, 4.0f)});
    builder.add(sofa_mesh(3), "sofa", {placed({0, 0, 1.65f})});
    builder.add(sofa_mesh(1), "armchair", {placed({-2.05f, 0, 0.15f}, 52.0f)});
    builder.add(pillow_mesh(cushion_rust), "rust cushion",
                {placed({-0.82f, 0.70f, 1.62f}, 15.0f) * turned_about({1, 0, 0}, -1.15f),
                 placed({-1.98f, 0.68f, 0.12f}, 60.0f) * turned_about({1, 0, 0}, -1.1f)});
    builder.add(pillow_mesh(cushion_cream), "cream cushion",
                {placed({0.80f, 0.70f, 1.63f}, -12.0f) * turned_about({1, 0, 0}, -1.2f)});
    builder.add(blanket_mesh(), "blanket", {placed({1.09f, 0, 1.45f})});
    builder.add(bookcase_mesh(), "bookcase", {placed({room_x - 0.005f, 0, 0.75f}, 270.0f)});
    builder.add(lamp_mesh(), "lamp", {placed({-1.75f, 0, 2.2f})});
    builder.add(window_mesh(), "window", {placed({-room_x + 0.002f, 0, 0.55f}, 90.0f)});
    builder.add(painting_mesh({0.36f, 0.50f}, 741), "painting", {placed({room_x - 0.002f, 1.55f, -0.75f}, 270.0f)});
    builder.add(painting_mesh({0.55f, 0.38f}, 742), "painting, wide",
                {placed({0.0f, 1.75f, room_back - 0.002f}, 180.0f)});
    builder.add(plant_mesh(751), "plant", {placed({2.35f, 0, -1.85f})});
    builder.add(plant_mesh(752), "plant, small", {placed({-2.40f, 0, -1.90f}, 30.0f, 0.8f)});
}

PosableScene made_tv() {
    PosableScene room;
    Scene& scene = room.rest;
    scene.materials = materials();
    scene.textures = {picture_texture(0.0f)};
    PartBuilder builder{scene};
    furnish(builder);
    const std::size_t first = scene.positions.size();
    builder.add(screen_mesh(), "screen");
    scene.texture_coordinates[0].assign(first, vec2(0.0f));
    for (const vec2 corner : {vec2(0, 1), vec2(1, 1), vec2(0, 0), vec2(1, 0)})
        scene.texture_coordinates[0].push_back(corner);
    Camera seat{"default", CameraKind::perspective, {1.55f, 1.72f, 2.62f}, {-0.32f, 0.80f, -1.0f}};
    seat.vertical_field_of_view_deg = 62.0f;
    Camera screen_side{"from the screen", CameraKind::perspective, {-1.9f, 1.65f, -2.1f}, {0.5f, 0.65f, 1.5f}};
    screen_side.vertical_field_of_view_deg = 62.0f;
    scene.cameras = {seat, screen_side};
    scene.light_volume = {{-2.4f, 1.3f, -1.8f}, {2.4f, 2.5f, 2.4f}};
    room.pose = [](Scene& posed, double time_s) {
        const double turns = time_s / duration_s;
        const auto day = static_cast<float>(turns - std::floor(turns));
        posed.textures[0] = picture_texture(day);
        posed.lights = screen_lights(day);
    };
    return room;
}

}  // namespace

SceneModel tv_model() {
    return posed_model("tv", "A living room by night, lit by a television whose screen is 1,024 lights.", duration_s,
                       made_tv);
}

}  // namespace sightlines
