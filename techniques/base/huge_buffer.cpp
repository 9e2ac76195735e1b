#include "techniques/base/huge_buffer.h"

#include <fstream>
#include <string>

#include <sys/mman.h>

#include "techniques/base/error.h"

namespace sightlines {
namespace {

constexpr std::size_t huge_page_bytes = std::size_t{2} << 20u;

/// The figure in kB behind `name` in a /proc file, in bytes; 0 where there is none.
std::uint64_t proc_bytes(const char* file, const std::string& name) {
    std::ifstream stream(file);
    std::string word;
    while (stream >> word) {
        std::uint64_t kilobytes = 0;
        if (word == name && stream >> kilobytes) return kilobytes << 10u;
    }
    return 0;
}

}  // namespace

HugeBuffer allocate_huge(std::size_t count) {
    const std::size_t bytes = (count * sizeof(std::uint32_t) + huge_page_bytes - 1) / huge_page_bytes * huge_page_bytes;
    if (bytes > available_memory_bytes())
        throw EnvironmentError("memory",
                               std::to_string(bytes >> 20u) + " MiB are needed and " +
                                   std::to_string(available_memory_bytes() >> 20u) + " MiB are free",
                               "choose a lower resolution or a coarser angle step");
    void* start = mmap(nullptr, bytes + huge_page_bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (start == MAP_FAILED)
        throw EnvironmentError("memory", std::to_string(bytes >> 20u) + " MiB could not be had",
                               "choose a lower resolution or a coarser angle step");
    const std::shared_ptr<void> owner(start, [bytes](void* memory) { munmap(memory, bytes + huge_page_bytes); });
    const auto address = reinterpret_cast<std::uintptr_t>(start);
    auto* aligned =
        reinterpret_cast<std::uint32_t*>((address + huge_page_bytes - 1) / huge_page_bytes * huge_page_bytes);
    madvise(aligned, bytes, MADV_HUGEPAGE);  // a wish; without it the pages are small and the queries slower
    return {{aligned, count}, owner};
}

HugeBuffer reuse_huge(const HugeBuffer& spare, std::size_t count) {
    if (spare.words.size() < count) return allocate_huge(count);
    return {spare.words.first(count), spare.owner};
}

std::uint64_t available_memory_bytes() { return proc_bytes("/proc/meminfo", "MemAvailable:"); }

std::uint64_t peak_memory_bytes() { return proc_bytes("/proc/self/status", "VmHWM:"); }

}  // namespace sightlines
