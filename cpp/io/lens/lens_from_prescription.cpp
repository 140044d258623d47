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
#include "lens_error.hpp"
#include "lens_format.hpp"
#include "lens_placements.hpp"
#include "lens_prescription.hpp"
#include "lens_rims.hpp"
#include "lens_states.hpp"

namespace realcam::io {
namespace {

/// Reports all features of a file that realcam does not model: as warnings if `options.force` is set, otherwise as one
/// LensFileError.
void refuse_features(const std::vector<ForeignFeature>& features, const std::string& file,
                     const LensReadOptions& options) {
    if (features.empty()) return;
    const auto place = [](const ForeignFeature& f) {
        return std::string(f.surface > 0 ? "surface " + std::to_string(f.surface) : "") +
               (f.line > 0 ? (f.surface > 0 ? " (line " : "(line ") + std::to_string(f.line) + ")" : "");
    };
    constexpr std::size_t kMostNamed = 8;
    if (options.force) {
        if (!options.warn) return;
        for (const ForeignFeature& f : features)
            options.warn(file + ": " + (place(f).empty() ? "" : place(f) + ": ") + "left out: " + f.what);
        return;
    }
    std::string also;
    for (std::size_t i = 1; i < std::min(features.size(), kMostNamed); ++i)
        also += (i == 1 ? "; also " : ", ") + features[i].what +
                (place(features[i]).empty() ? "" : " at " + place(features[i]));
    if (features.size() > kMostNamed) also += ", and " + std::to_string(features.size() - kMostNamed) + " more";
    const ForeignFeature& first = features.front();
    LensReadError error("has " + first.what + also + ", of which realcam has no model", file, first.line,
                        first.surface);
    error.can_be_forced = true;
    throw error;
}

class Builder {
public:
    Builder(const Prescription& p, const LensReadOptions& options)
        : p_(p), options_(options), foreign_(p.foreign), kept_(kept_rows(p)), checkpoint_(options.keep_going) {}

    LensSystem build() {
        make_surfaces();
        refuse_foreign();
        check_table();
        lens_.name = lens_.title = printable(p_.title);
        const std::size_t slash = p_.file.find_last_of('/');
        const std::string base = p_.file.substr(slash == p_.file.npos ? 0 : slash + 1);
        lens_.name = printable(base.substr(0, base.find_last_of('.')));
        if (lens_.name.empty()) lens_.name = "lens";
        lens_.wavelength_nm = p_.wavelength_nm;
        if (!(lens_.wavelength_nm >= 100 && lens_.wavelength_nm <= 20000))
            fail("the wavelength is " + std::to_string(lens_.wavelength_nm) + " nm; expected 100 to 20000 nm");
        check_materials();
        const std::size_t count = std::max<std::size_t>(1, p_.zoom_names.size());
        for (std::size_t k = 0; k < count; ++k) states_.push_back(lens_state(p_, kept_, lens_, k));
        set_rims();
        set_film_size();
        set_open_rims();
        lens_ = joined_states(p_, states_);
        set_free_parts();
        finish();
        return lens_;
    }

private:
    [[noreturn]] void fail(const std::string& message, const PrescriptionSurface* row = nullptr) const {
        throw LensFileError(message, p_.file, row ? row->line : 0, row ? row->number : 0);
    }
    void warn(const std::string& message) const {
        if (options_.warn) options_.warn(p_.file + ": " + message);
    }
    const PrescriptionSurface& row_of(std::size_t surface) const { return p_.surfaces[kept_[surface].row]; }

    /// True if the surface is a plane that light passes everywhere outside a disc.
    bool is_open_plane(std::size_t surface) const {
        return kept_[surface].type == SurfaceType::aperture && row_of(surface).is_open_outside;
    }

