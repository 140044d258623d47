#pragma once
#include "../../platform.hpp"

namespace REALCAM_NAMESPACE {

/// Air gap between the last face and a film that touches it, mm: rays from the film need a distance to travel to the
/// face.
inline constexpr double kFilmContact = 1e-3;

inline constexpr int kMaxAsphericTerms = 8;
inline constexpr int kMaxIrisBlades = 24;
inline constexpr int kMaxRadialTerms = 38;  ///< terms r, r^2, ..., r^38
inline constexpr int kMaxXyDegree = 14;  ///< maximum of i + j of terms x^i y^j, and of the degree of Zernike terms
inline constexpr int kMaxForbesTerms = 13;
inline constexpr int kMaxObscurations = 16;
inline constexpr int kMaxApertureCorners = 32;

}  // namespace REALCAM_NAMESPACE
