#include "app/desk/thread_priority.h"

#include <sched.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cstdint>

namespace sightlines {
namespace {

/// What the system call sched_setattr takes, in its first version (Linux 3.14). C libraries before 2.41 have no name for
/// it, and later ones have the kernel's.
struct Schedule {
    std::uint32_t size = sizeof(Schedule);
    std::uint32_t policy = SCHED_BATCH;
    std::uint64_t flags = 0;
    std::int32_t nice = 0;
    std::uint32_t priority = 0;
    std::uint64_t runtime_ns = 0, deadline_ns = 0, period_ns = 0;
};
static_assert(sizeof(Schedule) == 48);

/// How long a thread runs before another that has waited may take its place. The system's own (3 ms) would be lost at
/// each of the handovers between window, driver and display that make up a frame. Ignored before Linux 6.12.
constexpr std::uint64_t time_slice_ns = 100'000;

}  // namespace

void lower_priority(int nice) {
    Schedule schedule;
    schedule.nice = nice;
    schedule.runtime_ns = time_slice_ns;
    // Where the system refuses, the thread only works at the usual priority.
    [[maybe_unused]] const long refused = syscall(SYS_sched_setattr, 0, &schedule, 0);
}

}  // namespace sightlines
