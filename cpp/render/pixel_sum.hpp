#pragma once
#include <cstdint>
#include <limits>

#include "../camera/develop.hpp"
#include "render_samples.hpp"

namespace REALCAM_NAMESPACE {

/// What one pixel has collected. Sums in double: a million samples in float would drift by a thousandth. The pixels of
/// a picture may have different numbers of samples.
struct PixelSum {
    double irradiance[3];   ///< lux, summed over the samples
    double depth;           ///< metres, summed over those that met something
    std::uint64_t hits;     ///< samples that met something
    std::uint64_t samples;  ///< a small picture that is never finished passes 2^32 within minutes

    REALCAM_HD PixelSum& operator+=(const PixelSum& other) {
        for (int c = 0; c < 3; ++c) irradiance[c] += other.irradiance[c];
        depth += other.depth;
        hits += other.hits;
        samples += other.samples;
        return *this;
    }

    template <int N>
    REALCAM_INLINE void add(const PathResults<N>& results, int lane) {
        irradiance[0] += static_cast<double>(results.irradiance.r[lane]);
        irradiance[1] += static_cast<double>(results.irradiance.g[lane]);
        irradiance[2] += static_cast<double>(results.irradiance.b[lane]);
        if (results.depth[lane] >= 0) {
            depth += static_cast<double>(results.depth[lane]);
            ++hits;
        }
        ++samples;
    }

    /// Lux seconds on the film; 0 where no sample was taken.
    REALCAM_HD float exposure(int channel, double exposure_time_s) const {
        if (samples == 0) return 0;
        return film_exposure(irradiance[channel] * exposure_time_s / static_cast<double>(samples));
    }
    /// The same as 8-bit sRGB.
    REALCAM_HD std::uint8_t code(int channel, double exposure_time_s, double iso, ToneCurve curve) const {
        const double lux_s = static_cast<double>(exposure(channel, exposure_time_s));
        return srgb_code(apply_tone_curve(curve, sensor_value(lux_s, iso)));
    }
    /// Mean depth, metres; infinite where nothing was met.
    REALCAM_HD float mean_depth() const {
        return hits > 0 ? static_cast<float>(depth / static_cast<double>(hits))
                        : std::numeric_limits<float>::infinity();
    }
};

}  // namespace REALCAM_NAMESPACE
