#pragma once
#include <vector>

#include "../prescription/lens_system.hpp"
#include "../pupil/pupil_view.hpp"
#include "../trace/lens_polynomial_view.hpp"

namespace REALCAM_NAMESPACE {

/// How well polynomials do for a lens: on rays that they were not fitted to. Directions are compared, as the places of
/// their rays on a film at the focal length, mm.
struct PolynomialError {
    double rms = 0, worst = 0;
    double worst_film_radius = 0;  ///< of the film point of the worst ray, mm
};

/// Polynomials fitted to the traced rays of a lens in its state. Owns the memory of its view.
class LensPolynomial {
public:
    static constexpr int kHighestDegree = 4;  ///< of the products, which makes up to ninth powers of film and pupil

    /// `pupil`: of the lens, for film points up to `film_radius` mm. Throws InputError where no light passes.
    LensPolynomial(const LensSystem& lens, const PupilView& pupil, double film_radius);

    LensPolynomialView view() const;
    /// The highest sum of the powers of film and pupil coordinates.
    int degree() const { return 2 * degree_ + 1; }
    /// Coefficients that are not 0.
    int terms() const {
        return static_cast<int>(std::count_if(floats_.begin(), floats_.end(), [](float c) { return c != 0; }));
    }
    const PolynomialError& error() const { return error_; }

private:
    static constexpr int kVectors = LensPolynomialView::kVectors;

    struct TracedRay {
        Vec2d film, last;             ///< mm
        Vec2d vectors[kVectors];      ///< as those of LensPolynomialRay
    };

    /// x^2, p^2 and x p to all powers up to a sum of theirs, in the view's order.
    static std::vector<double> powers(const TracedRay& ray, int degree, double film_scale, double last_scale);
    static int products(int degree) { return (degree + 1) * (degree + 2) * (degree + 3) / 6; }

    std::vector<TracedRay> traced_rays(const LensSystem& lens, const PupilView& pupil, std::uint32_t stream,
                                       std::uint32_t count) const;

    void choose_degree(const std::vector<TracedRay>& rays, const std::vector<TracedRay>& others);

    std::vector<float> fit(const std::vector<TracedRay>& rays, int degree) const;

    PolynomialError error_of(const std::vector<float>& coefficients, int degree,
                             const std::vector<TracedRay>& rays) const;

    /// Takes out one coefficient after the other without which the error on other rays stays as it is, to 1%.
    void drop_idle_terms(const std::vector<TracedRay>& others);

    /// Root mean square error of the position and the place in the stop, each as a share of its rim.
    double stop_rms(const std::vector<float>& coefficients, const std::vector<TracedRay>& rays) const;

    double plane_, focal_length_, film_radius_, last_radius_, front_radius_, last_rim_, front_rim_;
    int degree_ = 0;
    std::vector<float> floats_;
    PolynomialError error_;
};

}  // namespace REALCAM_NAMESPACE
