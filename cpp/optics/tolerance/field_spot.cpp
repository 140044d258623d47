#include "field_spot.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "../../math/hypotenuse.hpp"

namespace realcam {

FieldSpot::Square FieldSpot::square() const {
    Vec2<double> at{0, 0}, slope{0, 0};
    for (const auto& ray : rays) {
        at = {at.x + ray.weight * ray.at.x, at.y + ray.weight * ray.at.y};
        slope = {slope.x + ray.weight * ray.slope.x, slope.y + ray.weight * ray.slope.y};
    }
    Square sum{0, 0, 0};
    for (const auto& ray : rays) {
        const double sx = ray.slope.x - slope.x, sy = ray.slope.y - slope.y;
        const double x = ray.at.x - at.x + film * sx, y = ray.at.y - at.y + film * sy;
        sum.a += ray.weight * (x * x + y * y);
        sum.b += ray.weight * (x * sx + y * sy);
        sum.c += ray.weight * (sx * sx + sy * sy);
    }
    return sum;
}

Vec2<double> FieldSpot::chief_at(double shift) const {
    const double z = film + shift;
    return {chief.at.x + z * chief.slope.x, chief.at.y + z * chief.slope.y};
}

double FieldSpot::contrast(double shift, Vec2<double> along, double frequency) const {
    const double z = film + shift, turn = 2 * std::numbers::pi * frequency;
    const Vec2<double> from = chief_at(shift);
    double real = 0, imaginary = 0;
    for (const auto& ray : rays) {
        const double x = ray.at.x + z * ray.slope.x - from.x, y = ray.at.y + z * ray.slope.y - from.y;
        const double phase = turn * (along.x * x + along.y * y);
        real += ray.weight * std::cos(phase);
        imaginary += ray.weight * std::sin(phase);
    }
    return hypotenuse(real, imaginary);
}

void FieldSpot::add_contrast(double shift, double step, Vec2<double> along, double frequency,
                             std::vector<double>& sum) const {
    const double turn = 2 * std::numbers::pi * frequency;
    const Vec2<double> from = chief_at(shift);
    std::vector<std::complex<double>> total(sum.size());
    for (const auto& ray : rays) {
        const double x = ray.at.x + (film + shift) * ray.slope.x - from.x;
        const double y = ray.at.y + (film + shift) * ray.slope.y - from.y;
        const double rise = along.x * (ray.slope.x - chief.slope.x) + along.y * (ray.slope.y - chief.slope.y);
        // The phase advances by the same angle from plane to plane. Real arithmetic, because products of std::complex
        // check for infinities.
        double real = ray.weight * std::cos(turn * (along.x * x + along.y * y));
        double imaginary = ray.weight * std::sin(turn * (along.x * x + along.y * y));
        const double cos = std::cos(turn * step * rise), sin = std::sin(turn * step * rise);
        for (std::complex<double>& plane : total) {
            plane += std::complex<double>(real, imaginary);
            const double next = real * cos - imaginary * sin;
            imaginary = real * sin + imaginary * cos;
            real = next;
        }
    }
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += std::abs(total[k]);
}

double FieldSpot::limit(Vec2<double> along, double frequency, const std::vector<StudyColour>& colours) const {
    double mean = 0, square = 0;
    for (const auto& ray : rays) {
        const Vec2<double> s = ray.slope;
        const double cosine = (along.x * s.x + along.y * s.y) / std::sqrt(1 + s.x * s.x + s.y * s.y);
        mean += ray.weight * cosine;
        square += ray.weight * cosine * cosine;
    }
    // The variance of a uniform disc along one axis is a quarter of its squared radius.
    const double radius = 2 * index * std::sqrt(std::max(0.0, square - mean * mean));
    double sum = 0, weights = 0;
    for (const StudyColour& colour : colours) {
        const double u = std::min(1.0, 0.5e-6 * colour.wavelength_nm * frequency / radius);
        sum += colour.weight * 2 / std::numbers::pi * (std::acos(u) - u * std::sqrt(1 - u * u));
        weights += colour.weight;
    }
    return sum / weights;
}

}  // namespace realcam
