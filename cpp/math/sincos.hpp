#pragma once
#include "vec3.hpp"

namespace REALCAM_NAMESPACE {

/// Returns the cosine (x) and sine (y) of an angle in full turns, 0 <= turns < 1, with errors below 2e-7. It uses only
/// basic arithmetic, so that loops over lanes become vector code and all backends get the same bits. The standard
/// library guarantees neither.
REALCAM_INLINE Vec2f cos_sin_of_turn(float turns) {
    const float quarters = 4.0f * turns;
    const int nearest = static_cast<int>(quarters + 0.5f);
    const float x = (quarters - static_cast<float>(nearest)) * 1.5707963268f;  // from -pi / 4 to pi / 4
    const float x2 = x * x;
    // Taylor polynomials. The first omitted term is 3e-8 (sin) and 3e-9 (cos) at pi / 4.
    const float sin = x * (1.0f + x2 * (-1.0f / 6 + x2 * (1.0f / 120 + x2 * (-1.0f / 5040 + x2 * (1.0f / 362880)))));
    const float cos = 1.0f + x2 * (-0.5f + x2 * (1.0f / 24 + x2 * (-1.0f / 720 + x2 * (1.0f / 40320))));
    const bool swapped = (nearest & 1) != 0;
    const float a = swapped ? sin : cos, b = swapped ? cos : sin;
    const int quadrant = nearest & 3;
    return {((quadrant == 1) | (quadrant == 2)) ? -a : a, quadrant >= 2 ? -b : b};
}

/// Density of an angle drawn uniformly from a full turn, per radian: 1 / (2 pi).
inline constexpr float kTurnPdf = 0.1591549431f;

}  // namespace REALCAM_NAMESPACE
