#pragma once
#include <cstdint>
#include <optional>

namespace realcam {

/// Returns the ordinal of the GPU whose memory holds an address; std::nullopt for host memory. Throws DeviceError if
/// there is no GPU.
std::optional<int> gpu_of_address(const void* address);

/// Waits for a stream of the GPU, or without one for the whole device. `stream`: its handle, or 1 or 2 for the legacy
/// and the per-thread default stream. Throws DeviceError.
void wait_for_gpu(int ordinal, std::optional<std::uintptr_t> stream);

}  // namespace realcam
