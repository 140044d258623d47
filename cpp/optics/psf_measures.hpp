#pragma once
#include "psf.hpp"

namespace REALCAM_NAMESPACE {

/// Share of the light within a circle about a place of the PSF, um from its middle point. Squares about the points
/// count by the part of their area that is in the circle. What lies beyond the array is not counted.
inline double energy_inside(const Psf& psf, double radius_um, Vec2<double> about_um = {0, 0}) {
    constexpr int kParts = 16;
    const double reach = radius_um / psf.pitch_um;
    double sum = 0;
    for (int row = 0; row < psf.size; ++row)
        for (int column = 0; column < psf.size; ++column) {
            const double x = column - psf.size / 2 - about_um.x / psf.pitch_um;
            const double y = row - psf.size / 2 - about_um.y / psf.pitch_um, distance = std::hypot(x, y);
            if (distance > reach + 0.8) continue;
            int inside = kParts * kParts;
            for (int i = 0; distance > reach - 0.8 && i < kParts * kParts; ++i)
                inside -=
                    std::hypot(x + (i % kParts + 0.5) / kParts - 0.5, y + (i / kParts + 0.5) / kParts - 0.5) > reach;
            sum += psf.values[static_cast<std::size_t>(row * psf.size + column)] * inside / (kParts * kParts);
        }
    return sum * psf.pitch_um * psf.pitch_um;
}

/// Modulation of lines of a frequency, per mm on the film: across y (tangential) or x (sagittal). Not divided by the
/// light on the array, so that light beyond it counts as lost to all modulation: the tails of diffraction are smooth.
inline double modulation(const Psf& psf, double frequency_per_mm, bool tangential) {
    if (frequency_per_mm == 0) return 1;
    std::complex<double> sum = 0;
    for (int i = 0; i < psf.size; ++i) {
        double line = 0;
        for (int k = 0; k < psf.size; ++k)
            line += psf.values[static_cast<std::size_t>(tangential ? i * psf.size + k : k * psf.size + i)];
        sum += std::polar(line, -2e-3 * std::numbers::pi * frequency_per_mm * (i - psf.size / 2) * psf.pitch_um);
    }
    return std::abs(sum) * psf.pitch_um * psf.pitch_um;
}

}  // namespace REALCAM_NAMESPACE
