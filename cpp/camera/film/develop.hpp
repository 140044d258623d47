#pragma once
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "../../platform.hpp"

namespace REALCAM_NAMESPACE {

// Development: from exposures in lux seconds to linear values (1: white), by the ISO, and to 8-bit sRGB display values,
// by a tone curve.

/// Exposure in lux seconds as stored on the film: clamped to the largest float.
REALCAM_HD inline float film_exposure(double lux_s) {
    constexpr double kLargest = 3.4028234663852886e38;
    return static_cast<float>(lux_s < kLargest ? lux_s : kLargest);
}

/// Tone curve from film exposure to display value.
enum class ToneCurve : int {
    linear,  ///< clipped at white
    film,  ///< linear up to the middle tones, then a soft shoulder that compresses highlights instead of clipping them
};

/// Screen-linear value (1: white) of an exposure in lux seconds. ISO 12232 in its standard output sensitivity form: an
/// exposure of 10 lx s / S gives middle grey, the code value 118 of sRGB, which is 0.18 of white.
REALCAM_HD inline double sensor_value(double exposure_lux_s, double iso) {
    return 0.018 * iso * exposure_lux_s;
}

/// Linear display value, 0 to 1, of a screen-linear value (1: white). Negative values and NaN become 0.
REALCAM_HD inline double apply_tone_curve(ToneCurve curve, double value) {
    if (!(value > 0)) return 0;
    if (curve == ToneCurve::film) {
        constexpr double knee = 0.3;  // start of the shoulder; above middle grey, which is unchanged
        if (value > knee) value = 1 - (1 - knee) * std::exp(-(value - knee) / (1 - knee));
    }
    return value < 1 ? value : 1;
}

/// sRGB transfer function (IEC 61966-2-1) of a linear value in [0, 1].
template <class T>
REALCAM_HD T srgb_encoded(T linear) {
    return linear <= T(0.0031308) ? T(12.92) * linear : T(1.055) * std::pow(linear, T(1 / 2.4)) - T(0.055);
}

/// sRGB transfer function as a rounded 8-bit display value.
REALCAM_HD inline std::uint8_t srgb_code(double linear) {
    return static_cast<std::uint8_t>(srgb_encoded(linear) * 255 + 0.5);
}

/// 8-bit sRGB display value of a linear value (1: white), not rounded.
template <class T>
T code_of(T value) {
    return 255 * srgb_encoded(std::clamp(value, T(0), T(1)));
}

/// Tone-mapping table: maps exposures at one ISO to 8-bit display values by eight comparisons instead of a power and an
/// exponential. Gives the same values as srgb_code(apply_tone_curve(curve, sensor_value(exposure, iso))).
class CodeTable {
public:
    CodeTable(double iso, ToneCurve curve) {
        const auto code_of_bits = [&](std::uint32_t bits) {
            const double exposure = std::bit_cast<float>(bits);
            return srgb_code(apply_tone_curve(curve, sensor_value(exposure, iso)));
        };
        // Positive floats are ordered as their bit patterns are.
        std::uint32_t low = 0;
        const auto infinite = std::bit_cast<std::uint32_t>(std::numeric_limits<float>::infinity());
        for (unsigned code = 1; code < 256; ++code) {
            std::uint32_t high = infinite;
            while (low < high) {
                const std::uint32_t middle = low + (high - low) / 2;
                if (code_of_bits(middle) >= code)
                    high = middle;
                else
                    low = middle + 1;
            }
            first_exposure_[code] = std::bit_cast<float>(low);
        }
    }

    /// 8-bit display value of an exposure. Negative exposures and NaN are black.
    std::uint8_t operator()(float exposure_lux_s) const {
        unsigned code = 0;
        // Branch-free: in a noisy picture every second branch would be mispredicted.
        for (unsigned step = 128; step > 0; step /= 2)
            code += step * static_cast<unsigned>(exposure_lux_s >= first_exposure_[code + step]);
        return static_cast<std::uint8_t>(code);
    }

private:
    float first_exposure_[256] = {};  ///< least exposure of each code except 0, lux seconds
};

}  // namespace REALCAM_NAMESPACE
