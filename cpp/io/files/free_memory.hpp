#pragma once
#include <cstdint>

namespace realcam::io {

/// Bytes that this process may still take: what the machine has free, and no more than what the limits of its container
/// or control group, and of its addresses (`ulimit -v`), leave to it. The largest number where the system does not say.
///
/// Linux hands out more memory than there is and ends the program when it is used; a large picture therefore asks
/// first.
std::uint64_t free_memory();

}  // namespace realcam::io
