#include <numeric>
#include <thread>

#include "tests/compute/compute_testing.h"

namespace sightlines::compute {
namespace {

constexpr std::uint32_t count = 5000;  // not a multiple of the workgroup

Buffer counting_buffer(const std::shared_ptr<const Device>& device) {
    Buffer buffer = make_buffer(device, count * 4, MemoryPlace::host);
    auto* numbers = reinterpret_cast<std::uint32_t*>(buffer.mapped.data());
    std::iota(numbers, numbers + count, 0u);
    return buffer;
}

std::vector<std::uint32_t> multiples(std::uint32_t factor) {
    std::vector<std::uint32_t> numbers(count);
    for (std::uint32_t i = 0; i < count; ++i) numbers[i] = i * factor;
    return numbers;
}

TEST(Dispatch, ReachesBuffersByAddressWithTheSpecializedConstant) {
    NEEDS_VULKAN;
    const Buffer from = counting_buffer(open_device());
    EXPECT_EQ(scaled(from, count, 1), multiples(1));
    EXPECT_EQ(scaled(from, count, 11), multiples(11));
}

TEST(Dispatch, ReadsABufferAsTexels) {
    NEEDS_VULKAN;
    const Buffer from = counting_buffer(open_device());
    ASSERT_TRUE(fits_as_texels(*from.device, from.bytes));
    EXPECT_EQ(scaled(from, count, 3, true), multiples(3));
}

TEST(Dispatch, TakesTimeAndSaysHowMuch) {
    NEEDS_VULKAN;
    const auto device = open_device();
    const Buffer from = counting_buffer(device);
    const double seconds = submit(*device, [&](VkCommandBuffer commands) {
        vkCmdFillBuffer(commands, from.handle.get(), 0, VK_WHOLE_SIZE, 0xabababab);
    });
    EXPECT_GE(seconds, 0.0);
    EXPECT_EQ(reinterpret_cast<const std::uint32_t*>(from.mapped.data())[count - 1], 0xababababu);
}

TEST(Dispatch, MayBeAskedFromSeveralThreads) {
    NEEDS_VULKAN;
    const Buffer from = counting_buffer(open_device());
    std::vector<std::vector<std::uint32_t>> results(4);
    std::vector<std::thread> threads;
    for (std::uint32_t thread = 0; thread < 4; ++thread)
        threads.emplace_back([&, thread] { results[thread] = scaled(from, count, thread + 2); });
    for (std::thread& thread : threads) thread.join();
    for (std::uint32_t thread = 0; thread < 4; ++thread) EXPECT_EQ(results[thread], multiples(thread + 2));
}

TEST(Texels, DoNotFitWhereTheLimitOrTheSizeForbids) {
    NEEDS_VULKAN;
    const auto device = open_device();
    EXPECT_FALSE(fits_as_texels(*device, 24));
    EXPECT_FALSE(fits_as_texels(*device, std::uint64_t{1} << 40u));
}

}  // namespace
}  // namespace sightlines::compute
