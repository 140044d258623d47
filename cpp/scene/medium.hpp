#pragma once
#include "../math/color.hpp"

namespace REALCAM_NAMESPACE {

/// Homogeneous participating medium: the air, or the interior of glass. Scatters by the phase function of Henyey and
/// Greenstein (1941).
struct Medium {
    Color extinction = {0, 0, 0};  ///< extinction coefficient per metre: the sum of absorption and scattering
    Color scattering = {0, 0, 0};  ///< scattering coefficient per metre
    float anisotropy = 0;  ///< mean cosine of the scattering angle; positive: forward
};

/// Largest absolute value of Medium::anisotropy.
inline constexpr float kMaxAnisotropy = 0.99f;

}  // namespace REALCAM_NAMESPACE
