#include "app/desk/thread_priority.h"

#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>

namespace sightlines {

void lower_priority(int nice) {
    // Where the system refuses, the thread only works at the usual priority.
    [[maybe_unused]] const int niced = setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), nice);
    const sched_param none{};
    [[maybe_unused]] const int batched = sched_setscheduler(0, SCHED_BATCH, &none);
}

}  // namespace sightlines
