#include <memory>
#include <numeric>

#include "techniques/base/error.h"
#include "techniques/base/huge_buffer.h"
#include "tests/compute/compute_testing.h"

namespace sightlines::compute {
namespace {

std::vector<std::uint32_t> counting(std::size_t count) {
    std::vector<std::uint32_t> numbers(count);
    std::iota(numbers.begin(), numbers.end(), 1u);
    return numbers;
}

/// A buffer as if the CPU could not reach its memory: what a discrete GPU has.
Buffer unreachable(const std::shared_ptr<const Device>& device, std::uint64_t bytes) {
    Buffer buffer = make_buffer(device, bytes, MemoryPlace::device);
    buffer.mapped = {};
    return buffer;
}

TEST(Buffer, InHostMemoryIsMappedAndAligned) {
    NEEDS_VULKAN;
    const Buffer buffer = make_buffer(open_device(), 1000, MemoryPlace::host);
    EXPECT_EQ(buffer.mapped.size(), 1000u);
    EXPECT_EQ(buffer.address % 16, 0u);
    EXPECT_NE(buffer.address, 0u);
}

TEST(Buffer, LargerThanTheDeviceAllowsIsRefusedWithBothSizes) {
    NEEDS_VULKAN;
    const auto device = open_device();
    try {
        make_buffer(device, device->info.largest_allocation_bytes + 16, MemoryPlace::device);
        FAIL() << "allocated more than the device allows";
    } catch (const EnvironmentError& error) {
        EXPECT_NE(error.problem.find(bytes_text(device->info.largest_allocation_bytes)), std::string::npos);
    }
}

TEST(Buffer, GivesBackWhatWasUploadedInSeveralPieces) {
    NEEDS_VULKAN;
    const std::vector<std::uint32_t> numbers = counting(10'000'001);
    const Buffer buffer = make_buffer(open_device(), numbers.size() * 4, MemoryPlace::device);
    upload(buffer, std::as_bytes(std::span(numbers)), Progress());
    std::vector<std::uint32_t> back(numbers.size());
    download(buffer, std::as_writable_bytes(std::span(back)), Progress());
    EXPECT_EQ(back, numbers);
}

TEST(Buffer, IsStagedInPiecesWhereTheCpuCannotReachIt) {
    NEEDS_VULKAN;
    const std::vector<std::uint32_t> numbers = counting(10'000'001);
    const Buffer buffer = unreachable(open_device(), numbers.size() * 4);
    upload(buffer, std::as_bytes(std::span(numbers)), Progress());
    std::vector<std::uint32_t> back(numbers.size());
    download(buffer, std::as_writable_bytes(std::span(back)), Progress());
    EXPECT_EQ(back, numbers);
}

TEST(Buffer, StopsUploadingWhenCancelled) {
    NEEDS_VULKAN;
    const std::vector<std::uint32_t> numbers = counting(100);
    const Buffer buffer = make_buffer(open_device(), numbers.size() * 4, MemoryPlace::device);
    Progress progress;
    progress.cancel();
    EXPECT_THROW(upload(buffer, std::as_bytes(std::span(numbers)), progress), Cancelled);
}

TEST(ImportedMemory, IsTheHostsOwnAndNotACopy) {
    NEEDS_VULKAN;
    const auto device = open_device();
    const HugeBuffer words = allocate_huge(4096);
    const std::optional<Buffer> imported = import_host_memory(device, std::as_bytes(words.words));
    if (!imported) GTEST_SKIP() << device->info.name << " does not import host memory";
    words.words[4000] = 7;  // after the import
    EXPECT_EQ(scaled(*imported, 4096, 3)[4000], 21u);
}

TEST(ImportedMemory, MayEndInsideAPage) {
    NEEDS_VULKAN;
    const auto device = open_device();
    const HugeBuffer words = allocate_huge(1025);
    const std::optional<Buffer> imported = import_host_memory(device, std::as_bytes(words.words));
    if (!imported) GTEST_SKIP() << device->info.name << " does not import host memory";
    words.words[1024] = 5;
    EXPECT_EQ(imported->bytes, 4100u);
    EXPECT_EQ(scaled(*imported, 1025, 2)[1024], 10u);
}

TEST(ImportedMemory, IsNotToBeHadOffTheAlignment) {
    NEEDS_VULKAN;
    const HugeBuffer words = allocate_huge(4096);
    EXPECT_FALSE(import_host_memory(open_device(), std::as_bytes(words.words.subspan(1))).has_value());
}

TEST(GiveToDevice, CopiesWhatItCannotImport) {
    NEEDS_VULKAN;
    const HugeBuffer words = allocate_huge(4096);
    words.words[100] = 9;
    const Buffer given = give_to_device(open_device(), std::as_bytes(words.words.subspan(1)), Progress());
    words.words[100] = 1;  // too late to be seen
    EXPECT_EQ(scaled(given, 4095, 2)[99], 18u);
}

}  // namespace
}  // namespace sightlines::compute
