#include "ray_pair_table.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "../../error.hpp"

namespace realcam {

namespace {

constexpr float kUnlimited = std::numeric_limits<float>::infinity();

/// Number of monomials of LensPolynomialView::degree.
std::size_t monomial_count(int degree) {
    const auto n = static_cast<std::size_t>(degree);
    return (n + 1) * (n + 2) * (n + 3) / 6;
}

bool are_finite(const std::vector<float>& numbers) {
    return std::all_of(numbers.begin(), numbers.end(), [](float x) { return std::isfinite(x); });
}

/// Interval on the x axis of the plane of the last vertex through which light from a film point on the x axis passes,
/// mm. Both ends are 0 if no light passes.
struct LightInterval {
    double low = 0, high = 0;

    double centre() const { return 0.5 * (low + high); }
};

LightInterval meridional_light(const RayPairTable& table, double film_x) {
    constexpr int kSteps = 1024, kHalvings = 40;
    const LensPolynomialView view = table.view();
    const auto passes = [&](double last_x) {
        const LensPolynomialArguments<double> at(view, {film_x, 0}, {last_x, 0});
        bool inside = std::fabs(last_x) <= table.last_radius;
        for (int disc = 0; disc < view.disc_count; ++disc) inside &= std::fabs(disc_point(view, disc, at).x) <= 1;
        return inside;
    };
    const auto point = [&](int step) { return table.last_radius * (2.0 * step / kSteps - 1); };
    int first = 0, last = kSteps;
    while (first <= kSteps && !passes(point(first))) ++first;
    if (first > kSteps) return {};
    while (!passes(point(last))) --last;
    const auto edge = [&](double inside, double outside) {
        for (int i = 0; i < kHalvings; ++i) {
            const double middle = 0.5 * (inside + outside);
            (passes(middle) ? inside : outside) = middle;
        }
        return inside;
    };
    return {edge(point(first), point(first - 1)), edge(point(last), point(last + 1))};
}

/// Point of the plane of the last vertex, per mm of film height, through which the chief ray near the axis passes.
double chief_slope(const RayPairTable& table) {
    // Nearer to the axis, errors of the edges would move the pupil; farther away, rims cut it.
    const double film_x = 0.25 * table.film_radius;
    return meridional_light(table, film_x).centre() / film_x;
}

/// Thin plano-convex element whose plane face is behind its curved one. A paraboloid has a sag at any radius.
void add_element(LensSystem& lens, double power, double radius, double thickness) {
    Surface front, back;
    front.curvature = power;
    front.conic = -1;
    front.material = Glass::constant(2);
    front.clear_semi_diameter = back.clear_semi_diameter = radius;
    back.thickness = thickness;
    lens.surfaces.push_back(front);
    lens.surfaces.push_back(back);
}

}  // namespace

LensPolynomialView RayPairTable::view() const {
    LensPolynomialView view{};
    view.coefficients = coefficients.data();
    view.terms = static_cast<int>(monomial_count(degree));
    view.degree = degree;
    view.inverse_film_radius = static_cast<float>(1 / film_radius);
    view.inverse_last_radius = static_cast<float>(1 / last_radius);
    view.plane = static_cast<float>(plane);
    view.last_radius_squared = static_cast<float>(last_radius * last_radius);
    view.front_radius_squared = kUnlimited;
    view.heights = heights.empty() ? nullptr : heights.data();
    view.discs = discs.data();
    view.disc_count = disc_count();
    return view;
}

double RayPairTable::field_angle(double film_height) const {
    const LensPolynomialView view = this->view();
    const double x = std::min(film_height, film_radius);
    const LensPolynomialArguments<double> at(view, {x, 0}, {meridional_light(*this, x).centre(), 0});
    const Vec3d direction = evaluate(view, at).direction;
    return std::atan2(std::fabs(direction.x), -direction.z);
}

void validate(const RayPairTable& table) {
    const auto is_length = [](double x) { return x > 0 && x <= kLongest; };
    if (!is_length(table.length) || !is_length(table.film_distance) || !is_length(table.film_radius) ||
        !is_length(table.last_radius) || !is_length(table.film_width) || !is_length(table.film_height) ||
        !(std::fabs(table.plane) <= kLongest) || !(table.wavelength_nm >= 100 && table.wavelength_nm <= 20000))
        throw InputError("the ray pairs' lengths must be positive, up to 1e9 mm, and wavelengths 100 to 20000 nm");
    if (!(table.focus_distance > table.length + table.film_distance))
        throw InputError(
            "the focus distance of the ray pairs must be larger than that from the front vertex to the film");
    if (table.degree < 0 || table.degree > RayPairTable::kMaxDegree)
        throw InputError("the degree of the ray pairs' polynomials must lie between 0 and " +
                         std::to_string(RayPairTable::kMaxDegree));
    const std::size_t terms = monomial_count(table.degree);
    if (table.coefficients.size() != 2 * LensPolynomialView::kVectors * terms ||
        (!table.heights.empty() && table.heights.size() != 2 * terms))
        throw InputError("the number of the ray pairs' coefficients is not that of their degree");
    if (table.discs.empty() || table.disc_count() > RayPairTable::kMaxDiscs ||
        table.discs.size() % (2 * LensPolynomialView::kDiscTerms) != 0)
        throw InputError("the ray pairs must have 1 to " + std::to_string(RayPairTable::kMaxDiscs) + " discs of " +
                         std::to_string(2 * LensPolynomialView::kDiscTerms) + " coefficients");
    if (!are_finite(table.coefficients) || !are_finite(table.heights) || !are_finite(table.discs))
        throw InputError("a coefficient of the ray pairs is not a finite number");
    paraxial_lens(table);
}

LensSystem paraxial_lens(const RayPairTable& table) {
    const double length = table.length, film_distance = table.film_distance;
    // Linear terms in the x of the film point (0) and of the point of the last vertex plane (1), of the x of the ray's
    // position in front of the lens, and, from 2 on, of its direction.
    const auto coefficient = [&](int i) {
        return static_cast<double>(table.coefficients[static_cast<std::size_t>(i)]);
    };
    const bool has_heights = !table.heights.empty();
    const double z = has_heights ? static_cast<double>(table.heights[0]) : table.plane;
    const double forward = has_heights ? -static_cast<double>(table.heights[1]) : 1;
    const double scales[] = {1 / table.film_radius, 1 / table.last_radius};
    double height[2], slope[2];  // slopes dx/dz, with z growing towards the film
    for (int i = 0; i < 2; ++i) {
        slope[i] = -coefficient(2 + i) / forward * scales[i];
        height[i] = coefficient(i) * scales[i] - z * slope[i];
    }
    // Matrix [a b; c d] from height and slope at the last vertex to those at the front one: film height = last height +
    // film_distance * slope. Its inverse [A B; C D] is the system matrix of the lens.
    const double a = height[0] + height[1], b = height[0] * film_distance, c = slope[0] + slope[1],
                 d = slope[0] * film_distance;
    const double determinant = a * d - b * c;
    const double A = d / determinant, B = -b / determinant, D = a / determinant;
    const double chief = chief_slope(table), chief_height = height[0] + height[1] * chief,
                 pupil = -chief_height / (slope[0] + slope[1] * chief);
    // The heights of the chief ray at both vertices have opposite signs; the stop divides the length in their ratio.
    const double to_stop = length / (B / pupil + 1 - A), behind = length - to_stop;
    // Powers of thin elements at the front vertex, the stop and the last vertex that have this system matrix.
    const double middle = (length - B) / (to_stop * behind), first = (1 - behind * middle - A) / B,
                 last = (1 - to_stop * middle - D) / B;
    const double rim = meridional_light(table, 0).high;
    const double stop_radius = std::fabs(rim - behind * (last * rim - rim / film_distance));
    const bool is_lens = std::fabs(determinant - 1) < 0.02 && to_stop > 0 && behind > 0 && stop_radius > 0 &&
                         std::isfinite(first) && std::isfinite(middle) && std::isfinite(last) && std::isfinite(rim);
    if (!is_lens)
        throw InputError(
            "the rays near the axis are not those of a lens in air whose chief rays cross the axis between the planes "
            "of the ray pairs");
    LensSystem lens;
    lens.name = table.name;
    lens.wavelength_nm = table.wavelength_nm;
    lens.film_width = table.film_width;
    lens.film_height = table.film_height;
    lens.film_distance = film_distance;
    lens.stop_semi_diameter = stop_radius;
    lens.allow_overlap = true;
    lens.focus_distance = table.focus_distance;
    add_element(lens, first, table.last_radius, to_stop);
    Surface stop;
    stop.type = SurfaceType::stop;
    stop.clear_semi_diameter = stop_radius;
    lens.surfaces.push_back(stop);
    add_element(lens, middle, table.last_radius, behind);
    add_element(lens, last, table.last_radius, 0);
    return lens;
}

}  // namespace realcam
