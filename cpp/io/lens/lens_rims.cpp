#include "lens_rims.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "../../math/hypotenuse.hpp"
#include "../../optics/analysis/field_rays.hpp"
#include "../../optics/analysis/ray_aiming.hpp"
#include "../../optics/analysis/trace_path.hpp"
#include "../../optics/lens/paraxial.hpp"

namespace realcam::io {
namespace {

/// Factor for the semi-diameters, so that rounding does not block the ray at the edge.
constexpr double kMargin = 1 + 1e-9;

/// Distance of a field point from the axis, in degrees or mm.
double field_size(const PrescriptionField& field) {
    return hypotenuse(field.x, field.y);
}

/// Returns the lens with semi-diameters so large that rims block no ray that the surfaces refract. Those of aspheres
/// are not much larger than the paraxial rays, because intersections are searched only within them. `largest_angle`: of
/// the fields, in radians.
LensSystem with_unlimiting_rims(LensSystem lens, double largest_angle) {
    const FirstOrder data = first_order(lens, lens.wavelength_nm);
    const int count = static_cast<int>(lens.surfaces.size());
    const double pupil = 0.5 * data.entrance_pupil_diameter;
    constexpr double kMaxAngle = 1.2;  // radians; the slope of wider fields would be too large for first-order optics
    const double slope = std::tan(std::min(std::fabs(largest_angle), kMaxAngle));
    for (int i = 0; i < count; ++i) {
        Surface& s = lens.surfaces[static_cast<std::size_t>(i)];
        if (s.type == SurfaceType::stop) continue;
        const double marginal = trace_paraxial(lens, lens.wavelength_nm, {pupil, 0}, 0, i + 1).height;
        const double chief =
            trace_paraxial(lens, lens.wavelength_nm, {-slope * data.entrance_pupil_position, slope}, 0, i + 1).height;
        // Twice the paraxial height allows for aberrations.
        double rim = 2 * (std::fabs(marginal) + std::fabs(chief)) + 1e-3 * pupil;
        if (!std::isfinite(rim) || !s.is_asphere()) rim = std::max(rim, 1e3 * (pupil + lens.last_vertex()));
        constexpr double kUnlimited_mm = 1e6;
        if (!std::isfinite(rim)) rim = kUnlimited_mm;
        // A conic ends at r = 1 / sqrt((1 + k) c^2).
        const double inverse_square = (1 + s.conic) * s.curvature * s.curvature;
        if (inverse_square > 0) rim = std::min(rim, (1 - 1e-9) / std::sqrt(inverse_square));
        s.clear_semi_diameter = std::max(rim, kShortestRadius);
        s.inner_semi_diameter = 0;
    }
    return lens;
}

/// Traces ray bundles of one field after the other through points of the stop, and records the greatest ray height at
/// each surface.
class FieldBundles {
public:
    /// `object_distance`: to the front vertex, mm. `largest`: size of the largest field, in the unit of `kind`.
    /// `only_passing`: record only rays that pass the rims of the lens.
    FieldBundles(const LensSystem& lens, double object_distance, FieldKind kind, double largest, bool only_passing,
                 Checkpoint& checkpoint)
        : lens_(lens),
          unlimited_lens_(with_unlimiting_rims(lens, field_angle_of(lens, object_distance, kind, largest))),
          object_distance_(object_distance),
          kind_(kind),
          checkpoint_(checkpoint),
          result_{std::vector<double>(lens.surfaces.size(), 0.0)} {
        for (int i = 0; i < count(); ++i)
            paths_to_surfaces_.emplace_back(unlimited_lens_, LightDirection::to_film, lens.wavelength_nm, i + 1);
        if (only_passing) whole_lens_path_.emplace(lens, LightDirection::to_film, lens.wavelength_nm, count());
    }

    /// Traces the bundle of a field of this size through points of the stop, in mm.
    void add(double field, const std::vector<Vec2<double>>& targets) {
        try {
            const RayAimer aim(unlimited_lens_, lens_.wavelength_nm,
                               {field_angle_of(lens_, object_distance_, kind_, field), object_distance_});
            for (const Vec2<double> target : targets) {
                checkpoint_.pass(1000 * lens_.surfaces.size());
                const AimedRay ray = aim(target);
                if (ray.status == RayStatus::ok)
                    add(aim.object.at(ray.entry), aim.object.direction(ray.entry));
                else
                    result_.all_rays_pass = false;
            }
        } catch (const InputError&) {  // there is no chief ray
            result_.all_rays_pass = false;
        }
    }

    const RayHeights& result() const { return result_; }

private:
    int count() const { return static_cast<int>(lens_.surfaces.size()); }

