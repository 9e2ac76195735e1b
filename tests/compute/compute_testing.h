// What the tests of the compute layer share: a device (or a reason to skip) and the scaling shader.
#pragma once

#include <cstring>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "techniques/base/files.h"
#include "techniques/compute/dispatch.h"

namespace sightlines::compute {

/// Tests that need a device skip where the machine has none.
#define NEEDS_VULKAN \
    if (list_devices().empty() || !list_devices().front().lacks.empty()) GTEST_SKIP() << "no usable Vulkan device"

/// Push constants of scale.comp.
struct ScaleJob {
    VkDeviceAddress from = 0, to = 0;
    std::uint32_t count = 0, padding = 0;
};

inline std::vector<std::uint32_t> scale_spirv() {
    const std::vector<std::uint8_t> bytes = read_file(SIGHTLINES_TEST_SHADER, 1u << 20u);
    std::vector<std::uint32_t> words(bytes.size() / 4);
    std::memcpy(words.data(), bytes.data(), words.size() * 4);
    return words;
}

/// scale.comp's output for `count` numbers of `from`, which it reads by address or as texels.
inline std::vector<std::uint32_t> scaled(const Buffer& from, std::uint32_t count, std::uint32_t factor,
                                         bool from_texels = false) {
    const SpecializationConstant constants[] = {{7, factor}, {8, from_texels ? 1u : 0u}};
    const Pipeline pipeline = make_pipeline(from.device, scale_spirv(), sizeof(ScaleJob), constants, 1);
    const TexelSource source{&from, VK_FORMAT_R32G32B32A32_UINT};
    const BoundTexels texels = bind_texels(pipeline, std::span(&source, 1));
    const Buffer to = make_buffer(from.device, count * sizeof(std::uint32_t), MemoryPlace::device);
    const ScaleJob job{from.address, to.address, count, 0};
    dispatch(pipeline, std::as_bytes(std::span(&job, 1)), {(count + 63) / 64, 1, 1}, &texels);
    std::vector<std::uint32_t> numbers(count);
    download(to, std::as_writable_bytes(std::span(numbers)), Progress());
    return numbers;
}

}  // namespace sightlines::compute
