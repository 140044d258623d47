#pragma once
#include "../../platform.hpp"

namespace REALCAM_NAMESPACE {

inline constexpr int kMaxAsphericTerms = 8;
inline constexpr int kMaxIrisBlades = 24;
inline constexpr int kMaxRadialTerms = 20;  ///< of r to r^20
inline constexpr int kMaxXyDegree = 14;     ///< i + j of terms x^i y^j, and the degree of Zernike terms
inline constexpr int kMaxForbesTerms = 13;
inline constexpr int kMaxObscurations = 16;
inline constexpr int kMaxApertureCorners = 32;

}  // namespace REALCAM_NAMESPACE
