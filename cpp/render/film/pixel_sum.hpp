#pragma once
#include <cstdint>
#include <limits>

#include "../../camera/film/develop.hpp"
#include "../path/path_state.hpp"

namespace REALCAM_NAMESPACE {

/// Accumulated samples of one pixel. Sums are in double: a million samples in float would drift by a thousandth. The
/// pixels of a picture may have different numbers of samples.
struct PixelSum {
    double irradiance[3];  ///< lux, linear Rec. 709, summed over the samples
    double auxiliary[3];  ///< additional sums: squares of the samples' irradiance (Layer::variance), or the irradiance
                          ///< through the right half of the exit pupil (kHalfLayers); otherwise, for samples with
                          ///< wavelengths, their excess (film_control_variates.hpp)
    double depth;  ///< metres, summed over the samples that hit a surface, weighted by their weight in the exposure
    double met;  ///< sum of the weights of these samples
    std::uint64_t samples;  ///< number of samples: 64 bits, because an endless rendering of a small picture takes more
                            ///< than 2^32 within minutes
    std::uint64_t passed;  ///< number of samples that passed the lens

    REALCAM_HD PixelSum& operator+=(const PixelSum& other) {
        for (int c = 0; c < 3; ++c) irradiance[c] += other.irradiance[c];
        for (int c = 0; c < 3; ++c) auxiliary[c] += other.auxiliary[c];
        add_all_but_colours(other);
        return *this;
    }
    /// Adds the sums except `irradiance` and `auxiliary`.
    REALCAM_HD void add_all_but_colours(const PixelSum& other) {
        depth += other.depth;
        met += other.met;
        samples += other.samples;
        passed += other.passed;
    }

    /// Adds irradiance, without counting a sample.
    REALCAM_INLINE void add(Color c) {
        irradiance[0] += static_cast<double>(c.r);
        irradiance[1] += static_cast<double>(c.g);
        irradiance[2] += static_cast<double>(c.b);
    }

    /// Adds one sample, except its `auxiliary` values.
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

    // One of the next three functions, which PixelSum::auxiliary is used for, is called for each sample.

    /// Adds the excess of a sample.
    REALCAM_INLINE void add_excess(Color c) {
        auxiliary[0] += static_cast<double>(c.r);
        auxiliary[1] += static_cast<double>(c.g);
        auxiliary[2] += static_cast<double>(c.b);
    }

    /// Adds the squares of a sample's irradiance.
    template <int N>
    REALCAM_INLINE void add_squares(const PathResults<N>& results, int lane) {
        const Color c = results.irradiance[lane];
        const double rgb[3] = {static_cast<double>(c.r), static_cast<double>(c.g), static_cast<double>(c.b)};
        for (int i = 0; i < 3; ++i) auxiliary[i] += rgb[i] * rgb[i];
    }
    /// Adds a sample's irradiance if it came through the right half of the exit pupil. `is_right`: see find_right_half.
    template <int N>
    REALCAM_INLINE void add_half(const PathResults<N>& results, int lane, bool is_right) {
        if (!is_right) return;
        const Color c = results.irradiance[lane];
        auxiliary[0] += static_cast<double>(c.r);
        auxiliary[1] += static_cast<double>(c.g);
        auxiliary[2] += static_cast<double>(c.b);
    }

    /// Returns the exposure in lux seconds; 0 without samples. `splatted`: irradiance by splatted light, lux. `factor`:
    /// factor of the control variates (film_control_variates.hpp).
    REALCAM_HD float exposure(int channel, double exposure_time_s, double splatted = 0, double factor = 1) const {
        if (samples == 0) return 0;
        return film_exposure((factor * irradiance[channel] / static_cast<double>(samples) + splatted) *
                             exposure_time_s);
    }
    /// Returns the variance of the exposure, (lux seconds)^2, as the mean of independent samples; NaN for fewer than
    /// two. `splatted`: variance of the splatted irradiance, lux^2. Requires squares in `auxiliary`.
    REALCAM_HD float variance(int channel, double exposure_time_s, double splatted = 0) const {
        if (samples < 2) return std::numeric_limits<float>::quiet_NaN();
        const double n = static_cast<double>(samples), sum = irradiance[channel];
        const double spread = auxiliary[channel] - sum * sum / n;
        return film_exposure(((spread > 0 ? spread : 0) / (n * (n - 1)) + splatted) * exposure_time_s *
                             exposure_time_s);
    }
    /// Returns the exposure through the right half of the exit pupil, with half of the splatted light. Requires
    /// add_half.
    REALCAM_HD float right_exposure(int channel, double exposure_time_s, double splatted = 0, double factor = 1) const {
        if (samples == 0) return 0;
        const double mean = factor * auxiliary[channel] / static_cast<double>(samples);
        return film_exposure((mean + 0.5 * splatted) * exposure_time_s);
    }
    /// Mean depth, metres; infinite if no sample hit a surface.
    REALCAM_HD float mean_depth() const {
        return met > 0 ? static_cast<float>(depth / met) : std::numeric_limits<float>::infinity();
    }
};

}  // namespace REALCAM_NAMESPACE
