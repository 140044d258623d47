#pragma once
#include <cstdint>

namespace realcam {

/// Threads per block of kernels with one thread for each work item.
inline constexpr int kBlockSize = 128;

/// Returns the number of blocks for `count` items; at least one, so that launches without items are valid.
inline unsigned blocks_for(std::int64_t count) {
    return static_cast<unsigned>(count > kBlockSize ? (count + kBlockSize - 1) / kBlockSize : 1);
}

/// Returns the index of the thread's work item. In the last block it may exceed that of the last item.
__device__ inline std::int64_t thread_index() {
    return static_cast<std::int64_t>(blockIdx.x) * kBlockSize + threadIdx.x;
}

}  // namespace realcam
