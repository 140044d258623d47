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
    static constexpr int kMaxDegree =
        4;  ///< largest LensPolynomialView::degree: ninth powers of film and pupil coordinates

    /// Traces rays and fits the polynomials to them. The lens must be rotationally symmetric; `pupil` is its
    /// pupil for film points up to `film_radius` mm from the axis. Throws InputError if too few rays pass.
    LensPolynomial(const LensSystem& lens, const PupilView& pupil, double film_radius);

    LensPolynomialView view() const;
    /// Largest total power of film and pupil coordinates in a polynomial.
    int degree() const { return 2 * degree_ + 1; }
    /// The number of coefficients other than 0.
    int terms() const {
        return static_cast<int>(
            std::count_if(coefficients_.begin(), coefficients_.end(), [](float c) { return c != 0; }));
    }
    /// Error on rays that were not fitted.
    const PolynomialError& error() const { return error_; }

private:
    static constexpr int kVectors = LensPolynomialView::kVectors;

    /// A ray that passes the lens: the arguments of the polynomials, and the values that they have to reproduce.
    struct TracedRay {
        Vec2d film, last;  ///< points of the film and of the plane of the last vertex, mm
        Vec2d vectors[kVectors];  ///< position, direction and point in the stop, as in LensPolynomialRay
    };

    /// Returns the monomials u^i v^j w^k of u = x.x, v = p.p and w = x.p with i + j + k <= degree, in the order of
    /// LensPolynomialView::coefficients; x is the film point times `film_scale`, p the point in the plane of the last
    /// vertex times `last_scale`.
    static std::vector<double> monomials(const TracedRay& ray, int degree, double film_scale, double last_scale);
    /// Number of these monomials.
    static int monomial_count(int degree) { return (degree + 1) * (degree + 2) * (degree + 3) / 6; }

    /// Ray of the polynomials for the arguments of a traced ray.
    static LensPolynomialRay<float> evaluate_at(const LensPolynomialView& view, const TracedRay& ray);

    /// Traces `count` random rays of the random sequence `stream`; returns those that pass.
    std::vector<TracedRay> traced_rays(const LensSystem& lens, const PupilView& pupil, std::uint32_t stream,
                                       std::uint32_t count) const;

    /// Fits `rays` with each degree, and sets the degree, the coefficients, and their error on `others`.
    void choose_degree(const std::vector<TracedRay>& rays, const std::vector<TracedRay>& others);

    /// Returns the coefficients that fit the rays best, by least squares.
    std::vector<float> fit(const std::vector<TracedRay>& rays, int degree) const;

    /// Returns the error of the direction on these rays.
    PolynomialError error_of(const std::vector<float>& coefficients, int degree,
                             const std::vector<TracedRay>& rays) const;

    /// Sets each coefficient in turn to 0 if the error on other rays then grows by at most 1%.
    void drop_negligible_terms(const std::vector<TracedRay>& others);

    /// Returns the RMS error of the ray's position and of its point in the stop, each in units of its rim's radius.
    double stop_rms(const std::vector<float>& coefficients, const std::vector<TracedRay>& rays) const;

    double plane_;  ///< z of the plane of the positions, mm from the front vertex
    double focal_length_, film_radius_, last_radius_, front_radius_;  ///< mm; the radii are those of film and rims
    double last_rim_, front_rim_;  ///< sags at the rims, mm
    int degree_ = 0;  ///< LensPolynomialView::degree
    std::vector<float> coefficients_;
    PolynomialError error_;
};

}  // namespace REALCAM_NAMESPACE
