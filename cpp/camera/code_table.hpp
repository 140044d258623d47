#pragma once
#include <bit>
#include <cstdint>
#include <limits>

#include "develop.hpp"

namespace REALCAM_NAMESPACE {

/// Tone-mapping table: 8-bit display values of exposures at one ISO (see develop.hpp), found by eight comparisons
/// instead of a power and an exponential.
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
            begins_[code] = std::bit_cast<float>(low);
        }
    }

    /// Negative exposures and NaN are black.
    std::uint8_t operator()(float exposure_lux_s) const {
        unsigned code = 0;
        // Branch-free: in a noisy picture every second branch would be mispredicted.
        for (unsigned step = 128; step > 0; step /= 2)
            code += step * static_cast<unsigned>(exposure_lux_s >= begins_[code + step]);
        return static_cast<std::uint8_t>(code);
    }

private:
    float begins_[256] = {};  ///< least exposure of each code except 0, lux seconds
};

}  // namespace REALCAM_NAMESPACE
