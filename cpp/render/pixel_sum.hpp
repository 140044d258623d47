#pragma once
#include <cstdint>
#include <limits>

#include "../camera/develop.hpp"
#include "path_state.hpp"

namespace REALCAM_NAMESPACE {

/// What one pixel has collected. Sums in double: a million samples in float would drift by a thousandth. The pixels of
/// a picture may have different numbers of samples.
struct PixelSum {
    double irradiance[3];   ///< lux, summed over the samples
    double squares[3];      ///< of the samples' irradiance, summed, where they are asked for
    double depth;  ///< metres, summed over those that met something, times their weight in the exposure
    double met;    ///< their weight
    std::uint64_t samples;  ///< a small picture that is never finished passes 2^32 within minutes

    REALCAM_HD PixelSum& operator+=(const PixelSum& other) {
        for (int c = 0; c < 3; ++c) irradiance[c] += other.irradiance[c];
        for (int c = 0; c < 3; ++c) squares[c] += other.squares[c];
        depth += other.depth;
        met += other.met;
        samples += other.samples;
        return *this;
    }

    template <int N>
    REALCAM_INLINE void add(const PathResults<N>& results, int lane) {
        irradiance[0] += static_cast<double>(results.irradiance.r[lane]);
        irradiance[1] += static_cast<double>(results.irradiance.g[lane]);
        irradiance[2] += static_cast<double>(results.irradiance.b[lane]);
        if (results.depth[lane] < kFarAway) {
            const double weight = static_cast<double>(results.weight[lane]);
            depth += weight * static_cast<double>(results.depth[lane]);
            met += weight;
        }
        ++samples;
    }

    template <int N>
    REALCAM_INLINE void add_squares(const PathResults<N>& results, int lane) {
        const Color c = results.irradiance[lane];
        const double rgb[3] = {static_cast<double>(c.r), static_cast<double>(c.g), static_cast<double>(c.b)};
        for (int i = 0; i < 3; ++i) squares[i] += rgb[i] * rgb[i];
    }

    /// Lux seconds on the film; 0 where no sample was taken. `ghosts`: irradiance that was found apart from them, lux.
    REALCAM_HD float exposure(int channel, double exposure_time_s, double ghosts = 0) const {
        if (samples == 0) return 0;
        return film_exposure((irradiance[channel] / static_cast<double>(samples) + ghosts) * exposure_time_s);
    }
    /// The same as 8-bit sRGB.
    REALCAM_HD std::uint8_t code(int channel, double exposure_time_s, double iso, ToneCurve curve,
                                 double ghosts = 0) const {
        const double lux_s = static_cast<double>(exposure(channel, exposure_time_s, ghosts));
        return srgb_code(apply_tone_curve(curve, sensor_value(lux_s, iso)));
    }
    /// Variance of the exposure, (lux seconds)^2, as the mean of independent samples; NaN for fewer than two. `ghosts`:
    /// that of the irradiance that was found apart from them, lux^2.
    REALCAM_HD float variance(int channel, double exposure_time_s, double ghosts = 0) const {
        if (samples < 2) return std::numeric_limits<float>::quiet_NaN();
        const double n = static_cast<double>(samples), sum = irradiance[channel];
        const double spread = squares[channel] - sum * sum / n;
        return film_exposure(((spread > 0 ? spread : 0) / (n * (n - 1)) + ghosts) * exposure_time_s * exposure_time_s);
    }
    /// Mean depth, metres; infinite where nothing was met.
    REALCAM_HD float mean_depth() const {
        return met > 0 ? static_cast<float>(depth / met) : std::numeric_limits<float>::infinity();
    }
};

}  // namespace REALCAM_NAMESPACE
