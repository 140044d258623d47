#pragma once
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "form_kind.hpp"

namespace REALCAM_NAMESPACE {

/// Superconic surface: A. W. Greynolds, "Superconic and subconic surfaces in optical design", Proc. SPIE 4832, 1
/// (2002). With s^2 = r^2 + z^2 and w = (s / radius)^2 it is the implicit surface
///     s^2 (1 + U_1 w + U_2 w^2 + ...) + k z^2 + radius z (V_1 w + V_2 w^2 + ...) = 2 z / c.
/// It is a conic if all coefficients are 0, and a Cartesian oval with U_1 and V_1. Its sag is found by Newton's method,
/// and it is traced as a polynomial in r^2 that is fitted to the departure from the conic. The methods are those of
/// form_kind.hpp.
struct SuperconicTerms {
    double radius = 1;  ///< unit of s, mm
    std::vector<double> coefficients;  ///< U_1, V_1, U_2, V_2, ...

    static constexpr FormNames words = {.key = "superconic",
                                        .name = "superconic",
                                        .first_number = 1,
                                        .coefficients_key = "coefficients",
                                        .are_lengths = false};

    bool operator==(const SuperconicTerms&) const = default;

    int max_coefficients() const { return 20; }
    template <class Surface>
    std::string error(const Surface& surface) const {
        if (!surface.form.has_conic_base()) return "superconic terms depart from a conic of revolution";
        if (surface.form.forbes) return "has both superconic and Forbes terms, which are traced by one polynomial";
        const ConicNumbers<double> conic = {surface.curvature, surface.conic};
        if (is_fit_accurate(conic, surface.clear_semi_diameter)) return "";
        return "its superconic terms depart too strongly from the conic for the polynomial of degree " +
               std::to_string(2 * kMaxForbesTerms + 2) + " in r with which they are traced";
    }
    void negate() {
        for (std::size_t i = 1; i < coefficients.size(); i += 2) coefficients[i] = -coefficients[i];
    }
    void add_sag(double& z, double x, double y, const ConicNumbers<double>& conic) const {
        z += departure(x * x + y * y, conic, coefficients);
    }
    double vertex_curvature() const { return 0; }
    /// Sets the polynomial q(v), v = (r / reach)^2, for which v^2 q(v) interpolates the departure from the conic at
    /// Chebyshev nodes of v.
    template <class T>
    void add_to(FormPolynomials<T>& polynomials, const std::vector<T>& numbers, const ConicNumbers<T>& conic) const {
        constexpr int n = kMaxForbesTerms;
        constexpr double kStep = std::numbers::pi / (2 * n);
        const double squared = polynomials.reach * polynomials.reach;
        polynomials.even.assign(n, T(0.0));
        polynomials.even_radius = polynomials.reach;
        polynomials.is_bfs = false;
        for (int i = 0; i < n; ++i) {
            const double v = 0.5 + 0.5 * std::cos((2 * i + 1) * kStep);
            const T value = departure(v * squared, conic, numbers) / T(v * v);
            // Chebyshev polynomials of degree m - 1 and m in powers of 2 v - 1.
            std::vector<double> previous = {0}, current = {1};
            for (int m = 0; m < n; ++m) {
                const double weight = (m == 0 ? 1.0 : 2.0) / n * std::cos(m * (2 * i + 1) * kStep);
                for (std::size_t k = 0; k < current.size(); ++k) polynomials.even[k] += value * (weight * current[k]);
                std::vector<double> next(current.size() + 1, 0.0);
                for (std::size_t k = 0; k < current.size(); ++k) next[k + 1] = (m == 0 ? 1 : 2) * current[k];
                if (m > 0)
                    for (std::size_t k = 0; k < previous.size(); ++k) next[k] -= previous[k];
                previous = current;
                current = next;
            }
        }
    }
    const char* beyond_polynomials() const { return "superconic terms"; }

private:
    /// A polynomial in w, and its derivative by w.
    template <class T>
    struct Sum {
        T value, slope;
    };

