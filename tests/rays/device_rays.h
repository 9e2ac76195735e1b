// What the tests of rays on devices share.
#pragma once

#include <algorithm>
#include <cstring>
#include <span>
#include <string>

#include <gtest/gtest.h>

#include "techniques/base/files.h"
#include "techniques/compute/dispatch.h"
#include "tests/rays/test_scenes.h"

#define NEEDS_VULKAN                                                                       \
    if (compute::list_devices().empty() || !compute::list_devices().front().lacks.empty()) \
    GTEST_SKIP() << "no usable Vulkan device"

namespace sightlines::test {

struct TestRay {
    vec3 origin, direction;
};

/// From anywhere in the box to everywhere.
inline std::vector<TestRay> random_rays(const Box3& box, std::uint32_t count) {
    std::vector<TestRay> rays;
    for (std::uint32_t k = 0; k < count; ++k)
        rays.push_back({random_point(box, k, 31), sphere_direction(random_unit(32, k, 0), random_unit(32, k, 1))});
    return rays;
}

/// Half of the triangles are a texture of vertical bars, wrapped every way in turn.
inline Scene scene_with_holes(Wrap wrap) {
    Material solid, barred;
    barred.alpha_mode = AlphaMode::mask;
    barred.base_color_texture = TextureLookup{.texture = 0, .scale = vec2(2.7f, 1.9f)};
    Scene scene = scene_with_material(solid);
    scene.materials.push_back(barred);
    Texture texture;
    texture.wrap_u = texture.wrap_v = wrap;
    texture.texels = Image<glm::u8vec4>({7, 5});
    for (int y = 0; y < 5; ++y)
        for (int x = 0; x < 7; ++x)
            texture.texels.at(x, y) = glm::u8vec4(255, 255, 255, x == 2 || x == 5 || y == 4 ? 250 : 10 * x);
    scene.textures.push_back(texture);
    for (std::uint32_t k = 0; k < 40; ++k) {
        const vec3 corner = random_point({vec3(-1.0f), vec3(1.0f)}, k, 51);
        const vec3 u = sphere_direction(random_unit(52, k, 0), random_unit(52, k, 1));
        const vec3 v = glm::cross(u, vec3(0.3f, 0.8f, 0.5f));
        add_quad(scene, corner, 0.6f * u, 0.7f * v, k % 4 == 0 ? 0 : 1);
    }
    return scene;
}

template <class T>
compute::Buffer buffer_of(const std::shared_ptr<const compute::Device>& device, const std::vector<T>& values,
                          VkBufferUsageFlags also = 0) {
    const std::size_t bytes = std::max<std::size_t>(values.size() * sizeof(T), 16);
    compute::Buffer buffer = compute::make_buffer(device, bytes, compute::MemoryPlace::host, also);
    std::ranges::copy(std::as_bytes(std::span(values)), buffer.mapped.begin());
    return buffer;
}

/// A module of this folder, compiled.
inline std::vector<std::uint32_t> test_shader(const std::string& name) {
    const std::vector<std::uint8_t> file =
        read_file(std::string(SIGHTLINES_TEST_SHADERS) + "/" + name + ".spv", 1u << 20u);
    std::vector<std::uint32_t> words(file.size() / 4);
    std::memcpy(words.data(), file.data(), file.size());
    return words;
}

}  // namespace sightlines::test
