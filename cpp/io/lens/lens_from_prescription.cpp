#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "../../math/hypotenuse.hpp"
#include "../../optics/lens/best_focus.hpp"
#include "../../optics/lens/focus.hpp"
#include "../../optics/lens/paraxial.hpp"
#include "../../optics/prescription/clearance.hpp"
#include "../../optics/prescription/lens_checks.hpp"
#include "../../optics/prescription/lens_limits.hpp"
#include "../text/printable.hpp"
#include "lens_configurations.hpp"
#include "lens_error.hpp"
#include "lens_format.hpp"
#include "lens_placements.hpp"
#include "lens_prescription.hpp"
#include "lens_rims.hpp"

namespace realcam::io {
namespace {

/// Reports all features of a file that realcam does not model: as warnings if `options.force` is set, otherwise by
/// throwing one LensReadError that names the first eight.
void report_unsupported(const std::vector<UnsupportedFeature>& features, const std::string& file,
                        const LensReadOptions& options) {
    if (features.empty()) return;
    const auto location = [](const UnsupportedFeature& f) {
        return std::string(f.surface > 0 ? "surface " + std::to_string(f.surface) : "") +
               (f.line > 0 ? (f.surface > 0 ? " (line " : "(line ") + std::to_string(f.line) + ")" : "");
    };
    constexpr std::size_t kMaxNamed = 8;
    if (options.force) {
        if (!options.warn) return;
        for (const UnsupportedFeature& f : features)
            options.warn(file + ": " + (location(f).empty() ? "" : location(f) + ": ") + "left out: " + f.description);
        return;
    }
    std::string further;
    for (std::size_t i = 1; i < std::min(features.size(), kMaxNamed); ++i)
        further += (i == 1 ? "; also " : ", ") + features[i].description +
                   (location(features[i]).empty() ? "" : " at " + location(features[i]));
    if (features.size() > kMaxNamed) further += ", and " + std::to_string(features.size() - kMaxNamed) + " more";
    const UnsupportedFeature& first = features.front();
    LensReadError error("has " + first.description + further + ", which realcam does not model", file, first.line,
                        first.surface);
    error.can_be_forced = true;
    throw error;
}

/// Converts a prescription to a lens. Zoom positions become configurations of the same surfaces.
class PrescriptionConverter {
public:
    PrescriptionConverter(const Prescription& p, const LensReadOptions& options)
        : p_(p),
          options_(options),
          unsupported_(p.unsupported),
          surface_rows_(surface_rows(p)),
          checkpoint_(options.keep_going) {}

    /// Throws LensFileError, InputError and Cancelled.
    LensSystem build() {
        make_surfaces();
        set_shapes();
        check_table();
        lens_.title = printable(p_.title);
        const std::size_t slash = p_.file.find_last_of('/');
        const std::string file_name = p_.file.substr(slash == p_.file.npos ? 0 : slash + 1);
        lens_.name = printable(file_name.substr(0, file_name.find_last_of('.')));
        if (lens_.name.empty()) lens_.name = "lens";
        lens_.wavelength_nm = p_.wavelength_nm;
        if (!(lens_.wavelength_nm >= 100 && lens_.wavelength_nm <= 20000))
            fail("the wavelength is " + std::to_string(lens_.wavelength_nm) + " nm; expected 100 to 20000 nm");
        check_materials();
        const std::size_t count = std::max<std::size_t>(1, p_.zoom_names.size());
        for (std::size_t k = 0; k < count; ++k)
            configurations_.push_back(lens_configuration(p_, surface_rows_, lens_, k));
        set_semi_diameters();
        set_film_size();
        set_obscuration_plane_sizes();
        lens_ = joined_configurations(p_, configurations_);
        set_asymmetric_parts();
        finish();
        return lens_;
    }

private:
    /// Throws LensFileError, at the line and surface of a row if there is one.
    [[noreturn]] void fail(const std::string& message, const PrescriptionSurface* row = nullptr) const {
        throw LensFileError(message, p_.file, row ? row->line : 0, row ? row->number : 0);
    }
    void warn(const std::string& message) const {
        if (options_.warn) options_.warn(p_.file + ": " + message);
    }
    /// Row of the file from which a surface of the lens was made.
    const PrescriptionSurface& row_of(std::size_t surface) const { return p_.surfaces[surface_rows_[surface].row]; }

