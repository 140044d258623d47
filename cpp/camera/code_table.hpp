#pragma once
#include <bit>
#include <cstdint>
#include <limits>

#include "develop.hpp"

namespace REALCAM_NAMESPACE {

/// 8-bit codes of exposures at one sensitivity, as develop.hpp has them, by eight comparisons instead of a power and an
/// exponential.
class CodeTable {
public:
    CodeTable(double iso, ToneCurve curve) {
        const auto code_of_bits = [&](std::uint32_t bits) {
            const double exposure = std::bit_cast<float>(bits);
            return srgb_code(apply_tone_curve(curve, sensor_value(exposure, iso)));
        };
        // Positive floats are in the order of their bits.
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
            begins_[code] = std::bit_cast<float>(low);
        }
    }

    /// What is below zero is black, and so is NaN.
    std::uint8_t operator()(float exposure_lux_s) const {
        unsigned code = 0;
        // Without branches: of a noisy picture every other one would be foretold wrongly.
        for (unsigned step = 128; step > 0; step /= 2)
            code += step * static_cast<unsigned>(exposure_lux_s >= begins_[code + step]);
        return static_cast<std::uint8_t>(code);
    }

private:
    float begins_[256] = {};  ///< the least exposure of each code but the first, lux seconds
};

}  // namespace REALCAM_NAMESPACE
