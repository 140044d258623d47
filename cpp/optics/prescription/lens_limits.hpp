#pragma once
#include "../../platform.hpp"

namespace REALCAM_NAMESPACE {

inline constexpr int kMaxAsphericTerms = 8;
inline constexpr int kMaxIrisBlades = 24;

}  // namespace REALCAM_NAMESPACE
