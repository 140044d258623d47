#pragma once
#include <array>
#include <numbers>
#include <vector>

#include "object_point.hpp"

namespace REALCAM_NAMESPACE {

// Third-order aberrations by surface, after W. T. Welford, Aberrations of Optical Systems (1986), chapters 8 and 10.
// With A = n i the refraction invariants of the marginal ray and A' of the chief ray, y and y' their heights, H the
// Lagrange invariant, and D(q) the change of q at the surface:
//   S_I = -A^2 y D(u/n), S_II = -A A' y D(u/n), S_III = -A'^2 y D(u/n), S_IV = -H^2 c D(1/n), S_V = A'/A (S_III +
//   S_IV), C_I = A y D(dn/n), C_II = A' y D(dn/n),
// and of the figure, whose departure from the sphere is g r^4 with g = a4 + k c^3 / 8:
//   S_I = 8 g D(n) y^4, S_II = S_I (y'/y), S_III = S_I (y'/y)^2, S_V = S_I (y'/y)^3.
// Behind a mirror n is negative. W is positive where the wavefront is ahead of the reference sphere, as in
// wavefront.hpp.

/// What one surface adds. Lengths in mm.
struct SeidelRow {
    ParaxialRay marginal, chief;  ///< at the surface; slopes behind it
    double marginal_invariant, chief_invariant;  ///< n i, i the angle of incidence
    std::array<double, 5> sums;                  ///< S_I to S_V
    std::array<double, 2> colour;                ///< C_I, C_II between the two wavelengths of colour
    double petzval_curvature;  ///< share of the Petzval surface's curvature in the image space, 1/mm
};

/// Transverse aberrations at the edge of the field for the edge of the pupil, mm, along y: of a real ray to
/// third order, less the paraxial image. The names and signs are CODE V's.
struct TransverseAberrations {
    double spherical;  ///< SA
    double tangential_coma;  ///< TCO
    double tangential_astigmatism;  ///< TAS: tangential field curvature, blur
    double sagittal_astigmatism;  ///< SAS
    double petzval;  ///< PTB
    double distortion;  ///< DST
    double axial_colour;  ///< AX: short less long wavelength
    double lateral_colour;  ///< LAT
};

/// Coefficients of W = W040 r^4 + W131 h r^3 cos + W222 h^2 r^2 cos^2 + W220 h^2 r^2 + W311 h^3 r cos, r and h being
/// shares of the pupil's radius and of the field; and of colour, W020 r^2 + W111 h r cos. In waves.
struct WaveCoefficients {
    double w040, w131, w222, w220, w311;
    double w020_colour, w111_colour;
};

struct SeidelTable {
    std::vector<SeidelRow> surfaces;
    double image_invariant_slope;  ///< n' u' of the marginal ray behind the lens
    double lagrange_invariant;  ///< H = n (u' y - u y'), u' and y' of the chief ray, mm
    double wavelength_nm;

