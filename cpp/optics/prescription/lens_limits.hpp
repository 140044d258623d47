#pragma once
#include "../../platform.hpp"

namespace REALCAM_NAMESPACE {

// Limits of a lens whose numbers the trace holds in arrays of fixed size.

/// Air gap between the last face and a film that touches it, mm: rays from the film need a distance to travel to the
/// face.
inline constexpr double kFilmContact = 1e-3;

inline constexpr int kMaxAsphericTerms = 8;  ///< terms r^4, r^6, ..., r^18
inline constexpr int kMaxIrisBlades = 24;
inline constexpr int kMaxRadialTerms = 38;  ///< terms r, r^2, ..., r^38
inline constexpr int kMaxXyDegree = 14;  ///< maximum of i + j of terms x^i y^j, and of the degree of Zernike terms
inline constexpr int kMaxForbesTerms = 13;  ///< Q_0 to Q_12
inline constexpr int kMaxObscurations = 16;  ///< of one surface
inline constexpr int kMaxApertureCorners = 32;  ///< of a polygonal aperture

}  // namespace REALCAM_NAMESPACE
