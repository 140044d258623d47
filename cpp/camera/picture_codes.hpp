#pragma once
#include <algorithm>

#include "develop.hpp"

namespace REALCAM_NAMESPACE {

/// sRGB's 8-bit code of a linear value, 1 being white, without rounding.
template <class T>
T code_of(T value) {
    return 255 * srgb_encoded(std::clamp(value, T(0), T(1)));
}

}  // namespace REALCAM_NAMESPACE