    /// True if the surface is a plane with an obscuring disc, outside which all light passes.
    bool is_open_plane(std::size_t surface) const {
        return surface_rows_[surface].type == SurfaceType::aperture && row_of(surface).is_open_outside;
    }

    /// Throws LensFileError if a material has no index at the design wavelength. Checked here, where errors can name
    /// the surface by its number in the file.
    void check_materials() const {
        for (std::size_t i = 0; i < surface_rows_.size(); ++i) {
            if (surface_rows_[i].type != SurfaceType::refracting) continue;
            const double n = lens_.surfaces[i].material.index(lens_.wavelength_nm);
            if (!(n > 0.1) || !(n < 100))
                fail(
                    "its material" +
                        (lens_.surfaces[i].material.label.empty() ? ""
                                                                  : ' ' + in_quotes(lens_.surfaces[i].material.label)) +
                        " has no refractive index at " + std::to_string(std::lround(lens_.wavelength_nm)) + " nm",
                    &row_of(i));
        }
    }

    /// Checks the number of surfaces and of stops.
    void check_table() const {
        const auto bends = [](const SurfaceRow& k) {
            return k.type == SurfaceType::refracting || k.type == SurfaceType::mirror;
        };
        if (std::none_of(surface_rows_.begin(), surface_rows_.end(), bends))
            fail("no surface bends light; expected a lens");
        if (surface_rows_.size() > static_cast<std::size_t>(kMaxSurfaces))
            fail("the lens has " + std::to_string(surface_rows_.size()) + " surfaces; at most " +
                 std::to_string(kMaxSurfaces) + " are supported");
        const auto stops = std::count_if(surface_rows_.begin(), surface_rows_.end(),
                                         [](const SurfaceRow& k) { return k.type == SurfaceType::stop; });
        if (stops > 1) fail("several surfaces are aperture stops; expected one");
    }

    /// True if a row became a face of the lens, possibly in addition to a stop.
    bool bends_light(std::size_t row) const {
        return std::any_of(surface_rows_.begin(), surface_rows_.end(), [&](const SurfaceRow& k) {
            return k.row == row && (k.type == SurfaceType::refracting || k.type == SurfaceType::mirror);
        });
    }

    /// Creates the lens's surfaces from the rows, without their shapes.
    void make_surfaces() {
        for (const SurfaceRow& surface_row : surface_rows_) {
            const PrescriptionSurface& row = p_.surfaces[surface_row.row];
            Surface surface;
            surface.type = surface_row.type;
            surface.clear_semi_diameter = row.clear_semi_diameter;
            // If a row is a stop and a face, its obscuration belongs to the face.
            const bool is_extra_plane = surface_row.type == SurfaceType::stop && bends_light(surface_row.row);
            surface.inner_semi_diameter = is_extra_plane ? 0 : row.inner_semi_diameter;
            if (surface.bends_light()) {
                if (surface_row.type == SurfaceType::refracting) surface.material = row.material;
                if (row.is_stop) surface_with_stop_ = row.number;
                curved_planes_.erase(row.number);
            } else if (row.curvature != 0) {
                curved_planes_.insert(row.number);
            }
            lens_.surfaces.push_back(std::move(surface));
        }
    }

