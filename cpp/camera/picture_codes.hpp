#pragma once
#include <algorithm>

#include "develop.hpp"

namespace REALCAM_NAMESPACE {

/// 8-bit sRGB display value of a linear value (1: white), not rounded.
template <class T>
T code_of(T value) {
    return 255 * srgb_encoded(std::clamp(value, T(0), T(1)));
}

}  // namespace REALCAM_NAMESPACE
