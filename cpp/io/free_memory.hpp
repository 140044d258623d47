#pragma once
#include <cstdint>

namespace realcam::io {

/// Bytes that a program may still take: what the machine has free, and no more than the limit of the container or
/// control group that it runs in. The largest number where the system does not say.
///
/// Linux hands out more memory than there is and ends the program when it is used; a large picture therefore asks
/// first.
std::uint64_t free_memory();

}  // namespace realcam::io