    /// Returns numbers[first] w + numbers[first + 2] w^2 + ...: U(w) for `first` 0, V(w) for 1.
    template <class T>
    static Sum<T> sum_of(const std::vector<T>& numbers, std::size_t first, const T& w) {
        Sum<T> sum{T(0.0), T(0.0)};
        if (numbers.size() <= first) return sum;
        const std::size_t last = first + (numbers.size() - 1 - first) / 2 * 2;  // last index of the same parity
        for (std::size_t i = last + 2; i > first;) {
            i -= 2;
            sum.slope = sum.slope * w + sum.value + numbers[i];
            sum.value = (sum.value + numbers[i]) * w;
        }
        return sum;
    }

    /// Returns the sag minus that of the conic, mm, at the squared distance `r2` from the axis, mm^2; NaN if the
    /// surface ends before. `numbers`: the coefficients, in the number type of the derivatives. With z = z_0 + d, where
    /// z_0 is the conic's sag, the conic's own terms cancel:
    ///     c ((1 + k) (z_0 + z) d + s^2 U + radius z V) = 2 d,
    /// which gives d without loss of digits near the vertex.
    template <class T>
    T departure(double r2, const ConicNumbers<T>& conic, const std::vector<T>& numbers) const {
        using std::sqrt;
        constexpr double kRounding = 16 * std::numeric_limits<double>::epsilon();
        constexpr int kMaxSteps = 50;
        // Difference of the two sides of this equation for a departure d, in the number type of the other arguments.
        const auto difference = [&](const auto& c, const auto& k, const auto& list, const auto& z_0, double d) {
            const auto z = z_0 + d, s2 = r2 + z * z, w = s2 * (1 / (radius * radius));
            const auto u = sum_of(list, 0, w), v = sum_of(list, 1, w);
            return c * ((1 + k) * (z_0 + z) * d + s2 * u.value + radius * z * v.value) - 2 * d;
        };
        const double c = plain_value(conic.curvature), k = plain_value(conic.conic);
        const double z_0 = c * r2 / (1 + std::sqrt(1 - (1 + k) * c * c * r2));
        double d = 0;
        for (int step = 0; step < kMaxSteps; ++step) {
            const double z = z_0 + d, s2 = r2 + z * z, w = s2 / (radius * radius);
            const auto u = sum_of(coefficients, 0, w), v = sum_of(coefficients, 1, w);
            const double slope =
                2 * c *
                    ((1 + k) * z + z * (u.value + w * u.slope) + 0.5 * radius * v.value + z * z / radius * v.slope) -
                2;
            // Negative at the vertex, and 0 where the surface becomes parallel to the axis.
            if (!(slope < 0)) break;
            const double change = difference(c, k, coefficients, z_0, d) / slope;
            d -= change;
            const double size = std::fabs(d) + std::fabs(c * s2 * u.value) + std::fabs(c * radius * z * v.value);
            if (!(std::fabs(change) <= kRounding * size / -slope)) continue;
            // One more step, in dual numbers if T is one, gives the derivatives.
            const T dual_c = conic.curvature, dual_k = conic.conic;
            const T dual_z_0 = dual_c * r2 / (1 + sqrt(1 - (1 + dual_k) * dual_c * dual_c * r2));
            return T(d) - difference(dual_c, dual_k, numbers, dual_z_0, d) / T(slope);
        }
        return T(std::numeric_limits<double>::quiet_NaN());
    }

    /// True if the polynomial of add_to equals the departure from the conic up to 2% beyond the rim, to 1e-10 of the
    /// rim's radius `rim`, mm. Also true if the surface ends before the rim, which another check reports.
    bool is_fit_accurate(const ConicNumbers<double>& conic, double rim) const {
        const auto exact = [&](double r) { return departure(r * r, conic, coefficients); };
        FormPolynomials<double> sums{std::isfinite(exact(1.02 * rim)) ? 1.02 * rim : rim, {}, {}};
        add_to(sums, coefficients, conic);
        constexpr int kSamples = 64;
        for (int i = 1; i <= kSamples; ++i) {
            const double u = static_cast<double>(i) / kSamples, v = u * u, expected = exact(u * sums.reach);
            if (std::isnan(expected)) return true;
            const double fitted = v * v * form_detail::polynomial(sums.even, 2 * v - 1);
            if (!(std::fabs(fitted - expected) <= 1e-10 * rim)) return false;
        }
        return true;
    }
};

}  // namespace REALCAM_NAMESPACE
