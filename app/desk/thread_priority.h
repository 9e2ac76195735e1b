// Threads that work while the window draws.
#pragma once

namespace sightlines {

/// Gives the processor to others first: the calling thread gets this nice value (0 to 19; 19 waits longest) and is
/// scheduled as batch work. The threads that it starts inherit both, so call this before the first use of TBB, Vulkan
/// or OpenGL on the thread.
void lower_priority(int nice);

}  // namespace sightlines
