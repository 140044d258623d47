#include "lens_configurations.hpp"

#include <algorithm>
#include <cmath>

#include "../../optics/lens/paraxial.hpp"
#include "../../optics/prescription/lens_limits.hpp"
#include "../text/printable.hpp"

namespace realcam::io {
namespace {

/// Throws LensFileError, at the line and surface of a row if there is one.
[[noreturn]] void fail(const Prescription& p, const std::string& message, const PrescriptionSurface* row = nullptr) {
    throw LensFileError(message, p.file, row ? row->line : 0, row ? row->number : 0);
}

/// Thickness of a row in a zoom position, mm. Row -1: the object distance.
double thickness(const Prescription& p, int row, std::size_t position) {
    const auto zoomed = p.zoom_thicknesses.find(row);
    if (zoomed != p.zoom_thicknesses.end()) return zoomed->second[position];
    return row < 0 ? p.object_distance : p.surfaces[static_cast<std::size_t>(row)].thickness;
}

/// Sets the radius of the stop from the file's aperture by first-order optics, as lens-design programs do. `object`:
/// object distance, mm. Throws LensFileError if it cannot be determined.
void set_stop(const Prescription& p, const std::vector<SurfaceRow>& surface_rows, LensSystem& lens, double object,
              std::size_t position) {
    const int stop = lens.stop_index(), count = static_cast<int>(lens.surfaces.size());
    Surface& surface = lens.surfaces[static_cast<std::size_t>(stop)];
    const double aperture = p.zoom_apertures.empty() ? p.aperture : p.zoom_apertures[position];
    const auto trace = [&](ParaxialRay ray, int last) {
        return trace_paraxial(lens, lens.wavelength_nm, ray, 0, last);
    };
    // A marginal ray from the axial object point, of arbitrary size.
    const ParaxialRay start = std::isinf(object) ? ParaxialRay{1, 0} : ParaxialRay{object, 1};
    const double marginal_height_at_stop = std::fabs(trace(start, stop + 1).height);
    // Ray height at the stop over that in the entrance pupil.
    const double stop_per_pupil_height = std::fabs(trace({1, 0}, stop + 1).height);
    const double image_index = lens.indices(lens.wavelength_nm).back();
    const auto marginal_slope = [&](double numerical) {
        if (!(numerical > 0 && numerical < 1)) fail(p, "the numerical aperture must lie between 0 and 1");
        return std::tan(std::asin(numerical));
    };
    double radius = 0;
    switch (p.aperture_kind) {
        case ApertureKind::stop_size: radius = aperture > 0 ? aperture : surface.clear_semi_diameter; break;
        case ApertureKind::entrance_pupil_diameter: radius = 0.5 * aperture * stop_per_pupil_height; break;
        case ApertureKind::f_number:
            radius = 0.5 / (aperture * image_index * std::fabs(trace({1, 0}, count).slope)) * stop_per_pupil_height;
            break;
        case ApertureKind::working_f_number:
            radius = 0.5 / (aperture * image_index * std::fabs(trace(start, count).slope)) * marginal_height_at_stop;
            break;
        case ApertureKind::image_aperture:
            radius =
                marginal_slope(aperture / image_index) / std::fabs(trace(start, count).slope) * marginal_height_at_stop;
            break;
        case ApertureKind::object_aperture:
            if (std::isinf(object))
                fail(p, "a numerical aperture in object space needs an object at a finite distance");
            radius = marginal_slope(aperture) * marginal_height_at_stop;
            break;
    }
    if (!(radius > 0) || !std::isfinite(radius))
        fail(p,
             "the file does not specify the size of the aperture stop; expected "
             "an entrance pupil diameter, an f-number or the stop's semi-diameter",
             &p.surfaces[surface_rows[static_cast<std::size_t>(stop)].row]);
    // The stop's own aperture limits it if it is smaller.
    const SurfaceRow& stop_row = surface_rows[static_cast<std::size_t>(stop)];
    const PrescriptionSurface& row = p.surfaces[stop_row.row];
    const bool is_plane = static_cast<std::size_t>(stop) + 1 >= surface_rows.size() ||
                          surface_rows[static_cast<std::size_t>(stop) + 1].row != stop_row.row;
    if (is_plane && row.has_aperture && !row.is_open_outside && row.clear_semi_diameter > 0)
        radius = std::min(radius, row.clear_semi_diameter);
    surface.clear_semi_diameter = radius;
    lens.stop_semi_diameter = radius;
}

}  // namespace

std::vector<SurfaceRow> surface_rows(const Prescription& p) {
    std::vector<SurfaceRow> rows;
    const Glass air = Glass::air();
    const Glass* medium_before = &air;
    for (std::size_t i = 0; i < p.surfaces.size(); ++i) {
        const PrescriptionSurface& row = p.surfaces[i];
        const bool bends_light = row.is_mirror || !(row.material == *medium_before);
        if (row.is_stop) rows.push_back({i, SurfaceType::stop});
        if (bends_light)
            rows.push_back({i, row.is_mirror ? SurfaceType::mirror : SurfaceType::refracting});
        else if (!row.is_stop && row.has_aperture)
            rows.push_back({i, SurfaceType::aperture});
        if (!row.is_mirror) medium_before = &row.material;
    }
    return rows;
}

LensConfiguration lens_configuration(const Prescription& p, const std::vector<SurfaceRow>& surface_rows,
                                     LensSystem lens, std::size_t position) {
    double object = thickness(p, -1, position);
    std::size_t next = 0;
    double* thickness_so_far = &object;
    for (std::size_t row = 0; row < p.surfaces.size(); ++row) {
        for (; next < surface_rows.size() && surface_rows[next].row == row; ++next)
            thickness_so_far = &lens.surfaces[next].thickness;
        *thickness_so_far += thickness(p, static_cast<int>(row), position);
    }
    double& last = lens.surfaces.back().thickness;
    lens.film_distance = last + p.defocus;
    last = 0;
    if (std::isfinite(object) && object <= 0)
        fail(p, "the object lies " + std::to_string(-object) +
                    " mm behind the first surface; expected an object in front");
    set_stop(p, surface_rows, lens, object, position);
    if (p.paraxial_image && lens.film_distance == p.defocus)
        lens.film_distance = p.defocus + paraxial_image_distance(lens, lens.wavelength_nm, object);
    if (p.has_film_distance && lens.film_distance == 0) lens.film_distance = kFilmContact;
    if (std::isfinite(object)) lens.focus_distance = object + lens.film_position();
    return {std::move(lens), object};
}

LensSystem joined_configurations(const Prescription& p, const std::vector<LensConfiguration>& configurations) {
    const std::vector<std::string>& names = p.zoom_names;
    if (names.empty()) return configurations.front().lens;
    LensSystem joined = configurations[static_cast<std::size_t>(p.zoom_current)].lens;
    joined.zoom.current = p.zoom_current;
    const auto differs = [&](auto value) {
        return std::any_of(configurations.begin(), configurations.end(), [&](const LensConfiguration& configuration) {
            return value(configuration.lens) != value(configurations.front().lens);
        });
    };
    for (int i = 0; i + 1 < static_cast<int>(joined.surfaces.size()); ++i)
        if (differs([i](const LensSystem& s) { return s.surfaces[static_cast<std::size_t>(i)].thickness; }))
            joined.zoom.surfaces.push_back(i);
    const bool stop_changes = differs([](const LensSystem& s) { return s.stop_semi_diameter; });
    for (std::size_t k = 0; k < configurations.size(); ++k) {
        const LensSystem& lens = configurations[k].lens;
        ZoomPosition position{printable(names[k]),
                              {},
                              lens.film_distance,
                              lens.focus_distance,
                              stop_changes ? lens.stop_semi_diameter : 0.0};
        for (const int i : joined.zoom.surfaces)
            position.thicknesses.push_back(lens.surfaces[static_cast<std::size_t>(i)].thickness);
        joined.zoom.positions.push_back(std::move(position));
    }
    return joined;
}

}  // namespace realcam::io