    /// Reduces the semi-diameter of a surface that is smaller than its own rim, such as a hemisphere, to the surface:
    /// no ray meets it farther out.
    void fit_rim_to_surface(std::size_t i) {
        Surface& surface = lens_.surfaces[i];
        const double inverse_square = (1 + surface.conic) * surface.curvature * surface.curvature;
        if (!surface.form.has_conic_base() || !(inverse_square > 0)) return;
        const double end = (1 - 1e-9) / std::sqrt(inverse_square);
        if (!(surface.clear_semi_diameter > end)) return;
        warn("surface " + std::to_string(row_of(i).number) + ": its clear semi-diameter of " +
             lens_checks_detail::short_mm(surface.clear_semi_diameter) + " is larger than the surface, and becomes " +
             lens_checks_detail::short_mm(end));
        surface.clear_semi_diameter = end;
    }

    /// Stores a form without rotational symmetry for later, and removes it from the surface.
    void store_asymmetric_form(std::size_t i) {
        forms_.resize(surface_rows_.size());
        forms_[i] = lens_.surfaces[i].form;
        if (!forms_[i].asymmetry().empty()) lens_.surfaces[i].form = {};
    }

    /// Sets the shapes of the surfaces, and reports all features that realcam does not model (report_unsupported).
    void set_shapes() {
        for (std::size_t i = 0; i < surface_rows_.size(); ++i) {
            if (!lens_.surfaces[i].bends_light()) continue;
            const PrescriptionSurface& row = row_of(i);
            const double rim =
                row.clear_semi_diameter > 0 ? row.clear_semi_diameter : kGuessedFraction * known_pupil_diameter();
            const std::string error = set_aspheric_terms(row, rim, lens_.surfaces[i]);
            if (!error.empty()) unsupported_.push_back({error, row.line, row.number});
            fit_rim_to_surface(i);
            store_asymmetric_form(i);
        }
        report_unsupported(unsupported_, p_.file, options_);
    }

    /// Semi-diameter that is assumed until rays are traced, as a fraction of the entrance pupil's diameter.
    static constexpr double kGuessedFraction = 0.5;
    /// Diameter of the entrance pupil, mm; 0 if the file does not specify it.
    double known_pupil_diameter() const {
        return p_.aperture_kind == ApertureKind::entrance_pupil_diameter ? p_.aperture : 0.0;
    }

    /// Sets semi-diameters that the file omits to the greatest heights of the real rays in all zoom positions.
    void set_semi_diameters() {
        std::vector<std::size_t> missing;
        for (std::size_t i = 0; i < surface_rows_.size(); ++i)
            if (lens_.surfaces[i].type != SurfaceType::stop && !is_open_plane(i) &&
                (row_of(i).is_open_outside || !(lens_.surfaces[i].clear_semi_diameter > 0)))
                missing.push_back(i);
        if (missing.empty()) return;
        std::vector<double> rims(surface_rows_.size(), 0.0);
        bool all_rays_pass = true;
        for (std::size_t k = 0; k < configurations_.size(); ++k) {
            const RayHeights found = required_semi_diameters(
                configurations_[k].lens, configurations_[k].object_distance, p_.field_kind, p_.fields, checkpoint_);
            all_rays_pass = all_rays_pass && found.all_rays_pass;
            for (std::size_t i = 0; i < rims.size(); ++i) rims[i] = std::max(rims[i], found.semi_diameters[i]);
        }
        std::string names;
        for (const std::size_t i : missing) {
            const double stated = row_of(i).clear_semi_diameter;
            rims[i] = std::max(rims[i], stated);
            for (LensConfiguration& configuration : configurations_)
                configuration.lens.surfaces[i].clear_semi_diameter = rims[i];
            lens_.surfaces[i].clear_semi_diameter = rims[i];
            convert_square_term_again(i, rims[i]);
            if (!(stated > 0)) names += (names.empty() ? "" : ", ") + std::to_string(row_of(i).number);
        }
        if (names.empty()) return;
        warn("specifies no clear semi-diameter for surface" + std::string(names.find(',') != names.npos ? "s " : " ") +
             names + ": the heights of the real marginal and field rays are used" +
             (all_rays_pass ? "" : ", some of which do not pass the lens"));
    }

