#include "psf_measures.hpp"

#include <cmath>
#include <numbers>

#include "../../math/hypotenuse.hpp"

namespace realcam {

double energy_inside(const Psf& psf, double radius_um, Vec2<double> about_um) {
    constexpr int kParts = 16;
    const double reach = radius_um / psf.pitch_um;
    double sum = 0;
    for (int row = 0; row < psf.size; ++row)
        for (int column = 0; column < psf.size; ++column) {
            const double x = column - psf.size / 2 - about_um.x / psf.pitch_um;
            const double y = row - psf.size / 2 - about_um.y / psf.pitch_um, distance = hypotenuse(x, y);
            if (distance > reach + 0.8) continue;
            int inside = kParts * kParts;
            for (int i = 0; distance > reach - 0.8 && i < kParts * kParts; ++i)
                inside -=
                    hypotenuse(x + (i % kParts + 0.5) / kParts - 0.5, y + (i / kParts + 0.5) / kParts - 0.5) > reach;
            sum += psf.values[static_cast<std::size_t>(row * psf.size + column)] * inside / (kParts * kParts);
        }
    return sum * psf.pitch_um * psf.pitch_um;
}

double modulation(const Psf& psf, double frequency_per_mm, bool tangential) {
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

}  // namespace realcam
