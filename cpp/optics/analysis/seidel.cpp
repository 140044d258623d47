#include "seidel.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace realcam {

TransverseAberrations SeidelTable::transverse(const SeidelRow& row) const {
    const auto& s = row.sums;
    const double scale = 1 / (2 * image_invariant_slope);
    return {scale * s[0], 3 * scale * s[1], scale * (3 * s[2] + s[3]), scale * (s[2] + s[3]),
            scale * s[3], scale * s[4],     2 * scale * row.colour[0], 2 * scale * row.colour[1]};
}

WaveCoefficients SeidelTable::waves(const SeidelRow& row) const {
    const auto& s = row.sums;
    const double scale = 1e6 / wavelength_nm;
    return {scale * s[0] / 8, scale * s[1] / 2,          scale * s[2] / 2,     scale * (s[2] + s[3]) / 4,
            scale * s[4] / 2, scale * row.colour[0] / 2, scale * row.colour[1]};
}

namespace {

/// Marginal and chief ray at the front vertex.
struct ParaxialPair {
    ParaxialRay marginal, chief;
};

/// Returns the marginal and the chief ray of a field point. Throws InputError for what seidel() refuses.
ParaxialPair entering_rays(const LensSystem& lens, double wavelength_nm, const FieldPoint& field) {
    for (std::size_t i = 0; i < lens.surfaces.size(); ++i)
        if (!lens.surfaces[i].form.adds_nothing())
            throw InputError("third-order sums require conics and even aspheres; surface " + std::to_string(i + 1) +
                             " has other terms");
    const FirstOrder data = first_order(lens, wavelength_nm);
    const double pupil = data.entrance_pupil_position, radius = 0.5 * data.entrance_pupil_diameter;
    if (!(std::fabs(field.angle_rad) < 0.5 * std::numbers::pi))
        throw InputError("third-order sums require a field angle of less than 90 deg; found " +
                         object_point_detail::degrees(field.angle_rad));
    const ObjectPoint object(lens, wavelength_nm, {0, field.object_distance});
    const double tangent = std::tan(field.angle_rad);
    const double slope = radius * object.inverse_distance;
    return {{radius - slope * pupil, slope}, {-pupil * tangent, tangent}};
}

/// Computes the contribution of a surface. `before`, `after`: signed refractive indices; `marginal`, `chief`: the rays
/// in front of it; `invariant`: H; `index_ratio_change`: D(dn/n).
SeidelRow surface_row(const Surface& surface, double before, double after, ParaxialRay marginal, ParaxialRay chief,
                      double invariant, double index_ratio_change) {
    const double c = surface.curvature, y = marginal.height, y_chief = chief.height;
    SeidelRow row{};
    row.marginal = refract_paraxial(marginal, c, before, after);
    row.chief = refract_paraxial(chief, c, before, after);
    const double a = before * (marginal.slope + y * c), b = before * (chief.slope + y_chief * c);
    const double slope_change = row.marginal.slope / after - marginal.slope / before;
    const double inverse_index_change = 1 / after - 1 / before;
    const double aspheric_coefficient =
        0.125 * surface.conic * c * c * c + (surface.aspheric.empty() ? 0.0 : surface.aspheric[0]);
    const double aspheric_term = 8 * aspheric_coefficient * (after - before) * y;
    row.marginal_invariant = a;
    row.chief_invariant = b;
    row.sums[0] = -a * a * y * slope_change + aspheric_term * y * y * y;
    row.sums[1] = -a * b * y * slope_change + aspheric_term * y * y * y_chief;
    row.sums[2] = -b * b * y * slope_change + aspheric_term * y * y_chief * y_chief;
    row.sums[3] = -invariant * invariant * c * inverse_index_change;
    // b/a (S_III + S_IV) without the quotient, which is undefined if the marginal ray hits the surface along its
    // normal: D(u/n) = a D(1/n^2) - y c D(1/n), and b y = H + a y'.
    row.sums[4] = -b * b * b * y * (1 / after - 1 / before) * (1 / after + 1 / before) +
                  b * y_chief * c * inverse_index_change * (b * y + invariant) +
                  aspheric_term * y_chief * y_chief * y_chief;
    row.colour = {a * y * index_ratio_change, b * y * index_ratio_change};
    row.petzval_curvature = c * inverse_index_change;
    return row;
}

}  // namespace

SeidelTable seidel(const LensSystem& lens, double wavelength_nm, const FieldPoint& field, double short_nm,
                   double long_nm) {
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
        table.surfaces.push_back(
            surface_row(surface, before, after, marginal, chief, table.lagrange_invariant, dispersion));
        marginal = table.surfaces.back().marginal;
        chief = table.surfaces.back().chief;
        steepest = std::max(steepest, std::fabs(marginal.slope));
        table.image_invariant_slope = after * marginal.slope;
        marginal.height += surface.thickness * marginal.slope;
        chief.height += surface.thickness * chief.slope;
    }
    // A slope that is smaller than this is a rounding error of 0.
    if (!(std::fabs(marginal.slope) > 1e-12 * steepest))
        throw InputError(
            "lens \"" + lens.name +
            "\" is afocal for this object: its image lies at infinity, and its transverse aberrations are infinite");
    for (SeidelRow& row : table.surfaces) row.petzval_curvature *= sign * n.back();
    return table;
}

}  // namespace realcam