    /// Checked here, because errors can name the surface by its number in the file; later computations would use the
    /// lens's numbers.
    void check_materials() const {
        for (std::size_t i = 0; i < kept_.size(); ++i) {
            if (kept_[i].type != SurfaceType::refracting) continue;
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

    void check_table() const {
        const auto bends = [](const KeptRow& k) {
            return k.type == SurfaceType::refracting || k.type == SurfaceType::mirror;
        };
        if (std::none_of(kept_.begin(), kept_.end(), bends)) fail("no surface bends light; expected a lens");
        if (kept_.size() > static_cast<std::size_t>(kMaxSurfaces))
            fail("the lens has " + std::to_string(kept_.size()) + " surfaces; at most " + std::to_string(kMaxSurfaces) +
                 " are supported");
        const auto stops =
            std::count_if(kept_.begin(), kept_.end(), [](const KeptRow& k) { return k.type == SurfaceType::stop; });
        if (stops > 1) fail("several surfaces are aperture stops; one has to be");
    }

    /// True if a row became a face of the lens, possibly in addition to a stop.
    bool bends_light(std::size_t row) const {
        return std::any_of(kept_.begin(), kept_.end(), [&](const KeptRow& k) {
            return k.row == row && (k.type == SurfaceType::refracting || k.type == SurfaceType::mirror);
        });
    }

    void make_surfaces() {
        for (const KeptRow& kept : kept_) {
            const PrescriptionSurface& row = p_.surfaces[kept.row];
            Surface surface;
            surface.type = kept.type;
            surface.clear_semi_diameter = row.clear_semi_diameter;
            // If a surface is also a stop, rim and hole belong to the surface.
            const bool is_extra_plane = kept.type == SurfaceType::stop && bends_light(kept.row);
            surface.inner_semi_diameter = is_extra_plane ? 0 : row.inner_semi_diameter;
            if (surface.bends_light()) {
                if (kept.type == SurfaceType::refracting) surface.material = row.material;
                if (row.is_stop) stop_on_surface_ = row.number;
                curved_planes_.erase(row.number);
            } else if (row.curvature != 0) {
                curved_planes_.insert(row.number);
            }
            lens_.surfaces.push_back(std::move(surface));
        }
    }

    /// Stores a form without rotational symmetry for later, and removes it from the surface.
    void keep_form(std::size_t i) {
        forms_.resize(kept_.size());
        forms_[i] = lens_.surfaces[i].form;
        if (!forms_[i].asymmetry().empty()) lens_.surfaces[i].form = {};
    }

    /// Reports all features that are not modelled; an error unless forced.
    void refuse_foreign() {
        for (std::size_t i = 0; i < kept_.size(); ++i) {
            if (!lens_.surfaces[i].bends_light()) continue;
            const PrescriptionSurface& row = row_of(i);
            const double rim = row.clear_semi_diameter > 0 ? row.clear_semi_diameter : kGuess * known_aperture();
            const std::string what = set_aspheric_terms(row, rim, lens_.surfaces[i]);
            if (!what.empty()) foreign_.push_back({what, row.line, row.number});
            keep_form(i);
        }
        refuse_features(foreign_, p_.file, options_);
    }

    /// Factor for a rim that is not known yet: it is estimated from the entrance pupil's diameter, until rays are
    /// traced.
    static constexpr double kGuess = 0.5;
    double known_aperture() const {
        return p_.aperture_kind == ApertureKind::entrance_pupil_diameter ? p_.aperture : 0.0;
    }

    /// Sets rims that the file omits to the extent of the real rays, over all zoom positions.
    void set_rims() {
        std::vector<std::size_t> wanted;
        for (std::size_t i = 0; i < kept_.size(); ++i)
            if (lens_.surfaces[i].type != SurfaceType::stop && !is_open_plane(i) &&
                (row_of(i).is_open_outside || !(lens_.surfaces[i].clear_semi_diameter > 0)))
                wanted.push_back(i);
        if (wanted.empty()) return;
        std::vector<double> rims(kept_.size(), 0.0);
        bool all = true;
        for (std::size_t k = 0; k < states_.size(); ++k) {
            const RayRims found =
                rims_of_rays(states_[k].lens, states_[k].object_distance, p_.field_kind, p_.fields, checkpoint_);
            all = all && found.all_rays_pass;
            for (std::size_t i = 0; i < rims.size(); ++i) rims[i] = std::max(rims[i], found.semi_diameters[i]);
        }
        std::string names;
        for (const std::size_t i : wanted) {
            const double stated = row_of(i).clear_semi_diameter;
            rims[i] = std::max(rims[i], stated);
            for (LensState& state : states_) state.lens.surfaces[i].clear_semi_diameter = rims[i];
            lens_.surfaces[i].clear_semi_diameter = rims[i];
            fold_again(i, rims[i]);
            if (!(stated > 0)) names += (names.empty() ? "" : ", ") + std::to_string(row_of(i).number);
        }
        if (names.empty()) return;
        warn("states no clear semi-diameter of surface" + std::string(names.find(',') != names.npos ? "s " : " ") +
             names + ": those of the real marginal and field rays are taken" +
             (all ? "" : ", of which some do not pass the lens"));
    }

    /// Folds a term of r^2 again: the first time, the rim up to which that must be accurate was not known.
    void fold_again(std::size_t i, double rim) {
        const PrescriptionSurface& row = row_of(i);
        if (!row.aspheric.contains(2) || !lens_.surfaces[i].bends_light()) return;
        const std::string what = set_aspheric_terms(row, rim, lens_.surfaces[i]);
        if (!what.empty() && !options_.force) fail("has " + what + ", of which realcam has no model", &row);
        keep_form(i);
        for (auto& [state, distance] : states_) {
            state.surfaces[i].curvature = lens_.surfaces[i].curvature;
            state.surfaces[i].conic = lens_.surfaces[i].conic;
            state.surfaces[i].aspheric = lens_.surfaces[i].aspheric;
            state.surfaces[i].form = lens_.surfaces[i].form;
        }
    }

    /// Gives a plane that light passes everywhere outside a disc a rim that blocks no ray which the other surfaces
    /// pass: between two rims, a straight line stays within the larger of them.
    void set_open_rims() {
        constexpr double kMargin = 1.25;  // faces are not planes at their vertices
        for (std::size_t i = 0; i < kept_.size(); ++i) {
            if (!is_open_plane(i)) continue;
            double rim = 0;
            for (const LensState& state : states_) rim = std::max(rim, kMargin * reach_of_light(state.lens, i));
            if (row_of(i).inner_semi_diameter >= rim)
                fail("its obscuration is larger than all of the light that passes the lens", &row_of(i));
            for (LensState& state : states_) state.lens.surfaces[i].clear_semi_diameter = rim;
            lens_.surfaces[i].clear_semi_diameter = rim;
        }
    }

    /// Returns the greatest distance from the axis at which light can cross a plane.
    double reach_of_light(const LensSystem& lens, std::size_t plane) const {
        const double film = 0.5 * hypotenuse(lens.film_width, lens.film_height);
        const auto rim = [&](std::size_t i) { return lens.surfaces[i].clear_semi_diameter; };
        std::size_t before = plane, behind = plane + 1;
        while (before > 0 && is_open_plane(before - 1)) --before;
        while (behind < kept_.size() && is_open_plane(behind)) ++behind;
        // After the last rim the line ends on the film; a larger film may be used later.
        const double end = behind < kept_.size() ? rim(behind) : 2 * film;
        if (before > 0) return std::max(rim(before - 1), end);
        double distance = 0;
        for (std::size_t i = plane; i < behind && i + 1 < kept_.size(); ++i) distance += lens.surfaces[i].thickness;
        const double focal = std::fabs(first_order(lens, lens_.wavelength_nm).effective_focal_length);
        // Before all rims: light comes at up to twice the field's slope, and at least at 27 degrees.
        return end + std::fabs(distance) * std::clamp(2 * film / focal, 0.5, 10.0);
    }

    /// Sets forms, apertures and placements without symmetry. Sizes were found as if the lens were centred, in the yz
    /// planes of its surfaces.
    void set_free_parts() {
        bool moves = !p_.image_placement.is_in_place();
        for (const PrescriptionSurface& row : p_.surfaces) moves |= is_moved(row);
        for (std::size_t i = 0; i < kept_.size(); ++i) {
            lens_.surfaces[i].aperture_shape = row_of(i).aperture_shape;
            if (lens_.surfaces[i].bends_light()) lens_.surfaces[i].form = forms_[i];
        }
        if (moves && !p_.zoom_names.empty())
            fail("zooms with surfaces that are tilted or decentred, which is not supported");
        if (moves) set_placements(p_, kept_, lens_);
        if (p_.zoom_names.empty()) set_film(p_, lens_);
        if (!lens_.is_rotational())
            warn("is no centred lens of revolution: " + lens_.asymmetry() +
                 ". Its stop and what else the file leaves open are found as if it were, in the yz plane");
    }

    /// Greatest half diagonal of a curved film, as a fraction of its radius of curvature.
    static constexpr double kReachOfFilm = 0.95;

    void set_film_size() {
        // A film of 3:2, as 36 x 24 mm, with its corners at the largest image height.
        double height = 0;
        for (std::size_t k = 0; k < states_.size(); ++k)
            height = std::max(
                height, largest_image_height(states_[k].lens, states_[k].object_distance, p_.field_kind, p_.fields));
        const double focal = std::fabs(first_order(states_.front().lens, lens_.wavelength_nm).effective_focal_length);
        if (!(height > 0) || !std::isfinite(height)) {
            height = std::isfinite(focal) ? 0.5 * focal : hypotenuse(18.0, 12.0);
            warn("states no field: the film's diagonal is taken to be the focal length");
        }
        const double reach = p_.image_curvature == 0 ? kInfinity : kReachOfFilm / std::fabs(p_.image_curvature);
        if (height > reach) {
            height = reach;
            warn("has fields beyond the edge of its curved image surface: the film ends there");
        }
        for (auto& [state, distance] : states_) {
            state.film_width = 2 * height * 3 / std::sqrt(13.0);
            state.film_height = 2 * height * 2 / std::sqrt(13.0);
        }
    }

    void finish() {
        for (const std::string& remark : p_.remarks) warn(remark);
        if (std::ranges::any_of(states_, [](const LensState& s) { return s.lens.film_distance == kFilmContact; }))
            warn("the film touches the last face: 0.001 mm of air are put between them");
        if (stop_on_surface_ > 0)
            warn("the aperture stop on surface " + std::to_string(stop_on_surface_) +
                 ", which bends light, becomes a plane at its vertex");
        for (const int number : curved_planes_)
            warn("surface " + std::to_string(number) + " bends no light, and becomes a plane at its vertex");
        lens_.allow_overlap = true;
        try {
            check_all();
        } catch (const LensFileError& error) {  // its surface numbers are those of the lens
            const auto index = static_cast<std::size_t>(error.surface) - 1;
            fail(error.detail, error.surface > 0 && index < kept_.size() ? &row_of(index) : nullptr);
        }
        lens_.allow_overlap = crosses();
        if (options_.design_light) *options_.design_light = {field_angles_deg(), p_.wavelengths_nm};
    }

    std::vector<double> field_angles_deg() const {
        std::vector<double> angles;
        for (const PrescriptionField& field : p_.fields)
            angles.push_back(180 / std::numbers::pi *
                             field_angle_of(states_.front().lens, states_.front().object_distance, p_.field_kind,
                                            hypotenuse(field.x, field.y)));
        return angles;
    }

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
    bool crosses() {
        const int count = std::max(1, static_cast<int>(lens_.zoom.positions.size()));
        bool is_crossed = false;
        for (int i = 0; i < count; ++i) {
            checkpoint_.pass(kWorkOfLens);
            const LensSystem lens = lens_.zoom.positions.empty() ? lens_ : at_zoom_position(lens_, i);
            std::string what;
            const PrescriptionSurface* row = nullptr;
            if (const auto found = find_overlap(lens)) {
                row = &row_of(static_cast<std::size_t>(found->first));
                what = "crosses surface " + std::to_string(row_of(static_cast<std::size_t>(found->second)).number) +
                       ", by " + lens_checks_detail::short_mm(found->depth) + " at " +
                       lens_checks_detail::short_mm(found->radius) + " from the axis";
            } else if (film_crosses_lens(lens)) {
                row = &row_of(kept_.size() - 1);
                what = "is cut by the film";
            }
            if (!row) continue;
            if (!lens_.zoom.positions.empty())
                what += " in zoom position \"" + lens.zoom.positions[static_cast<std::size_t>(i)].name + '"';
            if (!options_.force && !passes_inside_crossings(lens, static_cast<std::size_t>(i))) {
                LensReadError error(what + "; nobody can make such a lens", p_.file, row->line, row->number);
                error.can_be_forced = true;
                throw error;
            }
            warn("surface " + std::to_string(row->number) + ' ' + what +
                 (options_.force ? "" : "; no ray of the file's fields that passes the lens reaches that far"));
            is_crossed = true;
        }
        return is_crossed;
    }

    /// True if no ray of the fields that passes the lens reaches two faces where they cross.
    bool passes_inside_crossings(LensSystem lens, std::size_t state) {
        if (!lens_.is_rotational() || film_crosses_lens(lens)) return false;
        const RayRims reach =
            reach_of_rays(lens, states_[state].object_distance, p_.field_kind, p_.fields, checkpoint_);
        for (std::size_t i = 0; i < kept_.size(); ++i)
            if (reach.semi_diameters[i] > 0)
                lens.surfaces[i].clear_semi_diameter =
                    std::min(lens.surfaces[i].clear_semi_diameter, reach.semi_diameters[i]);
        return !find_overlap(lens);
    }

    const Prescription& p_;
    const LensReadOptions& options_;
    std::vector<ForeignFeature> foreign_;
    std::vector<KeptRow> kept_;
    LensSystem lens_;
    std::vector<LensState> states_;
    std::vector<SurfaceForm> forms_;
    int stop_on_surface_ = 0;
    std::set<int> curved_planes_;
    Checkpoint checkpoint_;
    static constexpr std::size_t kWorkOfLens = 1 << 14;  // checkpoint work of an operation on a whole lens
};

}  // namespace

LensSystem lens_from(Prescription prescription, const LensReadOptions& options) {
    std::vector<PrescriptionSurface>& rows = prescription.surfaces;
    if (!rows.empty() && std::ranges::none_of(rows, [](const PrescriptionSurface& row) { return row.is_stop; })) {
        rows.front().is_stop = true;
        prescription.remarks.push_back("it names no aperture stop: surface " + std::to_string(rows.front().number) +
                                       " is taken");
    }
    try {
        return Builder(prescription, options).build();
    } catch (const InputError& error) {  // a glass without an index, or a field that no ray reaches
        throw LensReadError(error, prescription.file);
    }
}

}  // namespace realcam::io
