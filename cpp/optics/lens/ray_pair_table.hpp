#pragma once
#include <string>
#include <vector>

#include "../prescription/lens_system.hpp"
#include "../trace/lens_polynomial_view.hpp"

namespace REALCAM_NAMESPACE {

/// Polynomials fitted to rays before and behind a lens whose surfaces are unknown, at one wavelength, focus and
/// f-number. Second source of a LensPolynomialView, beside LensPolynomial.
///
/// The lens is in air and rotationally symmetric. Its frame is that of a prescription: the front vertex is the point of
/// the axis at z = 0, and the last vertex that at z = `length`; any planes between the glass and the entrance pupil,
/// and between the exit pupil and the film, serve. Lengths in mm.
struct RayPairTable {
    std::string name;
    double wavelength_nm = 0;
    double length = 0;  ///< front vertex to last vertex
    double film_distance = 0;  ///< last vertex to film
    double focus_distance = kInfinity;  ///< object plane in focus to film
    double film_width = 0, film_height = 0;
    double film_radius = 0;  ///< radius of the part of the film with light, from the axis; scale of film points
    double last_radius = 0;  ///< radius of the measured disc in the plane of the last vertex; scale of its points
    double plane = 0;  ///< z of the plane of the positions, if there are no heights
    int degree = 0;
    // Arrays of LensPolynomialView.
    std::vector<float> coefficients, heights, discs;

    static constexpr int kMaxDegree = 8, kMaxDiscs = 16;

    int disc_count() const { return static_cast<int>(discs.size()) / (2 * LensPolynomialView::kDiscTerms); }
    LensPolynomialView view() const;

    /// Angle between the axis and the ray from a film point, at a distance in mm from the axis, through the middle
    /// of its light in the meridional plane, in front of the lens, rad. Beyond `film_radius`: that of the last film
    /// point with light.
    double field_angle(double film_height) const;

    bool operator==(const RayPairTable&) const = default;
};

/// Throws InputError if a number is out of range, the arrays do not have the sizes stated, or the rays near the axis
/// are not those of a lens (paraxial_lens).
void validate(const RayPairTable& table);

/// Returns the lens of three thin elements, with the stop between the first and the second, that images as the rays of
/// the table do to first order: it has their paraxial matrix, both pupils, the film and the plane in focus. It stands
/// for the prescription wherever first-order data are needed, and does not have its aberrations. Throws InputError if
/// there is none: the chief ray must cross the axis between the vertices.
LensSystem paraxial_lens(const RayPairTable& table);

}  // namespace REALCAM_NAMESPACE
