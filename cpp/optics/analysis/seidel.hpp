#pragma once
#include <array>
#include <vector>

#include "../lens/paraxial.hpp"
#include "object_point.hpp"

namespace REALCAM_NAMESPACE {

// Third-order (Seidel) aberrations by surface, after W. T. Welford, Aberrations of Optical Systems (1986), chapters 8
// and
// 10. A = n i and A' are the refraction invariants of the marginal ray and of the chief ray, y and y' their heights, u
// the slope of the marginal ray, c the curvature of the surface, H the Lagrange invariant, dn the difference of n
// between the short and the long wavelength, and D(q) the change of q at the surface:
//   S_I = -A^2 y D(u/n), S_II = -A A' y D(u/n), S_III = -A'^2 y D(u/n), S_IV = -H^2 c D(1/n),
//   S_V = A'/A (S_III + S_IV), C_I = A y D(dn/n), C_II = A' y D(dn/n),
// An aspheric surface, which departs from the sphere by g r^4 with g = a4 + k c^3 / 8, adds:
//   S_I = 8 g D(n) y^4, S_II = S_I (y'/y), S_III = S_I (y'/y)^2, S_V = S_I (y'/y)^3.
// Behind a mirror n is negative. The wavefront aberration W is positive where the wavefront is ahead of the reference
// sphere, as in wavefront.hpp.

/// Contribution of one surface to the third-order sums. Lengths in mm.
struct SeidelRow {
    ParaxialRay marginal, chief;  ///< heights at the surface, and slopes behind it
    double marginal_invariant, chief_invariant;  ///< A and A': n times the angle of incidence
    std::array<double, 5> sums;  ///< S_I to S_V
    std::array<double, 2> colour;  ///< C_I and C_II, the chromatic sums between the short and the long wavelength
    double petzval_curvature;  ///< contribution to the Petzval curvature in image space, 1/mm
};

/// Transverse aberrations along y at the edge of the field for the edge of the pupil, mm: the height of a real ray to
/// third order minus that of the paraxial image. The names and signs are those of CODE V.
struct TransverseAberrations {
    double spherical;  ///< SA
    double tangential_coma;  ///< TCO
    double tangential_astigmatism;  ///< TAS: tangential field curvature, blur
    double sagittal_astigmatism;  ///< SAS
    double petzval;  ///< PTB
    double distortion;  ///< DST
    double axial_colour;  ///< AX: short minus long wavelength
    double lateral_colour;  ///< LAT: short minus long wavelength
};

/// Coefficients, in waves, of the wavefront aberration W = W040 r^4 + W131 h r^3 cos + W222 h^2 r^2 cos^2 + W220 h^2
/// r^2
/// + W311 h^3 r cos, and of its change between two wavelengths, W020 r^2 + W111 h r cos. r is the distance from the
/// centre of the pupil, relative to its radius, and h the field, relative to its edge.
struct WaveCoefficients {
    double w040, w131, w222, w220, w311;
    double w020_colour, w111_colour;
};

/// Third-order sums of all surfaces. The member functions convert a row, or the sum of rows.
struct SeidelTable {
    std::vector<SeidelRow> surfaces;
    double image_invariant_slope;  ///< n' u' of the marginal ray behind the lens
    double lagrange_invariant;  ///< H = n (u' y - u y'), u' and y' of the chief ray, mm
    double wavelength_nm;

    /// Returns the transverse aberrations due to a row.
    TransverseAberrations transverse(const SeidelRow& row) const;
    /// Returns the wavefront aberration due to a row.
    WaveCoefficients waves(const SeidelRow& row) const;
};

/// Computes the third-order sums for a field point at the edge of the field, with the stop at its opening. Chromatic
/// sums are between the wavelengths `short_nm` and `long_nm`. Throws InputError if the field point is invalid, if a
/// surface is neither a conic nor an even asphere, or if the lens is afocal for this object, so that its transverse
/// aberrations are infinite.
SeidelTable seidel(const LensSystem& lens, double wavelength_nm, const FieldPoint& field, double short_nm,
                   double long_nm);

}  // namespace REALCAM_NAMESPACE
