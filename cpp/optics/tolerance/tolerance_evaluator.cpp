#include "tolerance_evaluator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "../../math/hypotenuse.hpp"
#include "../lens/paraxial.hpp"
#include "film_setting.hpp"
#include "perturbation.hpp"

namespace realcam {

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kParaxialAngle = 1e-3;  ///< field angle at which distortion is negligible, rad
/// Ray height at which aberrations are negligible, in entrance pupil diameters.
constexpr double kParaxialHeight = 1e-3;

/// Returns the field angle of a StudyRequest's field, rad.
double angle_of(Vec2<double> field) {
    return hypotenuse(field.x, field.y);
}

/// Returns the unit vector from the axis towards a field; along y for the field on the axis.
Vec2<double> outward_direction(Vec2<double> field) {
    const double angle = angle_of(field);
    return angle > 0 ? Vec2<double>{field.x / angle, field.y / angle} : Vec2<double>{0, 1};
}

/// Returns the convergence of rays that are parallel to the axis at this height: their change of slope per mm of
/// height, the mean of both meridians. For centred and nearly centred lenses it is the optical power, up to its sign.
double convergence(const CopyPath::WavelengthView& path, double height) {
    LensRays<double, 4> rays;
    for (int i = 0; i < 4; ++i) {
        const double h = i % 2 ? -height : height;
        rays.origin.set(i, i < 2 ? Vec3d{h, 0, 0} : Vec3d{0, h, 0});
        rays.direction.set(i, {0, 0, path.entry_index});
        rays.status[i] = 0;
    }
    trace_lens(path.view, rays);
    const auto slope = [&](int i) {
        const Vec3d d = rays.direction[i];
        return (i < 2 ? d.x : d.y) / d.z;
    };
    return 0.25 * (slope(0) - slope(1) + slope(2) - slope(3)) / height;
}

}  // namespace

LensSystem with_settings(const LensSystem& lens, const CopySettings& settings, const Compensators& compensators) {
    LensSystem result = lens;
    if (compensators.shift && !(settings.element_shift == Vec3d{0, 0, 0}))
        move_rigidly(result, compensators.shift->first, compensators.shift->last,
                     Affine<double>{.origin = settings.element_shift});
    result.film_distance += settings.film_shift;
    for (ZoomPosition& position : result.zoom.positions) position.film_distance += settings.film_shift;
    result.film_placement.tilt_deg.x += std::atan(settings.film_slope.y) / kDegree;
    result.film_placement.tilt_deg.y -= std::atan(settings.film_slope.x) / kDegree;
    return result;
}

/// Data and algorithms of the evaluator.
struct ToleranceEvaluator::Parts {
    LensSystem nominal;
    StudyRequest request;
    std::vector<double> wavelengths;
    std::size_t main_colour = 0;  ///< index of the colour nearest to the design wavelength
    std::vector<Vec2<double>> outwards;  ///< for each field: unit vector away from the axis
    std::vector<FieldFan> fans;  ///< for each field, then for each colour
    std::vector<FieldFan> paraxial_fans;  ///< fans of small fields to the right, left, top and bottom
    std::vector<double> film;  ///< film position at each field before compensation, mm behind the last vertex
    int stop;
    double focal_length;  ///< focal length of the nominal lens, mm
    double ray_height;  ///< height of the rays for `convergence`, mm
    double nominal_convergence;  ///< `convergence` of the nominal lens, 1/mm
    double index;  ///< refractive index behind the lens

    /// Traces the rays of all fields through a copy. `film_shift`: displacement of the copy's film from its nominal
    /// position, mm.
    std::vector<FieldSpot> spots(const CopyPath& path, double film_shift) const {
        const std::size_t colours = wavelengths.size();
        std::vector<FieldSpot> all(request.fields.size());
        for (std::size_t f = 0; f < all.size(); ++f) {
            FieldSpot& spot = all[f];
            spot.film = film[f] + film_shift;
            spot.index = index;
            double passing = 0, sent = 0;
            for (std::size_t c = 0; c < colours; ++c) {
                FieldFan::Traced traced = fans[f * colours + c].trace_copy(path.at(c), stop);
                if (c == main_colour) spot.chief = traced.chief;
                for (FieldFan::FilmRay& ray : traced.rays) {
                    ray.weight *= request.colours[c].weight;
                    if (!(ray.weight > 0)) continue;
                    passing += ray.weight;
                    spot.rays.push_back(ray);
                }
                sent += request.colours[c].weight * fans[f * colours + c].total_weight();
            }
            for (FieldFan::FilmRay& ray : spot.rays) ray.weight /= passing;
            spot.light = passing / sent;
        }
        return all;
    }

