#pragma once
#include <cstdint>

namespace realcam {

/// One thread for each of `count` pieces of work, in blocks of kBlockSize.
inline constexpr int kBlockSize = 128;

/// At least one, so that nothing may be done.
inline unsigned blocks_for(std::int64_t count) {
    return static_cast<unsigned>(count > kBlockSize ? (count + kBlockSize - 1) / kBlockSize : 1);
}

/// The piece of a thread. Past the last one in the last block.
__device__ inline std::int64_t thread_index() {
    return static_cast<std::int64_t>(blockIdx.x) * kBlockSize + threadIdx.x;
}

}  // namespace realcam
