#pragma once
#include <vector>

#include "../prescription/lens_system.hpp"
#include "../pupil/pupil_view.hpp"
#include "../trace/lens_polynomial_view.hpp"

namespace REALCAM_NAMESPACE {

/// Error of a lens's polynomials on rays that they were not fitted to: the direction error, expressed as a displacement
/// on a film at the focal length, mm.
struct PolynomialError {
    double rms = 0, worst = 0;
    double worst_film_radius = 0;  ///< distance of the worst ray's film point from the axis, mm
};

/// Polynomials fitted to traced rays of a lens in its current state. Owns the memory of its view.
class LensPolynomial {
public:
    static constexpr int kHighestDegree = 4;  ///< degree of the products (powers): up to ninth powers of film and pupil

    /// `pupil`: the lens's pupil for film points up to `film_radius` mm. Throws InputError if too few rays pass.
    LensPolynomial(const LensSystem& lens, const PupilView& pupil, double film_radius);

    LensPolynomialView view() const;
    /// Highest total power of film and pupil coordinates.
    int degree() const { return 2 * degree_ + 1; }
    /// The number of coefficients other than 0.
    int terms() const {
        return static_cast<int>(std::count_if(floats_.begin(), floats_.end(), [](float c) { return c != 0; }));
    }
    const PolynomialError& error() const { return error_; }

private:
    static constexpr int kVectors = LensPolynomialView::kVectors;

    struct TracedRay {
        Vec2d film, last;  ///< mm
        Vec2d vectors[kVectors];  ///< see LensPolynomialRay
    };

    /// Products u^i v^j w^k of u = x^2, v = p^2 and w = x p with i + j + k <= degree, in the view's order; x is the
    /// film point, p the point on the last vertex plane, both scaled.
    static std::vector<double> powers(const TracedRay& ray, int degree, double film_scale, double last_scale);
    static int products(int degree) { return (degree + 1) * (degree + 2) * (degree + 3) / 6; }

    std::vector<TracedRay> traced_rays(const LensSystem& lens, const PupilView& pupil, std::uint32_t stream,
                                       std::uint32_t count) const;

    void choose_degree(const std::vector<TracedRay>& rays, const std::vector<TracedRay>& others);

    std::vector<float> fit(const std::vector<TracedRay>& rays, int degree) const;

    PolynomialError error_of(const std::vector<float>& coefficients, int degree,
                             const std::vector<TracedRay>& rays) const;

    /// Removes each coefficient in turn if the error on other rays then grows by at most 1%.
    void drop_idle_terms(const std::vector<TracedRay>& others);

    /// RMS error of the ray's position and of its point on the stop, each in units of its rim's radius.
    double stop_rms(const std::vector<float>& coefficients, const std::vector<TracedRay>& rays) const;

    double plane_, focal_length_, film_radius_, last_radius_, front_radius_, last_rim_, front_rim_;
    int degree_ = 0;
    std::vector<float> floats_;
    PolynomialError error_;
};

}  // namespace REALCAM_NAMESPACE