    /// Evaluation of a copy at one shift of its compensating element.
    struct Evaluation {
        CopyPath path;
        std::vector<FieldSpot> spots;
        FilmAdjustment film;
        double blur;  ///< merit that compensators minimise: a mean square radius, or 1 - mean contrast
    };

    /// Traces a copy at this displacement of its compensating element, and adjusts its film.
    Evaluation evaluate(const LensSystem& copy, Vec3d shift) const {
        Evaluation result{
            CopyPath(with_settings(copy, {0, {0, 0}, shift}, request.compensators), wavelengths), {}, {}, 0};
        result.spots = spots(result.path, copy.film_distance - nominal.film_distance);
        const FilmFreedom freedom{request.compensators.refocus, request.compensators.film_tilt};
        if (const std::optional<double> frequency = request.compensators.frequency) {
            result.film = film_for_high_contrast(result.spots, outwards, *frequency, freedom);
            if (request.compensators.shift)
                result.blur = 1 - mean_contrast(result.spots, outwards, *frequency, result.film);
        } else {
            result.film = film_for_small_spots(result.spots, freedom);
            result.blur = mean_square(result.spots, result.film);
        }
        return result;
    }

    /// Evaluates a copy at the displacement of its compensating element that minimises the blur, and sets `shift` to
    /// it. In each direction in turn, with decreasing steps, it moves to the vertex of a parabola through three
    /// evaluations.
    Evaluation with_best_shift(const LensSystem& copy, Vec3d& shift) const {
        Evaluation best = evaluate(copy, shift);
        if (!request.compensators.shift) return best;
        const ElementShift& compensator = *request.compensators.shift;
        std::vector<double Vec3d::*> directions{&Vec3d::z};
        if (!compensator.along_axis) directions = {&Vec3d::x, &Vec3d::y};
        double step = compensator.range / 4;
        for (int sweep = 0; sweep < 3; ++sweep, step /= 4)
            for (double Vec3d::* direction : directions) {
                Vec3d minus = shift, plus = shift, at = shift;
                minus.*direction -= step;
                plus.*direction += step;
                const double below = evaluate(copy, minus).blur, above = evaluate(copy, plus).blur;
                const double curvature = below + above - 2 * best.blur;
                if (!(curvature > 0)) continue;
                at.*direction = std::clamp(shift.*direction + 0.5 * step * (below - above) / curvature,
                                           -compensator.range, compensator.range);
                Evaluation next = evaluate(copy, at);
                if (next.blur < best.blur) {
                    best = std::move(next);
                    shift = at;
                }
            }
        return best;
    }
};

ToleranceEvaluator::ToleranceEvaluator(const LensSystem& nominal, StudyRequest request, const RayLoop& loop)
    : parts_(std::make_unique<Parts>()) {
    Parts& p = *parts_;
    p.nominal = nominal;
    p.request = std::move(request);
    p.stop = nominal.stop_index();
    const auto wavelength_offset = [&](const StudyColour& colour) {
        return std::fabs(colour.wavelength_nm - nominal.wavelength_nm);
    };
    for (const StudyColour& colour : p.request.colours) p.wavelengths.push_back(colour.wavelength_nm);
    for (std::size_t c = 0; c < p.request.colours.size(); ++c)
        if (wavelength_offset(p.request.colours[c]) < wavelength_offset(p.request.colours[p.main_colour]))
            p.main_colour = c;
    const double main_nm = p.request.colours[p.main_colour].wavelength_nm;
    const auto field = [&](double angle) { return FieldPoint{angle, p.request.object_distance}; };
    for (const Vec2<double> at : p.request.fields) {
        const Vec2<double> direction = outward_direction(at);
        p.outwards.push_back(direction);
        for (const StudyColour& colour : p.request.colours)
            p.fans.emplace_back(nominal, colour.wavelength_nm, field(angle_of(at)), direction.x, direction.y,
                                p.request.rings, loop);
    }
    for (const Vec2<double> direction : {Vec2<double>{1, 0}, {-1, 0}, {0, 1}, {0, -1}})
        p.paraxial_fans.emplace_back(nominal, main_nm, field(kParaxialAngle), direction.x, direction.y, 1, loop);
    const FirstOrder first = first_order(nominal, main_nm);
    p.focal_length = first.effective_focal_length;
    p.index = nominal.indices(main_nm).back();
    p.ray_height = kParaxialHeight * first.entrance_pupil_diameter;
    p.film.assign(p.request.fields.size(), nominal.film_distance);
    const CopyPath path(nominal, p.wavelengths);
    p.nominal_convergence = convergence(path.at(p.main_colour), p.ray_height);
    const std::vector<FieldSpot> spots = p.spots(path, 0);
    for (std::size_t f = 0; f < spots.size(); ++f) {
        if (spots[f].rays.empty())
            throw InputError("no light at a field angle of " +
                             object_point_detail::degrees(angle_of(p.request.fields[f])) + " passes lens \"" +
                             nominal.name + "\"");
        const double radius = nominal.film_radius_of_curvature;
        const Vec2<double> at = spots[f].chief_at(0);
        const double r2 = at.x * at.x + at.y * at.y;
        if (std::isfinite(radius)) p.film[f] += r2 / (radius + std::copysign(std::sqrt(radius * radius - r2), radius));
    }
}

