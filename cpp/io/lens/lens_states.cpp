#include "lens_states.hpp"

#include <algorithm>
#include <cmath>

#include "../../optics/lens/paraxial.hpp"
#include "../../optics/prescription/lens_limits.hpp"
#include "../text/printable.hpp"

namespace realcam::io {
namespace {

[[noreturn]] void fail(const Prescription& p, const std::string& message, const PrescriptionSurface* row = nullptr) {
    throw LensFileError(message, p.file, row ? row->line : 0, row ? row->number : 0);
}

double thickness(const Prescription& p, int row, std::size_t state) {
    const auto zoomed = p.zoom_thicknesses.find(row);
    if (zoomed != p.zoom_thicknesses.end()) return zoomed->second[state];
    return row < 0 ? p.object_distance : p.surfaces[static_cast<std::size_t>(row)].thickness;
}

/// Sets the size of the stop by first-order optics, as lens-design programs do.
void set_stop(const Prescription& p, const std::vector<KeptRow>& kept, LensSystem& lens, double object,
              std::size_t state) {
    const int stop = lens.stop_index(), count = static_cast<int>(lens.surfaces.size());
    Surface& surface = lens.surfaces[static_cast<std::size_t>(stop)];
    const double aperture = p.zoom_apertures.empty() ? p.aperture : p.zoom_apertures[state];
    const auto trace = [&](ParaxialRay ray, int last) {
        return trace_paraxial(lens, lens.wavelength_nm, ray, 0, last);
    };
    const ParaxialRay start = std::isinf(object) ? ParaxialRay{1, 0} : ParaxialRay{object, 1};
    const double at_stop = std::fabs(trace(start, stop + 1).height);
    const double pupil = std::fabs(trace({1, 0}, stop + 1).height);  // height at the stop over height in the pupil
    const double behind = lens.indices(lens.wavelength_nm).back();
    const auto slope_of = [&](double numerical) {
        if (!(numerical > 0 && numerical < 1)) fail(p, "the numerical aperture must lie between 0 and 1");
        return std::tan(std::asin(numerical));
    };
    double radius = 0;
    switch (p.aperture_kind) {
        case ApertureKind::stop_size: radius = aperture > 0 ? aperture : surface.clear_semi_diameter; break;
        case ApertureKind::entrance_pupil_diameter: radius = 0.5 * aperture * pupil; break;
        case ApertureKind::f_number:
            radius = 0.5 / (aperture * behind * std::fabs(trace({1, 0}, count).slope)) * pupil;
            break;
        case ApertureKind::working_f_number:
            radius = 0.5 / (aperture * behind * std::fabs(trace(start, count).slope)) * at_stop;
            break;
        case ApertureKind::image_aperture:
            radius = slope_of(aperture / behind) / std::fabs(trace(start, count).slope) * at_stop;
            break;
        case ApertureKind::object_aperture:
            if (std::isinf(object))
                fail(p, "a numerical aperture of the object's side belongs to an object at a finite distance");
            radius = slope_of(aperture) * at_stop;
            break;
    }
    if (!(radius > 0) || !std::isfinite(radius))
        fail(p,
             "the size of the aperture stop follows from nothing that the file says; expected "
             "an entrance pupil diameter, an f-number or the stop's semi-diameter",
             &p.surfaces[kept[static_cast<std::size_t>(stop)].row]);
    // The stop's own aperture limits it if it is smaller.
    const KeptRow& own = kept[static_cast<std::size_t>(stop)];
    const PrescriptionSurface& row = p.surfaces[own.row];
    const bool is_plane =
        static_cast<std::size_t>(stop) + 1 >= kept.size() || kept[static_cast<std::size_t>(stop) + 1].row != own.row;
    if (is_plane && row.blocks && !row.is_open_outside && row.clear_semi_diameter > 0)
        radius = std::min(radius, row.clear_semi_diameter);
    surface.clear_semi_diameter = radius;
    lens.stop_semi_diameter = radius;
}

}  // namespace

std::vector<KeptRow> kept_rows(const Prescription& p) {
    std::vector<KeptRow> kept;
    const Glass air = Glass::air();
    const Glass* before = &air;
    for (std::size_t i = 0; i < p.surfaces.size(); ++i) {
        const PrescriptionSurface& row = p.surfaces[i];
        const bool bends = row.is_mirror || !(row.material == *before);
        if (row.is_stop) kept.push_back({i, SurfaceType::stop});
        if (bends)
            kept.push_back({i, row.is_mirror ? SurfaceType::mirror : SurfaceType::refracting});
        else if (!row.is_stop && row.blocks)
            kept.push_back({i, SurfaceType::aperture});
        if (!row.is_mirror) before = &row.material;
    }
    return kept;
}

LensState lens_state(const Prescription& p, const std::vector<KeptRow>& kept, LensSystem lens, std::size_t state) {
    double object = thickness(p, -1, state);
    std::size_t next = 0;
    double* gap = &object;
    for (std::size_t row = 0; row < p.surfaces.size(); ++row) {
        for (; next < kept.size() && kept[next].row == row; ++next) gap = &lens.surfaces[next].thickness;
        *gap += thickness(p, static_cast<int>(row), state);
    }
    double& last = lens.surfaces.back().thickness;
    lens.film_distance = last + p.defocus;
    last = 0;
    if (std::isfinite(object) && object <= 0)
        fail(p, "the object lies " + std::to_string(-object) +
                    " mm behind the first surface; expected an object in front");
    set_stop(p, kept, lens, object, state);
    if (p.paraxial_image && lens.film_distance == p.defocus)
        lens.film_distance = p.defocus + paraxial_image_distance(lens, lens.wavelength_nm, object);
    if (p.has_film_distance && lens.film_distance == 0) lens.film_distance = kFilmContact;
    if (std::isfinite(object)) lens.focus_distance = object + lens.film_position();
    return {std::move(lens), object};
}

LensSystem joined_states(const Prescription& p, const std::vector<LensState>& states) {
    const std::vector<std::string>& names = p.zoom_names;
    if (names.empty()) return states.front().lens;
    LensSystem joined = states[static_cast<std::size_t>(p.zoom_current)].lens;
    joined.zoom.current = p.zoom_current;
    const auto differs = [&](auto value) {
        return std::any_of(states.begin(), states.end(),
                           [&](const LensState& state) { return value(state.lens) != value(states.front().lens); });
    };
    for (int i = 0; i + 1 < static_cast<int>(joined.surfaces.size()); ++i)
        if (differs([i](const LensSystem& s) { return s.surfaces[static_cast<std::size_t>(i)].thickness; }))
            joined.zoom.surfaces.push_back(i);
    const bool stop_changes = differs([](const LensSystem& s) { return s.stop_semi_diameter; });
    for (std::size_t k = 0; k < states.size(); ++k) {
        const LensSystem& state = states[k].lens;
        ZoomPosition position{printable(names[k]),
                              {},
                              state.film_distance,
                              state.focus_distance,
                              stop_changes ? state.stop_semi_diameter : 0.0};
        for (const int i : joined.zoom.surfaces)
            position.thicknesses.push_back(state.surfaces[static_cast<std::size_t>(i)].thickness);
        joined.zoom.positions.push_back(std::move(position));
    }
    return joined;
}

}  // namespace realcam::io
