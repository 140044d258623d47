#include "film_setting.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "../../math/hypotenuse.hpp"
#include "../../math/least_squares.hpp"

namespace realcam {

namespace {

constexpr int kPlanes = 49;  ///< planes of the through-focus search, an eighth of the depth of focus apart

/// Returns the largest distance of a spot from the axis, mm; 1 if all spots are on the axis or without light.
double field_height(const std::vector<FieldSpot>& spots) {
    double height = 0;
    for (const FieldSpot& spot : spots)
        if (!spot.rays.empty()) height = std::max(height, hypotenuse(spot.chief_at(0).x, spot.chief_at(0).y));
    return height > 0 ? height : 1;
}

/// Through-focus contrast of each field on equally spaced planes, interpolated by parabolas.
struct FocusCurves {
    double first, step;  ///< shift of the first plane, and distance between planes, mm
    std::vector<std::vector<double>> fields;  ///< contrast of each field on each plane
    std::vector<Vec2<double>> points;  ///< film point of each field, mm

    /// Returns the mean contrast of the fields.
    double mean(const FilmAdjustment& film) const {
        double sum = 0;
        for (std::size_t f = 0; f < fields.size(); ++f) sum += value(fields[f], film.at(points[f]));
        return sum / static_cast<double>(fields.size());
    }

private:
    /// Interpolates a field's contrast at shift z; beyond the planes it is that of the last plane.
    double value(const std::vector<double>& curve, double z) const {
        const double last = static_cast<double>(curve.size() - 1), at = std::clamp((z - first) / step, 0.0, last);
        const double middle = std::clamp(std::round(at), 1.0, last - 1), t = at - middle;
        const std::size_t k = static_cast<std::size_t>(middle);
        const double rise = 0.5 * (curve[k + 1] - curve[k - 1]),
                     curvature = 0.5 * (curve[k + 1] + curve[k - 1]) - curve[k];
        return curve[k] + t * (rise + t * curvature);
    }
};

/// Maximises the mean contrast by coordinate ascent: changes one number of the film at a time by its step, and halves
/// all steps when no change improves the contrast. `numbers`: members of `film` to change; `steps`: their initial
/// steps.
void maximise_contrast(const FocusCurves& curves, FilmAdjustment& film, const std::vector<double*>& numbers,
                       std::vector<double> steps) {
    double best = curves.mean(film);
    for (int halving = 0; halving < 12; ++halving) {
        bool improved = true;
        for (int round = 0; improved && round < 20; ++round) {
            improved = false;
            for (std::size_t k = 0; k < numbers.size(); ++k)
                for (const double change : {steps[k], -steps[k]}) {
                    *numbers[k] += change;
                    if (const double contrast_now = curves.mean(film); contrast_now > best) {
                        best = contrast_now;
                        improved = true;
                    } else {
                        *numbers[k] -= change;
                    }
                }
        }
        for (double& step : steps) step *= 0.5;
    }
}

}  // namespace

FilmAdjustment film_for_small_spots(const std::vector<FieldSpot>& spots, FilmFreedom freedom) {
    const auto [moves, tilts] = freedom;
    FilmAdjustment film;
    if (!moves && !tilts) return film;
    const double height = field_height(spots);
    // Each mean square is c (z + b / c)^2 plus a constant, and z is linear in the film's numbers: a linear
    // least-squares problem.
    std::vector<std::vector<double>> columns(static_cast<std::size_t>(moves) + (tilts ? 2 : 0)), targets(1);
    for (const FieldSpot& spot : spots) {
        if (spot.rays.empty()) continue;
        const FieldSpot::MeanSquare square = spot.mean_square_radius();
        if (!(square.c > 0)) continue;
        const double root = std::sqrt(square.c);
        const Vec2<double> at = spot.chief_at(0);
        std::size_t k = 0;
        if (moves) columns[k++].push_back(root);
        if (tilts) {
            columns[k++].push_back(root * at.x / height);
            columns[k++].push_back(root * at.y / height);
        }
        targets[0].push_back(-square.b / root);
    }
    if (targets[0].empty()) return film;
    const std::vector<double> found = least_squares(columns, std::move(targets))[0];
    std::size_t k = 0;
    if (moves) film.shift = found[k++];
    if (tilts) film.slope = {found[k] / height, found[k + 1] / height};
    return film;
}

double mean_square(const std::vector<FieldSpot>& spots, const FilmAdjustment& film) {
    double sum = 0;
    for (const FieldSpot& spot : spots) {
        if (spot.rays.empty()) return std::numeric_limits<double>::quiet_NaN();
        const FieldSpot::MeanSquare square = spot.mean_square_radius();
        const double z = film.at(spot.chief_at(0));
        sum += square.a + (2 * square.b + square.c * z) * z;
    }
    return sum / static_cast<double>(spots.size());
}

FilmAdjustment film_for_high_contrast(const std::vector<FieldSpot>& spots, const std::vector<Vec2<double>>& outwards,
                                      double frequency, FilmFreedom freedom) {
    FilmAdjustment film = film_for_small_spots(spots, freedom);
    if (!freedom.moves && !freedom.tilts) return film;
    double max_half_slope = 0;
    for (const FieldSpot& spot : spots)
        if (!spot.rays.empty()) max_half_slope = std::max(max_half_slope, spot.half_slope());
    if (!(max_half_slope > 0)) return film;
    // Defocus with a blur of one period, at which a perfect lens has lost its contrast.
    const double depth = 1 / (2 * max_half_slope * frequency), height = field_height(spots);
    FocusCurves curves{0, 0.125 * depth, {}, {}};
    const double to_middle = 0.5 * (kPlanes - 1) * curves.step;
    curves.first = film.shift - to_middle;
    for (std::size_t f = 0; f < spots.size(); ++f) {
        if (spots[f].rays.empty()) continue;
        std::vector<double> curve(kPlanes, 0.0);
        for (const Vec2<double> along : {outwards[f], Vec2<double>{-outwards[f].y, outwards[f].x}})
            spots[f].add_contrast(curves.first, curves.step, along, frequency, curve);
        curves.fields.push_back(std::move(curve));
        curves.points.push_back(spots[f].chief_at(0));
    }
    if (freedom.moves) {
        FilmAdjustment trial = film;
        double best = curves.mean(film);
        for (int k = 0; k < kPlanes; ++k) {
            trial.shift = curves.first + k * curves.step;
            if (const double contrast_now = curves.mean(trial); contrast_now > best) {
                best = contrast_now;
                film = trial;
            }
        }
    }
    std::vector<double*> numbers;
    std::vector<double> steps;
    if (freedom.moves) numbers.push_back(&film.shift), steps.push_back(0.5 * curves.step);
    if (freedom.tilts) {
        numbers.insert(numbers.end(), {&film.slope.x, &film.slope.y});
        steps.insert(steps.end(), {4 * curves.step / height, 4 * curves.step / height});
    }
    maximise_contrast(curves, film, numbers, std::move(steps));
    return film;
}

double mean_contrast(const std::vector<FieldSpot>& spots, const std::vector<Vec2<double>>& outwards, double frequency,
                     const FilmAdjustment& film) {
    double sum = 0;
    for (std::size_t f = 0; f < spots.size(); ++f) {
        if (spots[f].rays.empty()) return std::numeric_limits<double>::quiet_NaN();
        const double z = film.at(spots[f].chief_at(0));
        for (const Vec2<double> along : {outwards[f], Vec2<double>{-outwards[f].y, outwards[f].x}})
            sum += spots[f].contrast(z, along, frequency);
    }
    return 0.5 * sum / static_cast<double>(spots.size());
}

FieldSpot::MeanSquare FieldSpot::mean_square_radius() const {
    Vec2<double> at{0, 0}, slope{0, 0};
    for (const auto& ray : rays) {
        at = {at.x + ray.weight * ray.at.x, at.y + ray.weight * ray.at.y};
        slope = {slope.x + ray.weight * ray.slope.x, slope.y + ray.weight * ray.slope.y};
    }
    MeanSquare sum{0, 0, 0};
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
    const double z = film + shift, radians_per_mm = 2 * std::numbers::pi * frequency;
    const Vec2<double> from = chief_at(shift);
    double real = 0, imaginary = 0;
    for (const auto& ray : rays) {
        const double x = ray.at.x + z * ray.slope.x - from.x, y = ray.at.y + z * ray.slope.y - from.y;
        const double phase = radians_per_mm * (along.x * x + along.y * y);
        real += ray.weight * std::cos(phase);
        imaginary += ray.weight * std::sin(phase);
    }
    return hypotenuse(real, imaginary);
}

void FieldSpot::add_contrast(double shift, double step, Vec2<double> along, double frequency,
                             std::vector<double>& sum) const {
    const double radians_per_mm = 2 * std::numbers::pi * frequency;
    const Vec2<double> from = chief_at(shift);
    std::vector<std::complex<double>> total(sum.size());
    for (const auto& ray : rays) {
        const double x = ray.at.x + (film + shift) * ray.slope.x - from.x;
        const double y = ray.at.y + (film + shift) * ray.slope.y - from.y;
        const double rise = along.x * (ray.slope.x - chief.slope.x) + along.y * (ray.slope.y - chief.slope.y);
        // The phase advances by the same angle from plane to plane. Real arithmetic, because products of std::complex
        // check for infinities.
        double real = ray.weight * std::cos(radians_per_mm * (along.x * x + along.y * y));
        double imaginary = ray.weight * std::sin(radians_per_mm * (along.x * x + along.y * y));
        const double cos = std::cos(radians_per_mm * step * rise), sin = std::sin(radians_per_mm * step * rise);
        for (std::complex<double>& plane : total) {
            plane += std::complex<double>(real, imaginary);
            const double next = real * cos - imaginary * sin;
            imaginary = real * sin + imaginary * cos;
            real = next;
        }
    }
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += std::abs(total[k]);
}

double FieldSpot::diffraction_limit(Vec2<double> along, double frequency,
                                    const std::vector<StudyColour>& colours) const {
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