ToleranceEvaluator::~ToleranceEvaluator() = default;
ToleranceEvaluator::ToleranceEvaluator(ToleranceEvaluator&&) noexcept = default;

const LensSystem& ToleranceEvaluator::nominal() const {
    return parts_->nominal;
}

const StudyRequest& ToleranceEvaluator::request() const {
    return parts_->request;
}

CopyFigures ToleranceEvaluator::operator()(const LensSystem& copy) const {
    const Parts& p = *parts_;
    CopyFigures result;
    Vec3d shift{0, 0, 0};
    const Parts::Evaluation evaluation = p.with_best_shift(copy, shift);
    result.settings = {evaluation.film.shift, evaluation.film.slope, shift};
    const CopyPath::WavelengthView path = evaluation.path.at(p.main_colour);
    result.focal_length = std::isfinite(p.focal_length)
                              ? p.focal_length * p.nominal_convergence / convergence(path, p.ray_height)
                              : p.focal_length;
    // Image scale near the axis, and image centre, from the chief rays of four small fields.
    Vec2<double> points[4], image_centre{0, 0};
    const double film = copy.film_distance + evaluation.film.shift;
    for (std::size_t k = 0; k < 4; ++k) {
        const FieldFan::FilmRay chief = p.paraxial_fans[k].trace_copy(path, p.stop, false).chief;
        points[k] = {chief.at.x + film * chief.slope.x, chief.at.y + film * chief.slope.y};
        image_centre = {image_centre.x + 0.25 * points[k].x, image_centre.y + 0.25 * points[k].y};
    }
    const double scale = 0.25 *
                         (hypotenuse(points[0].x - points[1].x, points[0].y - points[1].y) +
                          hypotenuse(points[2].x - points[3].x, points[2].y - points[3].y)) /
                         std::tan(kParaxialAngle);
    for (std::size_t f = 0; f < evaluation.spots.size(); ++f) {
        const FieldSpot& spot = evaluation.spots[f];
        const double z = evaluation.film.at(spot.chief_at(0));
        const Vec2<double> at = spot.chief_at(z), along = p.outwards[f];
        const double angle = angle_of(p.request.fields[f]);
        const double ideal = scale * std::tan(angle), actual = hypotenuse(at.x - image_centre.x, at.y - image_centre.y);
        const FieldSpot::MeanSquare square = spot.mean_square_radius();
        FieldFigures figures{kNone, angle > 0 ? actual / ideal - 1 : 0.0, spot.light, at, {}};
        if (!spot.rays.empty())
            figures.rms_spot = std::sqrt(std::max(0.0, square.a + (2 * square.b + square.c * z) * z));
        for (const Vec2<double> direction : {along, Vec2<double>{-along.y, along.x}})
            for (const double frequency : p.request.frequencies)
                figures.mtf.push_back(spot.rays.empty()
                                          ? kNone
                                          : spot.contrast(z, direction, frequency) *
                                                spot.diffraction_limit(direction, frequency, p.request.colours));
        result.fields.push_back(std::move(figures));
    }
    return result;
}

}  // namespace realcam
