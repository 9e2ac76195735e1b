// The kernels as GLSL on a Vulkan device against their scalar compilation.
#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "shaders/area_light.h"
#include "shaders/harmonic_light.h"
#include "shaders/one_bounce.h"
#include "shaders/visibility_field.h"
#include "techniques/base/files.h"
#include "techniques/compute/dispatch.h"
#include "tests/visibility_field/scenes.h"

namespace sightlines::visibility_field {
namespace {

namespace kernel = scalar_kernel;

struct ShaderRay {
    vec3 position, normal, direction;
};

struct ShaderAnswer {
    std::uint32_t decisions, texel;
    float back, moment, bounce;
    std::uint32_t segment;
    float light;
};

/// Push constants of kernels.comp.
struct ShaderJob {
    FieldShape shape;
    VkDeviceAddress bricks, mask_numbers, masks, rays, answers;
    std::uint32_t count, padding;
};

template <class T>
compute::Buffer buffer_of(const std::shared_ptr<const compute::Device>& device, const std::vector<T>& values) {
    compute::Buffer buffer = compute::make_buffer(device, values.size() * sizeof(T), compute::MemoryPlace::host);
    std::memcpy(buffer.mapped.data(), values.data(), values.size() * sizeof(T));
    return buffer;
}

std::vector<std::uint32_t> shader_words() {
    const std::vector<std::uint8_t> bytes = read_file(SIGHTLINES_TEST_SHADER, 1u << 20u);
    std::vector<std::uint32_t> words(bytes.size() / 4);
    std::memcpy(words.data(), bytes.data(), words.size() * 4);
    return words;
}

std::uint32_t bits_of(const kernel::Decision& decision) {
    return std::uint32_t{decision.trace} | std::uint32_t{decision.blocked} << 1u | std::uint32_t{decision.open} << 2u;
}

ShaderAnswer scalar_answer(const VisibilityField& field, const ShaderRay& ray) {
    const FieldShape& shape = field.shape;
    const kernel::FieldCell cell = kernel::locate_cell(shape, {field.bricks.data()}, ray.position, ray.normal);
    const vec3 direction = kernel::direction_in(kernel::frame_about(ray.normal, 0.6f, 0.8f), ray.direction.x,
                                                ray.direction.y, ray.direction.z);
    const bool above = kernel::leaves_surface(ray.normal, direction);
    kernel::Decision by_label = kernel::decide_without_masks(above), by_both = by_label;
    const int texel = kernel::texel_of(shape, direction);
    if (cell.index != kernel::no_cell) {
        const auto bit = [&](std::uint32_t which) {
            const std::uint32_t start = kernel::mask_start(shape, {field.mask_numbers.data()}, cell.index, which);
            return kernel::is_set(kernel::load_mask({field.masks.data()}, start, shape.words_per_mask), texel);
        };
        by_label = kernel::decide_by_label(cell.label, above, bit(cell.label == 1 ? 0 : 1));
        by_both = kernel::decide_by_both(above, bit(0), bit(1));
    }
    kernel::HarmonicMoments moments = kernel::no_moments();
    kernel::add_direction(moments, direction, 1.0f);
    float sum = 0.0f;
    for (const float moment : moments.of) sum += moment;
    const vec3 second = kernel::second_direction(ray.normal, ray.direction);
    const vec3 sent = kernel::sent_back(second, glm::abs(ray.direction), by_both.blocked);
    const kernel::Decision segment = kernel::decide_segment(above, ray.position.x > 0.0f, ray.position.z > 0.0f);
    const vec3 light = kernel::segment_adds(glm::abs(ray.position), 0.5f, 0.25f, 2.0f, 0.125f);
    return {bits_of(by_label) | bits_of(by_both) << 3u,
            static_cast<std::uint32_t>(texel),
            0.0f,
            sum,
            sent.x + sent.y + sent.z,
            bits_of(segment),
            light.y};
}

/// How the device's answers differ, and how often each bit is set.
struct Tally {
    int decisions = 0, texels = 0, segments = 0;
    std::array<int, 6> set{};
};

Tally tally(const VisibilityField& field, const std::vector<ShaderRay>& rays, const compute::Buffer& answers) {
    Tally counts;
    for (std::size_t k = 0; k < rays.size(); ++k) {
        ShaderAnswer answer{};
        std::memcpy(&answer, answers.mapped.data() + sizeof(ShaderAnswer) * k, sizeof answer);
        const ShaderAnswer expected = scalar_answer(field, rays[k]);
        counts.decisions += answer.decisions != expected.decisions;
        counts.texels += answer.texel != expected.texel;
        counts.segments += answer.segment != expected.segment;
        EXPECT_NEAR(answer.light, expected.light, 1e-5f);
        for (std::size_t bit = 0; bit < 6; ++bit) counts.set[bit] += (expected.decisions >> bit) & 1u;
        EXPECT_NEAR(answer.moment, expected.moment, 1e-4f);
        if (answer.decisions == expected.decisions) {
            EXPECT_NEAR(answer.bounce, expected.bounce, 1e-5f);
        }
        EXPECT_LT(answer.back, 1e-5f);
    }
    return counts;
}

TEST(FieldShaders, AnswerAsTheScalarKernelsButForRounding) {
    if (compute::list_devices().empty() || !compute::list_devices().front().lacks.empty())
        GTEST_SKIP() << "no usable Vulkan device";
    const Scene scene = testing::courtyard();
    const VisibilityField field = testing::baked(scene, *test::built(scene), testing::small_bake());
    std::vector<ShaderRay> rays(20'000);
    for (std::uint32_t k = 0; k < rays.size(); ++k)
        rays[k] = {test::random_point(scene.bounds, k), sphere_direction(random_unit(82, k, 0), random_unit(82, k, 1)),
                   sphere_direction(random_unit(83, k, 0), random_unit(83, k, 1))};
    const auto device = compute::open_device();
    const compute::Buffer bricks = buffer_of(device, field.bricks), numbers = buffer_of(device, field.mask_numbers),
                          masks = buffer_of(device, field.masks), asked = buffer_of(device, rays),
                          answers = buffer_of(device, std::vector<ShaderAnswer>(rays.size()));
    const compute::Pipeline pipeline = compute::make_pipeline(device, shader_words(), sizeof(ShaderJob), {}, 0);
    const ShaderJob job{field.shape,
                        bricks.address,
                        numbers.address,
                        masks.address,
                        asked.address,
                        answers.address,
                        static_cast<std::uint32_t>(rays.size()),
                        0};
    compute::dispatch(pipeline, std::as_bytes(std::span(&job, 1)),
                      {static_cast<std::uint32_t>((rays.size() + 63) / 64), 1, 1});
    const Tally counts = tally(field, rays, answers);
    EXPECT_LE(counts.decisions, 20);  // a thousandth
    EXPECT_LE(counts.texels, 20);
    EXPECT_LE(counts.segments, 20);
    for (const int set : counts.set) {
        EXPECT_GT(set, 300);
        EXPECT_LT(set, 19'700);
    }
}

}  // namespace
}  // namespace sightlines::visibility_field