    /// Traces one ray and records its heights. `from`: origin, `to`: direction.
    void add(Vec3d from, Vec3d to) {
        const double origin[3] = {from.x, from.y, from.z}, direction[3] = {to.x, to.y, to.z};
        double at[3], out[3], length;
        int status, surface;
        const auto passes = [&](const TracePath<double>& path) {
            trace_ray_block<1>(path.request(1, origin, direction, {at, out, &length, &status, &surface}), 0);
            return status == 0;
        };
        if (whole_lens_path_ && !passes(*whole_lens_path_)) return;
        for (std::size_t i = 0; i < paths_to_surfaces_.size() && passes(paths_to_surfaces_[i]); ++i)
            result_.semi_diameters[i] = std::max(result_.semi_diameters[i], kMargin * hypotenuse(at[0], at[1]));
    }

    const LensSystem& lens_;
    LensSystem unlimited_lens_;  ///< see with_unlimiting_rims
    double object_distance_;
    FieldKind kind_;
    Checkpoint& checkpoint_;
    RayHeights result_;
    std::vector<TracePath<double>> paths_to_surfaces_;  ///< from the object through each surface
    std::optional<TracePath<double>> whole_lens_path_;  ///< with the lens's rims; std::nullopt: all rays are recorded
};

/// Greatest field_size; 0 without fields.
double largest_field(const std::vector<PrescriptionField>& fields) {
    double largest = 0;
    for (const PrescriptionField& field : fields) largest = std::max(largest, field_size(field));
    return largest;
}

}  // namespace

double field_angle_of(const LensSystem& lens, double object_distance, FieldKind kind, double size) {
    if (kind == FieldKind::angle_deg) return size * std::numbers::pi / 180;
    const FirstOrder data = first_order(lens, lens.wavelength_nm);
    const double to_pupil = object_distance + data.entrance_pupil_position;
    if (kind == FieldKind::object_height) return std::atan(size / to_pupil);
    if (std::isinf(object_distance)) return std::atan(size / std::fabs(data.effective_focal_length));
    // The magnification of the object plane is n u of the marginal ray before the lens over that after it.
    const ParaxialRay end =
        trace_paraxial(lens, lens.wavelength_nm, {object_distance, 1}, 0, static_cast<int>(lens.surfaces.size()));
    return std::atan(std::fabs(size * data.image_index * end.slope / to_pupil));
}

RayHeights required_semi_diameters(const LensSystem& lens, double object_distance, FieldKind kind,
                                   const std::vector<PrescriptionField>& fields, Checkpoint& checkpoint) {
    FieldBundles bundles(lens, object_distance, kind, largest_field(fields), false, checkpoint);
    std::vector<PrescriptionField> all{{}};
    all.insert(all.end(), fields.begin(), fields.end());
    for (const PrescriptionField& field : all) {
        // Here y is along the direction of the field.
        const bool along_x = std::fabs(field.x) > std::fabs(field.y);
        const double across = along_x ? field.upper_y : field.upper_x;
        const double up = along_x ? field.upper_x : field.upper_y, down = along_x ? field.lower_x : field.lower_y;
        const double r = lens.stop_semi_diameter;
        bundles.add(field_size(field),
                    {{0, 0}, {r * (1 - across), 0}, {0, r * (1 - up)}, {0, -r * (1 - down)}, {-r * (1 - across), 0}});
    }
    return bundles.result();
}

RayHeights passing_ray_heights(const LensSystem& lens, double object_distance, FieldKind kind,
                               const std::vector<PrescriptionField>& fields, Checkpoint& checkpoint) {
    constexpr int kFields = 12, kTargets = 24;  // rims vignette bundles between the axis and the edge of the stop
    const double largest = largest_field(fields);
    FieldBundles bundles(lens, object_distance, kind, largest, true, checkpoint);
    std::vector<Vec2<double>> targets;
    for (int i = -kTargets; i <= kTargets; ++i) {
        const double at = lens.stop_semi_diameter * i / kTargets;
        targets.push_back({0, at});
        if (i > 0) targets.push_back({at, 0});
    }
    for (int k = 0; k <= kFields; ++k) bundles.add(largest * k / kFields, targets);
    return bundles.result();
}

double largest_image_height(const LensSystem& lens, double object_distance, FieldKind kind,
                            const std::vector<PrescriptionField>& fields) {
    const double largest = largest_field(fields);
    if (largest == 0 || kind == FieldKind::image_height) return largest;
    const double angle = field_angle_of(lens, object_distance, kind, largest);
    try {
        const LensSystem unlimited_lens = with_unlimiting_rims(lens, angle);
        const AimedRay chief = RayAimer(unlimited_lens, lens.wavelength_nm, {angle, object_distance}).chief_ray();
        if (chief.status == RayStatus::ok) {
            const FilmSurface<double> film{lens.film_distance, 1 / lens.film_radius_of_curvature};
            const double height = std::fabs(film.landing(chief.origin, chief.direction).y);
            if (std::isfinite(height)) return height;
        }
    } catch (const InputError&) {
        // Falls back to first-order optics.
    }
    const FirstOrder data = first_order(lens, lens.wavelength_nm);
    return std::fabs(data.effective_focal_length * std::tan(std::min(angle, 1.2)));
}

}  // namespace realcam::io
