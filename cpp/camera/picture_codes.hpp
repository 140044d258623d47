#pragma once
#include <algorithm>

#include "develop.hpp"

namespace REALCAM_NAMESPACE {

/// sRGB's 8-bit code of a linear value, 1 being white, without rounding.
inline double code_of(double value) {
    return 255 * srgb_encoded(std::clamp(value, 0.0, 1.0));
}

}  // namespace REALCAM_NAMESPACE
