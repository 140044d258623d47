#pragma once
#include <cstdint>
#include <optional>

namespace realcam {

/// The GPU in whose memory an address lies, by its ordinal; none for memory of the host. Throws DeviceError where
/// there is no GPU.
std::optional<int> gpu_of_address(const void* address);

/// Returns when the work that a stream of the GPU was given is done; without a stream, that of all. `stream`: its
/// handle, or 1 or 2 for the default stream and the thread's own. Throws DeviceError.
void wait_for_gpu(int ordinal, std::optional<std::uintptr_t> stream);

}  // namespace realcam