    /// Converts a term of r^2 again (set_aspheric_terms), now that the semi-diameter up to which the conversion must be
    /// accurate is known.
    void convert_square_term_again(std::size_t i, double rim) {
        const PrescriptionSurface& row = row_of(i);
        if (!row.aspheric.contains(2) || !lens_.surfaces[i].bends_light()) return;
        const std::string what = set_aspheric_terms(row, rim, lens_.surfaces[i]);
        if (!what.empty() && !options_.force) fail("has " + what + ", which realcam does not model", &row);
        store_asymmetric_form(i);
        for (auto& [configuration, distance] : configurations_) {
            configuration.surfaces[i].curvature = lens_.surfaces[i].curvature;
            configuration.surfaces[i].conic = lens_.surfaces[i].conic;
            configuration.surfaces[i].aspheric = lens_.surfaces[i].aspheric;
            configuration.surfaces[i].form = lens_.surfaces[i].form;
        }
    }

    /// Sets the semi-diameters of planes with an obscuring disc so that they block no ray that the other surfaces pass:
    /// between two rims, a straight line stays within the larger of them.
    void set_obscuration_plane_sizes() {
        constexpr double kMargin = 1.25;  // faces are not planes at their vertices
        for (std::size_t i = 0; i < surface_rows_.size(); ++i) {
            if (!is_open_plane(i)) continue;
            double rim = 0;
            for (const LensConfiguration& configuration : configurations_)
                rim = std::max(rim, kMargin * reach_of_light(configuration.lens, i));
            if (row_of(i).inner_semi_diameter >= rim)
                fail("its obscuration blocks all light that passes the lens", &row_of(i));
            for (LensConfiguration& configuration : configurations_)
                configuration.lens.surfaces[i].clear_semi_diameter = rim;
            lens_.surfaces[i].clear_semi_diameter = rim;
        }
    }

    /// Returns the greatest distance from the axis, mm, at which light can cross a plane of the lens.
    double reach_of_light(const LensSystem& lens, std::size_t plane) const {
        const double film = 0.5 * hypotenuse(lens.film_width, lens.film_height);
        const auto rim = [&](std::size_t i) { return lens.surfaces[i].clear_semi_diameter; };
        std::size_t before = plane, behind = plane + 1;
        while (before > 0 && is_open_plane(before - 1)) --before;
        while (behind < surface_rows_.size() && is_open_plane(behind)) ++behind;
        // After the last rim the line ends on the film; a larger film may be used later.
        const double end = behind < surface_rows_.size() ? rim(behind) : 2 * film;
        if (before > 0) return std::max(rim(before - 1), end);
        double distance = 0;
        for (std::size_t i = plane; i < behind && i + 1 < surface_rows_.size(); ++i)
            distance += lens.surfaces[i].thickness;
        const double focal = std::fabs(first_order(lens, lens_.wavelength_nm).effective_focal_length);
        // Before all rims: light comes at up to twice the field's slope, and at least at 27 degrees.
        return end + std::fabs(distance) * std::clamp(2 * film / focal, 0.5, 10.0);
    }

    /// Sets forms, apertures and placements without rotational symmetry. The sizes before were computed as if the lens
    /// were centred, in the yz planes of its surfaces.
    void set_asymmetric_parts() {
        bool moves = !p_.image_placement.is_in_place();
        for (const PrescriptionSurface& row : p_.surfaces) moves |= is_displaced(row);
        for (std::size_t i = 0; i < surface_rows_.size(); ++i) {
            lens_.surfaces[i].aperture_shape = row_of(i).aperture_shape;
            if (lens_.surfaces[i].bends_light()) lens_.surfaces[i].form = forms_[i];
        }
        if (moves && !p_.zoom_names.empty())
            fail("is a zoom lens with tilted or decentred surfaces, which is not supported");
        if (moves) set_placements(p_, surface_rows_, lens_);
        if (p_.zoom_names.empty()) set_film(p_, lens_);
        if (!lens_.is_rotational())
            warn("has no rotational symmetry: " + lens_.asymmetry() +
                 ". Its stop and all values that the file omits are computed in the yz plane, as if the lens had it");
    }

