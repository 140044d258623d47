#pragma once
#include <functional>

#include "../platform.hpp"

namespace REALCAM_NAMESPACE {

/// Called about 20 times a second on the thread that began the work. `done`: from 0 to 1. Returns false to stop the
/// work.
using Progress = std::function<bool(double done)>;

}  // namespace REALCAM_NAMESPACE
