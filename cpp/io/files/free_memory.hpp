#pragma once
#include <cstdint>

namespace realcam::io {

/// Returns the number of bytes that this process may still allocate: the machine's available memory, limited by what
/// its container or control group and its address space (`ulimit -v`) leave. The largest number if the system does not
/// say.
///
/// Linux hands out more memory than there is and kills the program when it is used; therefore the program asks before
/// it allocates a large picture.
std::uint64_t free_memory();

}  // namespace realcam::io