    /// Greatest half diagonal of a curved film, as a fraction of its radius of curvature.
    static constexpr double kMaxFilmFraction = 0.95;

    /// Sets the size of the film: of the aspect ratio 3:2, as 36 x 24 mm, with its corners at the largest image height
    /// of the fields.
    void set_film_size() {
        double height = 0;
        for (std::size_t k = 0; k < configurations_.size(); ++k)
            height = std::max(height, largest_image_height(configurations_[k].lens, configurations_[k].object_distance,
                                                           p_.field_kind, p_.fields));
        const double focal =
            std::fabs(first_order(configurations_.front().lens, lens_.wavelength_nm).effective_focal_length);
        if (!(height > 0) || !std::isfinite(height)) {
            height = std::isfinite(focal) ? 0.5 * focal : hypotenuse(18.0, 12.0);
            warn("specifies no field: the film's diagonal is assumed to be the focal length");
        }
        const double max_height =
            p_.image_curvature == 0 ? kInfinity : kMaxFilmFraction / std::fabs(p_.image_curvature);
        if (height > max_height) {
            height = max_height;
            warn("has fields beyond the edge of its curved image surface: the film ends there");
        }
        for (auto& [configuration, distance] : configurations_) {
            // The half diagonal of a film of 3 x 2 is sqrt(13) / 2.
            configuration.film_width = 2 * height * 3 / std::sqrt(13.0);
            configuration.film_height = 2 * height * 2 / std::sqrt(13.0);
        }
    }

    /// Adds the warnings, and checks the finished lens.
    void finish() {
        for (const std::string& remark : p_.remarks) warn(remark);
        if (std::ranges::any_of(configurations_,
                                [](const LensConfiguration& s) { return s.lens.film_distance == kFilmContact; }))
            warn("the film touches the last face: 0.001 mm of air are inserted between them");
        if (surface_with_stop_ > 0)
            warn("the aperture stop on surface " + std::to_string(surface_with_stop_) +
                 ", which bends light, becomes a plane at its vertex");
        for (const int number : curved_planes_)
            warn("surface " + std::to_string(number) + " does not bend light, and becomes a plane at its vertex");
        lens_.allow_overlap = true;
        try {
            check_all();
        } catch (const LensFileError& error) {  // its surface numbers are those of the lens
            const auto index = static_cast<std::size_t>(error.surface) - 1;
            fail(error.detail, error.surface > 0 && index < surface_rows_.size() ? &row_of(index) : nullptr);
        }
        lens_.allow_overlap = has_overlaps();
        if (options_.design_light) *options_.design_light = {field_angles_deg(), p_.wavelengths_nm};
    }

    /// Angles of the chief rays of the file's fields, in degrees.
    std::vector<double> field_angles_deg() const {
        std::vector<double> angles;
        for (const PrescriptionField& field : p_.fields)
            angles.push_back(180 / std::numbers::pi *
                             field_angle_of(configurations_.front().lens, configurations_.front().object_distance,
                                            p_.field_kind, hypotenuse(field.x, field.y)));
        return angles;
    }

    /// Throws LensFileError if the lens is invalid. Sets the film distance if the file omits it.
    void check_all() {
        validate(lens_);
        if (!p_.has_film_distance) {
            lens_.film_distance = best_focus_distance(lens_, lens_.wavelength_nm, kInfinity);
            if (!(lens_.film_distance > 0))
                fail("the lens makes no real image of infinity behind its last surface, so that there is no film");
        }
        if (const std::string why = film_distance_error(lens_); !why.empty()) throw LensFileError(why);
    }

