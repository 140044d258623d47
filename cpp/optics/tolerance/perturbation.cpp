#include "perturbation.hpp"

#include <cmath>
#include <map>
#include <utility>

#include "../lens/lens_changes.hpp"

namespace realcam {

namespace {

/// One fringe.
constexpr double kHalfWavelength_mm = 0.5e-6 * kFringeLine_nm;

/// Applies an error of the radius of curvature.
void change_curvature(Surface& surface, PerturbationKind kind, double size) {
    const double nominal = surface.curvature, rim = surface.clear_semi_diameter;
    double curvature = nominal;
    if (kind == PerturbationKind::radius)
        curvature = nominal / (1 + size * nominal);
    else if (kind == PerturbationKind::radius_percent)
        curvature = nominal / (1 + 0.01 * size);
    else
        curvature = nominal + 2 * size * kHalfWavelength_mm / (rim * rim);
    surface.curvature = curvature;
    if (surface.form.base != BaseForm::conic) surface.form.curvature_x += curvature - nominal;
}

/// Adds astigmatism: a sag proportional to x^2 - y^2, or to 2 x y. Its extremes lie at the rim, with opposite signs on
/// two perpendicular diameters.
void add_irregularity(Surface& surface, PerturbationKind kind, double fringes) {
    const double rim = surface.clear_semi_diameter, amplitude = 0.5 * fringes * kHalfWavelength_mm / (rim * rim);
    if (kind == PerturbationKind::irregularity_45) {
        surface.form.xy.push_back({1, 1, 2 * amplitude});
        return;
    }
    surface.form.xy.push_back({2, 0, amplitude});
    surface.form.xy.push_back({0, 2, -amplitude});
}

/// Adds to the thickness behind a surface, at all zoom positions.
void add_thickness(LensSystem& lens, int index, double amount) {
    lens.surfaces[static_cast<std::size_t>(index)].thickness += amount;
    for (std::size_t i = 0; i < lens.zoom.surfaces.size(); ++i)
        if (lens.zoom.surfaces[i] == index)
            for (ZoomPosition& position : lens.zoom.positions) position.thicknesses[i] += amount;
}

/// Adds a tilt or decentre to a placement.
void add_to(SurfacePlacement& placement, PerturbationKind kind, double size) {
    switch (kind) {
        case PerturbationKind::surface_tilt_x:
        case PerturbationKind::element_tilt_x: placement.tilt_deg.x += size; break;
        case PerturbationKind::surface_tilt_y:
        case PerturbationKind::element_tilt_y: placement.tilt_deg.y += size; break;
        case PerturbationKind::surface_decentre_x:
        case PerturbationKind::element_decentre_x: placement.decentre.x += size; break;
        default: placement.decentre.y += size;
    }
}

/// True for tilts and decentres of a single surface.
bool moves_surface(PerturbationKind kind) {
    return kind >= PerturbationKind::surface_tilt_x && kind <= PerturbationKind::surface_decentre_y;
}

/// True for tilts and decentres of an element.
bool moves_element(PerturbationKind kind) {
    return kind >= PerturbationKind::element_tilt_x && kind <= PerturbationKind::element_decentre_y;
}

}  // namespace

void move_rigidly(LensSystem& lens, int first, int last, const Affine<double>& motion) {
    if (!move_each_alone(lens, first, last, motion)) move_element(lens, first, last, motion);
}

LensSystem perturbed(const LensSystem& lens, const std::vector<Perturbation>& perturbations,
                     std::span<const double> sizes) {
    LensSystem result = lens;
    std::map<int, std::pair<double, double>> melts;  // surface -> errors of index and Abbe number
    std::map<std::pair<int, int>, SurfacePlacement> surfaces, elements;
    for (std::size_t i = 0; i < perturbations.size(); ++i) {
        const auto [kind, first, last] = perturbations[i];
        check_surface_exists(lens, first);
        check_surface_exists(lens, last);
        const double size = sizes[i];
        if (size == 0) continue;
        Surface& surface = result.surfaces[static_cast<std::size_t>(first)];
        if (moves_surface(kind))
            add_to(surfaces[{first, first}], kind, size);
        else if (moves_element(kind))
            add_to(elements[{first, last}], kind, size);
        else if (kind == PerturbationKind::thickness)
            add_thickness(result, first, size);
        else if (kind == PerturbationKind::index)
            melts[first].first += size;
        else if (kind == PerturbationKind::abbe_percent)
            melts[first].second += 0.01 * size;
        else if (kind == PerturbationKind::irregularity_0 || kind == PerturbationKind::irregularity_45)
            add_irregularity(surface, kind, size);
        else
            change_curvature(surface, kind, size);
    }
    for (const auto& [index, melt] : melts) {
        Glass& glass = result.surfaces[static_cast<std::size_t>(index)].material;
        glass = with_melt_error(glass, melt.first, melt.second);
    }
    for (const auto& [range, placement] : surfaces) move_rigidly(result, range.first, range.second, placement.frame());
    for (const auto& [range, placement] : elements) {
        double length = 0;
        for (int i = range.first; i < range.second; ++i)
            length += result.surfaces[static_cast<std::size_t>(i)].thickness;
        move_rigidly(result, range.first, range.second,
                     along_axis(0.5 * length) * placement.frame() * along_axis(-0.5 * length));
    }
    // Surfaces that touch at their rims do so in every real lens, so that an overlap of a micrometre is not an error.
    result.allow_overlap = true;
    return result;
}

namespace {

/// Returns a Sellmeier glass with this index at the d line and this dispersion n_F - n_C. The new index is
/// n'^2 = constant + scale (n^2 - 1), which preserves the poles of the formula; the constant becomes a term with C = 0.
/// Newton's method finds the scale from the dispersion.
Glass with_sellmeier_error(const Glass& glass, Glass::Parts parts, double index_d, double dispersion) {
    const double square_d = glass.index(kLineD_nm) * glass.index(kLineD_nm);
    const double above = glass.index(kLineF_nm) * glass.index(kLineF_nm) - square_d;
    const double below = glass.index(kLineC_nm) * glass.index(kLineC_nm) - square_d;
    double scale = 1;
    for (int step = 0; step < 20; ++step) {
        const double n_f = std::sqrt(index_d * index_d + scale * above);
        const double n_c = std::sqrt(index_d * index_d + scale * below);
        scale -= (n_f - n_c - dispersion) / (above / (2 * n_f) - below / (2 * n_c));
    }
    for (std::size_t i = 0; i < parts.coefficients.size(); i += 2) parts.coefficients[i] *= scale;
    const double constant = index_d * index_d - 1 - scale * (square_d - 1);
    parts.coefficients.push_back(constant);
    parts.coefficients.push_back(0);
    return Glass::from_parts(std::move(parts));
}

}  // namespace

Glass with_melt_error(const Glass& glass, double index_change, double abbe_fraction) {
    if (index_change == 0 && abbe_fraction == 0) return glass;
    const double nominal_d = glass.index(kLineD_nm), index_d = nominal_d + index_change;
    const double spread = glass.index(kLineF_nm) - glass.index(kLineC_nm);
    if (!(index_d >= 1 && abbe_fraction > -1)) throw InputError("an error of a glass reduces its index below 1");
    if (abbe_fraction != 0 && !(spread > 0))
        throw InputError("the dispersion of glass \"" + glass.label +
                         "\" is not known, and so its Abbe number cannot have an error");
    // V = (n_d - 1) / (n_F - n_C); a glass without dispersion needs no scaling.
    const double scale = spread > 0 ? (index_d - 1) / ((nominal_d - 1) * (1 + abbe_fraction)) : 1;
    Glass::Parts parts = glass.parts();
    if (parts.formula == Glass::Formula::sellmeier)
        return with_sellmeier_error(glass, std::move(parts), index_d, scale * spread);
    for (double& coefficient : parts.coefficients) coefficient *= scale;
    if (parts.formula == Glass::Formula::cauchy) parts.coefficients[0] += index_d - scale * nominal_d;
    for (Glass::TablePoint& point : parts.points) point.index = index_d + scale * (point.index - nominal_d);
    return Glass::from_parts(std::move(parts));
}

}  // namespace realcam