    TransverseAberrations transverse(const SeidelRow& row) const {
        const auto& s = row.sums;
        const double scale = 1 / (2 * image_invariant_slope);
        return {scale * s[0], 3 * scale * s[1], scale * (3 * s[2] + s[3]), scale * (s[2] + s[3]),
                scale * s[3], scale * s[4],     2 * scale * row.colour[0], 2 * scale * row.colour[1]};
    }
    WaveCoefficients waves(const SeidelRow& row) const {
        const auto& s = row.sums;
        const double scale = 1e6 / wavelength_nm;
        return {scale * s[0] / 8, scale * s[1] / 2,          scale * s[2] / 2,     scale * (s[2] + s[3]) / 4,
                scale * s[4] / 2, scale * row.colour[0] / 2, scale * row.colour[1]};
    }
};

namespace seidel_detail {

/// Marginal and chief ray at the front vertex.
struct ParaxialPair {
    ParaxialRay marginal, chief;
};

inline ParaxialPair entering_rays(const LensSystem& lens, double wavelength_nm, const FieldPoint& field) {
    const FirstOrder data = first_order(lens, wavelength_nm);
    const double pupil = data.entrance_pupil_position, radius = 0.5 * data.entrance_pupil_diameter;
    if (!(std::fabs(field.angle_rad) < 0.5 * std::numbers::pi))
        throw InputError("third-order sums need a field angle of less than 90 deg; it is " +
                         object_point_detail::degrees(field.angle_rad));
    const ObjectPoint object(lens, wavelength_nm, {0, field.object_distance});
    const double tangent = std::tan(field.angle_rad);
    const double slope = radius * object.inverse_distance;
    return {{radius - slope * pupil, slope}, {-pupil * tangent, tangent}};
}

inline SeidelRow row_of(const Surface& surface, double before, double after, ParaxialRay marginal, ParaxialRay chief,
                        double invariant, double index_ratio_change) {
    const double c = surface.curvature, y = marginal.height, y_chief = chief.height;
    SeidelRow row{};
    row.marginal = refract_paraxial(marginal, c, before, after);
    row.chief = refract_paraxial(chief, c, before, after);
    const double a = before * (marginal.slope + y * c), b = before * (chief.slope + y_chief * c);
    const double change = row.marginal.slope / after - marginal.slope / before;
    const double inverse = 1 / after - 1 / before;
    const double figure = 0.125 * surface.conic * c * c * c + (surface.aspheric.empty() ? 0.0 : surface.aspheric[0]);
    const double sag = 8 * figure * (after - before) * y;
    row.marginal_invariant = a;
    row.chief_invariant = b;
    row.sums[0] = -a * a * y * change + sag * y * y * y;
    row.sums[1] = -a * b * y * change + sag * y * y * y_chief;
    row.sums[2] = -b * b * y * change + sag * y * y_chief * y_chief;
    row.sums[3] = -invariant * invariant * c * inverse;
    // b/a (S_III + S_IV) without the quotient, which has no value where the marginal ray meets the surface along its
    // normal: D(u/n) = a D(1/n^2) - y c D(1/n), and b y = H + a y'.
    row.sums[4] = -b * b * b * y * (1 / after - 1 / before) * (1 / after + 1 / before) +
                  b * y_chief * c * inverse * (b * y + invariant) + sag * y_chief * y_chief * y_chief;
    row.colour = {a * y * index_ratio_change, b * y * index_ratio_change};
    row.petzval_curvature = c * inverse;
    return row;
}

}  // namespace seidel_detail

/// Third-order sums surface by surface, for the edge of the field and of the stop's opening; colour between two
/// wavelengths, short and long. Throws InputError for what is no place in the field, and for an afocal lens, whose
/// transverse aberrations are infinite.
inline SeidelTable seidel(const LensSystem& lens, double wavelength_nm, const FieldPoint& field, double short_nm,
                          double long_nm) {
    using namespace seidel_detail;
    const ParaxialPair start = entering_rays(lens, wavelength_nm, field);
    const std::vector<double> n = lens.indices(wavelength_nm);
    const std::vector<double> n_short = lens.indices(short_nm), n_long = lens.indices(long_nm);
    SeidelTable table{};
    table.wavelength_nm = wavelength_nm;
    table.lagrange_invariant =
        n[0] * (start.chief.slope * start.marginal.height - start.marginal.slope * start.chief.height);
    ParaxialRay marginal = start.marginal, chief = start.chief;
    double sign = 1, steepest = 0;
    for (std::size_t i = 0; i < lens.surfaces.size(); ++i) {
        const Surface& surface = lens.surfaces[i];
        const double before = sign * n[i];
        if (surface.type == SurfaceType::mirror) sign = -sign;
        const double after = sign * n[i + 1];
        const double dispersion = (n_short[i + 1] - n_long[i + 1]) / n[i + 1] - (n_short[i] - n_long[i]) / n[i];
        table.surfaces.push_back(row_of(surface, before, after, marginal, chief, table.lagrange_invariant, dispersion));
        marginal = table.surfaces.back().marginal;
        chief = table.surfaces.back().chief;
        steepest = std::max(steepest, std::fabs(marginal.slope));
        table.image_invariant_slope = after * marginal.slope;
        marginal.height += surface.thickness * marginal.slope;
        chief.height += surface.thickness * chief.slope;
    }
    // What rounding leaves of a slope that is zero.
    if (!(std::fabs(marginal.slope) > 1e-12 * steepest))
        throw InputError("lens \"" + lens.name +
                         "\" is afocal for this object: its image lies at infinity, and transverse aberrations do too");
    for (SeidelRow& row : table.surfaces) row.petzval_curvature *= sign * n.back();
    return table;
}

}  // namespace REALCAM_NAMESPACE
