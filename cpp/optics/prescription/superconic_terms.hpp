#pragma once
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "form_row.hpp"

namespace REALCAM_NAMESPACE {

/// A. W. Greynolds, "Superconic and subconic surfaces in optical design", Proc. SPIE 4832, 1 (2002). With
/// s^2 = r^2 + z^2 and w = (s / radius)^2 the surface is where
///     s^2 (1 + U_1 w + U_2 w^2 + ...) + k z^2 + radius z (V_1 w + V_2 w^2 + ...) = 2 z / c.
/// A conic if all coefficients are 0; a Cartesian oval has U_1 and V_1.
struct SuperconicTerms {
    double radius = 1;  ///< unit of s, mm
    std::vector<double> coefficients;  ///< U_1, V_1, U_2, V_2, ...

    static constexpr FormWords words = {.key = "superconic",
                                        .name = "superconic",
                                        .first_number = 1,
                                        .coefficients_key = "coefficients",
                                        .are_lengths = false};

    bool operator==(const SuperconicTerms&) const = default;

    int most() const { return 20; }
    template <class Surface>
    std::string error(const Surface& surface) const {
        if (!surface.form.has_conic_base()) return "superconic terms depart from a conic of revolution";
        if (surface.form.forbes) return "has both superconic and Forbes terms, which are traced by one polynomial";
        return is_followed({surface.curvature, surface.conic}, surface.clear_semi_diameter)
                   ? ""
                   : "its superconic terms bend it more than the polynomial in r^" +
                         std::to_string(2 * kMaxForbesTerms + 2) + " follows by which they are traced";
    }
    void negate() {
        for (std::size_t i = 1; i < coefficients.size(); i += 2) coefficients[i] = -coefficients[i];
    }
    void add_sag(double& z, double x, double y, const ConicNumbers<double>& conic) const {
        z += departure(x * x + y * y, conic, coefficients);
    }
    double vertex_curvature() const { return 0; }
    /// Interpolates the departure from the conic, over w^2, at Chebyshev nodes.
    template <class T>
    void add_to(FormPolynomials<T>& polynomials, const std::vector<T>& numbers, const ConicNumbers<T>& conic) const {
        constexpr int n = kMaxForbesTerms;
        constexpr double kStep = std::numbers::pi / (2 * n);
        const double squared = polynomials.reach * polynomials.reach;
        polynomials.even.assign(n, T(0.0));
        polynomials.even_radius = polynomials.reach;
        polynomials.is_bfs = false;
        for (int i = 0; i < n; ++i) {
            const double w = 0.5 + 0.5 * std::cos((2 * i + 1) * kStep);
            const T value = departure(w * squared, conic, numbers) / T(w * w);
            // Chebyshev polynomials of degree m - 1 and m in powers of 2 w - 1.
            std::vector<double> before = {0}, now = {1};
            for (int m = 0; m < n; ++m) {
                const double weight = (m == 0 ? 1.0 : 2.0) / n * std::cos(m * (2 * i + 1) * kStep);
                for (std::size_t k = 0; k < now.size(); ++k) polynomials.even[k] += value * (weight * now[k]);
                std::vector<double> next(now.size() + 1, 0.0);
                for (std::size_t k = 0; k < now.size(); ++k) next[k + 1] = (m == 0 ? 1 : 2) * now[k];
                if (m > 0)
                    for (std::size_t k = 0; k < before.size(); ++k) next[k] -= before[k];
                before = now;
                now = next;
            }
        }
    }
    const char* beyond_polynomials() const { return "superconic terms"; }

private:
    /// A sum of terms of w, and its derivative.
    template <class T>
    struct Sum {
        T value, slope;
    };

    /// Sum of numbers[first] w + numbers[first + 2] w^2 + ...
    template <class T>
    static Sum<T> sum_of(const std::vector<T>& numbers, std::size_t first, const T& w) {
        Sum<T> sum{T(0.0), T(0.0)};
        if (numbers.size() <= first) return sum;
        for (std::size_t i = first + (numbers.size() - 1 - first) / 2 * 2 + 2; i > first;) {
            i -= 2;
            sum.slope = sum.slope * w + sum.value + numbers[i];
            sum.value = (sum.value + numbers[i]) * w;
        }
        return sum;
    }

    /// Sag beyond that of the conic; NaN if the surface does not reach the squared distance `r2` from the axis. With
    /// z = z_0 + d, where z_0 is the conic's sag, the conic's own terms cancel:
    ///     c ((1 + k) (z_0 + z) d + s^2 U + radius z V) = 2 d,
    /// which gives d without loss of digits near the vertex.
    template <class T>
    T departure(double r2, const ConicNumbers<T>& conic, const std::vector<T>& numbers) const {
        using std::sqrt;
        constexpr double kRounding = 16 * std::numeric_limits<double>::epsilon();
        constexpr int kMaxSteps = 50;
        // Both sides' difference for a departure d, in the number type of the other arguments.
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
            const T wide_c = conic.curvature, wide_k = conic.conic;
            const T wide_z_0 = wide_c * r2 / (1 + sqrt(1 - (1 + wide_k) * wide_c * wide_c * r2));
            return T(d) - difference(wide_c, wide_k, numbers, wide_z_0, d) / T(slope);
        }
        return T(std::numeric_limits<double>::quiet_NaN());
    }

    /// True if the polynomial of add_to is as the surface up to the rim, to 1e-10 of the rim's radius. Also if the
    /// surface ends before, which another check reports.
    bool is_followed(const ConicNumbers<double>& conic, double rim) const {
        const auto exact = [&](double r) { return departure(r * r, conic, coefficients); };
        FormPolynomials<double> sums{std::isfinite(exact(1.02 * rim)) ? 1.02 * rim : rim, {}, {}};
        add_to(sums, coefficients, conic);
        constexpr int kSamples = 64;
        for (int i = 1; i <= kSamples; ++i) {
            const double u = static_cast<double>(i) / kSamples, w = u * u, departs = exact(u * sums.reach);
            if (std::isnan(departs)) return true;
            const double followed = w * w * form_detail::polynomial(sums.even, 2 * w - 1);
            if (!(std::fabs(followed - departs) <= 1e-10 * rim)) return false;
        }
        return true;
    }
};

}  // namespace REALCAM_NAMESPACE
