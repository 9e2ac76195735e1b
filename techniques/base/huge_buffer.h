// Gigabytes of words: zeroed, on huge pages where the system gives them.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

namespace sightlines {

/// Words and whoever keeps them alive (memory of our own, or a Vulkan device's that is mapped). Copies share the words.
struct HugeBuffer {
    std::span<std::uint32_t> words;
    std::shared_ptr<void> owner;

    std::size_t bytes() const { return words.size_bytes(); }
};

/// `count` zero words, aligned to 2 MiB. EnvironmentError, with the size, where there is not that much memory.
HugeBuffer allocate_huge(std::size_t count);

/// `count` words with anything in them: those of `spare`, which nobody needs any more, where these are enough; else
/// new ones. New memory costs the system, which clears it, as much as writing it.
HugeBuffer reuse_huge(const HugeBuffer& spare, std::size_t count);

/// Bytes of memory that the machine can still give without swapping.
std::uint64_t available_memory_bytes();

/// The most memory that this process has held at once.
std::uint64_t peak_memory_bytes();

}  // namespace sightlines
