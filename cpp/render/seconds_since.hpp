#pragma once
#include <chrono>

#include "../platform.hpp"

namespace REALCAM_NAMESPACE {

/// Wall-clock seconds since `start`.
inline double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace REALCAM_NAMESPACE
