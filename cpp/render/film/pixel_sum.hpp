#pragma once
#include <cstdint>
#include <limits>

#include "../../camera/film/develop.hpp"
#include "../path/path_state.hpp"

namespace REALCAM_NAMESPACE {

/// Accumulated samples of one pixel. Sums are in double: a million samples in float would drift by a thousandth. The
/// pixels of a picture may have different numbers of samples.
struct PixelSum {
    double irradiance[3];   ///< lux, summed over the samples
    double auxiliary[3];  ///< additional sums: squares of the samples' irradiance (Layer::variance), or the irradiance
                          ///< through the right half of the exit pupil (kHalfLayers); otherwise, for samples with
                          ///< wavelengths, their excess (film_control_variates.hpp)
    double depth;  ///< metres, summed over samples that hit a surface, times their weight in the exposure
    double met;  ///< sum of these weights
    std::uint64_t samples, passed;  ///< passed: through the lens; a small picture that is never finished has more than
                                    ///< 2^32 samples within minutes

    REALCAM_HD PixelSum& operator+=(const PixelSum& other) {
        for (int c = 0; c < 3; ++c) irradiance[c] += other.irradiance[c];
        for (int c = 0; c < 3; ++c) auxiliary[c] += other.auxiliary[c];
        add_all_but_colours(other);
        return *this;
    }
    REALCAM_HD void add_all_but_colours(const PixelSum& other) {
        depth += other.depth;
        met += other.met;
        samples += other.samples;
        passed += other.passed;
    }

    REALCAM_INLINE void add(Color c) {
        irradiance[0] += static_cast<double>(c.r);
        irradiance[1] += static_cast<double>(c.g);
        irradiance[2] += static_cast<double>(c.b);
    }

    template <int N>
    REALCAM_INLINE void add(const PathResults<N>& results, int lane) {
        add(results.irradiance[lane]);
        if (results.depth[lane] < kFarAway) {
            const double weight = static_cast<double>(results.weight[lane]);
            depth += weight * static_cast<double>(results.depth[lane]);
            met += weight;
        }
        ++samples;
        passed += static_cast<std::uint64_t>(results.passed[lane]);
    }

    REALCAM_INLINE void add_excess(Color c) {
        auxiliary[0] += static_cast<double>(c.r);
        auxiliary[1] += static_cast<double>(c.g);
        auxiliary[2] += static_cast<double>(c.b);
    }

    template <int N>
    REALCAM_INLINE void add_squares(const PathResults<N>& results, int lane) {
        const Color c = results.irradiance[lane];
        const double rgb[3] = {static_cast<double>(c.r), static_cast<double>(c.g), static_cast<double>(c.b)};
        for (int i = 0; i < 3; ++i) auxiliary[i] += rgb[i] * rgb[i];
    }
    /// `is_right`: true if the sample came through the right half (find_right_half).
    template <int N>
    REALCAM_INLINE void add_half(const PathResults<N>& results, int lane, bool is_right) {
        if (!is_right) return;
        const Color c = results.irradiance[lane];
        auxiliary[0] += static_cast<double>(c.r);
        auxiliary[1] += static_cast<double>(c.g);
        auxiliary[2] += static_cast<double>(c.b);
    }

    /// Lux seconds on the film; 0 without samples. `ghosts`: irradiance that was traced apart from the samples, lux.
    /// `balance`: factor of film_control_variates.hpp.
    REALCAM_HD float exposure(int channel, double exposure_time_s, double ghosts = 0, double balance = 1) const {
        if (samples == 0) return 0;
        return film_exposure((balance * irradiance[channel] / static_cast<double>(samples) + ghosts) * exposure_time_s);
    }
    /// Variance of the exposure, (lux seconds)^2, as the mean of independent samples; NaN for fewer than two. `ghosts`:
    /// variance of the irradiance that was traced apart from the samples, lux^2.
    REALCAM_HD float variance(int channel, double exposure_time_s, double ghosts = 0) const {
        if (samples < 2) return std::numeric_limits<float>::quiet_NaN();
        const double n = static_cast<double>(samples), sum = irradiance[channel];
        const double spread = auxiliary[channel] - sum * sum / n;
        return film_exposure(((spread > 0 ? spread : 0) / (n * (n - 1)) + ghosts) * exposure_time_s * exposure_time_s);
    }
    /// Exposure through the right half of the exit pupil. Half of the ghosts is counted for it.
    REALCAM_HD float right_exposure(int channel, double exposure_time_s, double ghosts = 0, double balance = 1) const {
        if (samples == 0) return 0;
        const double mean = balance * auxiliary[channel] / static_cast<double>(samples);
        return film_exposure((mean + 0.5 * ghosts) * exposure_time_s);
    }
    /// Mean depth, metres; infinite if no sample hit a surface.
    REALCAM_HD float mean_depth() const {
        return met > 0 ? static_cast<float>(depth / met) : std::numeric_limits<float>::infinity();
    }
};

}  // namespace REALCAM_NAMESPACE