    /// True if faces cross inside their clear semi-diameters. This is an error unless it is forced, or no ray of the
    /// file's fields that passes the lens reaches the crossing.
    bool has_overlaps() {
        const int count = std::max(1, static_cast<int>(lens_.zoom.positions.size()));
        bool is_crossed = false;
        for (int i = 0; i < count; ++i) {
            checkpoint_.pass(kWorkPerLens);
            const LensSystem lens = lens_.zoom.positions.empty() ? lens_ : at_zoom_position(lens_, i);
            std::string what;
            const PrescriptionSurface* row = nullptr;
            if (const auto found = find_overlap(lens)) {
                row = &row_of(static_cast<std::size_t>(found->first));
                what = "crosses surface " + std::to_string(row_of(static_cast<std::size_t>(found->second)).number) +
                       ", by " + lens_checks_detail::short_mm(found->depth) + " at " +
                       lens_checks_detail::short_mm(found->radius) + " from the axis";
            } else if (film_crosses_lens(lens)) {
                row = &row_of(surface_rows_.size() - 1);
                what = "is cut by the film";
            }
            if (!row) continue;
            if (!lens_.zoom.positions.empty())
                what += " in zoom position \"" + lens.zoom.positions[static_cast<std::size_t>(i)].name + '"';
            if (!options_.force && !passes_inside_crossings(lens, static_cast<std::size_t>(i))) {
                LensReadError error(what + "; such a lens cannot be manufactured", p_.file, row->line, row->number);
                error.can_be_forced = true;
                throw error;
            }
            warn("surface " + std::to_string(row->number) + ' ' + what +
                 (options_.force ? "" : "; no ray of the file's fields that passes the lens reaches that far"));
            is_crossed = true;
        }
        return is_crossed;
    }

    /// True if no ray of the fields that passes the lens reaches the part of two faces where they cross.
    bool passes_inside_crossings(LensSystem lens, std::size_t configuration) {
        if (!lens_.is_rotational() || film_crosses_lens(lens)) return false;
        const RayHeights max_height = passing_ray_heights(lens, configurations_[configuration].object_distance,
                                                          p_.field_kind, p_.fields, checkpoint_);
        for (std::size_t i = 0; i < surface_rows_.size(); ++i)
            if (max_height.semi_diameters[i] > 0)
                lens.surfaces[i].clear_semi_diameter =
                    std::min(lens.surfaces[i].clear_semi_diameter, max_height.semi_diameters[i]);
        return !find_overlap(lens);
    }

    const Prescription& p_;
    const LensReadOptions& options_;
    std::vector<UnsupportedFeature> unsupported_;
    std::vector<SurfaceRow> surface_rows_;
    LensSystem lens_;
    std::vector<LensConfiguration> configurations_;  ///< one per zoom position; one if the lens is not a zoom lens
    std::vector<SurfaceForm> forms_;  ///< of the surfaces, including those without rotational symmetry
    int surface_with_stop_ = 0;  ///< number of a surface that bends light and is the stop; 0: none
    std::set<int> curved_planes_;  ///< numbers of curved surfaces that do not bend light
    Checkpoint checkpoint_;
    static constexpr std::size_t kWorkPerLens = 1 << 14;  // checkpoint work of an operation on a whole lens
};

}  // namespace

LensSystem lens_from(Prescription prescription, const LensReadOptions& options) {
    std::vector<PrescriptionSurface>& rows = prescription.surfaces;
    if (!rows.empty() && std::ranges::none_of(rows, [](const PrescriptionSurface& row) { return row.is_stop; })) {
        rows.front().is_stop = true;
        prescription.remarks.push_back("it specifies no aperture stop: surface " + std::to_string(rows.front().number) +
                                       " is assumed");
    }
    try {
        return PrescriptionConverter(prescription, options).build();
    } catch (const InputError& error) {  // a glass without an index, or a field that no ray reaches
        throw LensReadError(error, prescription.file);
    }
}

}  // namespace realcam::io
