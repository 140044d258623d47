#include "tolerance_evaluator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "../../math/hypotenuse.hpp"
#include "../lens/paraxial.hpp"
#include "film_setting.hpp"
#include "lens_error.hpp"

namespace realcam {

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kSmallField = 1e-3;  ///< rad: so near the axis that distortion is negligible
constexpr double kCloseRays = 1e-3;  ///< ray height as a fraction of the entrance pupil diameter

double angle_of(Vec2<double> field) {
    return hypotenuse(field.x, field.y);
}

/// Unit vector from the axis towards a field; along y for the field on the axis.
Vec2<double> outwards(Vec2<double> field) {
    const double angle = angle_of(field);
    return angle > 0 ? Vec2<double>{field.x / angle, field.y / angle} : Vec2<double>{0, 1};
}

/// Returns by how much rays parallel to the axis at this distance from it converge: their change of slope per mm, the
/// mean of both meridians. For centred and nearly centred lenses this is the power up to its sign.
double convergence(const CopyPath::At& path, double distance) {
    LensRays<double, 4> rays;
    for (int i = 0; i < 4; ++i) {
        const double h = i % 2 ? -distance : distance;
        rays.origin.set(i, i < 2 ? Vec3d{h, 0, 0} : Vec3d{0, h, 0});
        rays.direction.set(i, {0, 0, path.entry_index});
        rays.status[i] = 0;
    }
    trace_lens(path.view, rays);
    const auto slope = [&](int i) {
        const Vec3d d = rays.direction[i];
        return (i < 2 ? d.x : d.y) / d.z;
    };
    return 0.25 * (slope(0) - slope(1) + slope(2) - slope(3)) / distance;
}

}  // namespace

LensSystem with_settings(const LensSystem& lens, const CopySettings& settings, const Compensators& compensators) {
    LensSystem result = lens;
    if (compensators.shift && !(settings.element_shift == Vec3d{0, 0, 0}))
        move_pieces(result, compensators.shift->first, compensators.shift->last,
                    Affine<double>{.origin = settings.element_shift});
    result.film_distance += settings.film_shift;
    for (ZoomPosition& position : result.zoom.positions) position.film_distance += settings.film_shift;
    constexpr double kDegree = std::numbers::pi / 180;
    result.film_placement.tilt_deg.x += std::atan(settings.film_slope.y) / kDegree;
    result.film_placement.tilt_deg.y -= std::atan(settings.film_slope.x) / kDegree;
    return result;
}

struct ToleranceEvaluator::Parts {
    LensSystem nominal;
    StudyRequest request;
    std::vector<double> wavelengths;
    std::size_t main = 0;  ///< index of the colour nearest to the design wavelength
    std::vector<Vec2<double>> towards;  ///< for each field: unit vector away from the axis
    std::vector<FieldFan> fans;  ///< for each field, then for each colour
    std::vector<FieldFan> middle;  ///< fans of small fields to the right, left, top and bottom
    std::vector<double> film;  ///< film position at each field before compensation, mm behind the last vertex
    int stop;
    double focal_length, close, convergence_drawn;
    double index;  ///< refractive index behind the lens

    std::vector<FieldSpot> spots(const CopyPath& path, double film_shift) const {
        const std::size_t colours = wavelengths.size();
        std::vector<FieldSpot> all(request.fields.size());
        for (std::size_t f = 0; f < all.size(); ++f) {
            FieldSpot& spot = all[f];
            spot.film = film[f] + film_shift;
            spot.index = index;
            double passing = 0, sent = 0;
            for (std::size_t c = 0; c < colours; ++c) {
                FieldFan::Traced traced = fans[f * colours + c].through(path.at(c), stop);
                if (c == main) spot.chief = traced.chief;
                for (FieldFan::FilmRay& ray : traced.rays) {
                    ray.weight *= request.colours[c].weight;
                    if (!(ray.weight > 0)) continue;
                    passing += ray.weight;
                    spot.rays.push_back(ray);
                }
                sent += request.colours[c].weight * fans[f * colours + c].full_weight();
            }
            for (FieldFan::FilmRay& ray : spot.rays) ray.weight /= passing;
            spot.light = passing / sent;
        }
        return all;
    }

    /// Evaluation of a copy at one shift of its compensating element.
    struct Look {
        CopyPath path;
        std::vector<FieldSpot> spots;
        FilmSetting film;
        double blur;  ///< merit that compensators minimise: a mean square radius, or 1 - mean contrast
    };

    Look look(const LensSystem& copy, Vec3d shift) const {
        Look result{CopyPath(with_settings(copy, {0, {0, 0}, shift}, request.compensators), wavelengths), {}, {}, 0};
        result.spots = spots(result.path, copy.film_distance - nominal.film_distance);
        const FilmFreedom freedom{request.compensators.refocus, request.compensators.film_tilt};
        if (const std::optional<double> frequency = request.compensators.frequency) {
            result.film = film_of_high_contrast(result.spots, towards, *frequency, freedom);
            if (request.compensators.shift)
                result.blur = 1 - mean_contrast(result.spots, towards, *frequency, result.film);
        } else {
            result.film = film_of_small_spots(result.spots, freedom);
            result.blur = mean_square(result.spots, result.film);
        }
        return result;
    }

    /// Minimises the blur over the element shift: the vertex of a parabola through three evaluations, in each direction
    /// in turn, with decreasing steps.
    Look sharpest(const LensSystem& copy, Vec3d& shift) const {
        Look best = look(copy, shift);
        if (!request.compensators.shift) return best;
        const ElementShift& how = *request.compensators.shift;
        std::vector<double Vec3d::*> directions{&Vec3d::z};
        if (!how.along_axis) directions = {&Vec3d::x, &Vec3d::y};
        double step = how.range / 4;
        for (int sweep = 0; sweep < 3; ++sweep, step /= 4)
            for (double Vec3d::* direction : directions) {
                Vec3d less = shift, more = shift, at = shift;
                less.*direction -= step;
                more.*direction += step;
                const double below = look(copy, less).blur, above = look(copy, more).blur;
                const double bend = below + above - 2 * best.blur;
                if (!(bend > 0)) continue;
                at.*direction =
                    std::clamp(shift.*direction + 0.5 * step * (below - above) / bend, -how.range, how.range);
                Look next = look(copy, at);
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
    const auto distance = [&](const StudyColour& colour) {
        return std::fabs(colour.wavelength_nm - nominal.wavelength_nm);
    };
    for (const StudyColour& colour : p.request.colours) p.wavelengths.push_back(colour.wavelength_nm);
    for (std::size_t c = 0; c < p.request.colours.size(); ++c)
        if (distance(p.request.colours[c]) < distance(p.request.colours[p.main])) p.main = c;
    const double main_nm = p.request.colours[p.main].wavelength_nm;
    const auto field = [&](double angle) { return FieldPoint{angle, p.request.object_distance}; };
    for (const Vec2<double> at : p.request.fields) {
        const Vec2<double> towards = outwards(at);
        p.towards.push_back(towards);
        for (const StudyColour& colour : p.request.colours)
            p.fans.emplace_back(nominal, colour.wavelength_nm, field(angle_of(at)), towards.x, towards.y,
                                p.request.rings, loop);
    }
    for (const Vec2<double> towards : {Vec2<double>{1, 0}, {-1, 0}, {0, 1}, {0, -1}})
        p.middle.emplace_back(nominal, main_nm, field(kSmallField), towards.x, towards.y, 1, loop);
    const FirstOrder first = first_order(nominal, main_nm);
    p.focal_length = first.effective_focal_length;
    p.index = nominal.indices(main_nm).back();
    p.close = kCloseRays * first.entrance_pupil_diameter;
    p.film.assign(p.request.fields.size(), nominal.film_distance);
    const CopyPath path(nominal, p.wavelengths);
    p.convergence_drawn = convergence(path.at(p.main), p.close);
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
    const Parts::Look look = p.sharpest(copy, shift);
    result.settings = {look.film.shift, look.film.slope, shift};
    const CopyPath::At path = look.path.at(p.main);
    result.focal_length = std::isfinite(p.focal_length)
                              ? p.focal_length * p.convergence_drawn / convergence(path, p.close)
                              : p.focal_length;
    // Image scale near the axis, and image centre.
    Vec2<double> points[4], middle{0, 0};
    const double film = copy.film_distance + look.film.shift;
    for (std::size_t k = 0; k < 4; ++k) {
        const FieldFan::FilmRay chief = p.middle[k].through(path, p.stop, false).chief;
        points[k] = {chief.at.x + film * chief.slope.x, chief.at.y + film * chief.slope.y};
        middle = {middle.x + 0.25 * points[k].x, middle.y + 0.25 * points[k].y};
    }
    const double scale = 0.25 *
                         (hypotenuse(points[0].x - points[1].x, points[0].y - points[1].y) +
                          hypotenuse(points[2].x - points[3].x, points[2].y - points[3].y)) /
                         std::tan(kSmallField);
    for (std::size_t f = 0; f < look.spots.size(); ++f) {
        const FieldSpot& spot = look.spots[f];
        const double z = look.film.at(spot.chief_at(0));
        const Vec2<double> at = spot.chief_at(z), along = p.towards[f];
        const double angle = angle_of(p.request.fields[f]);
        const double ideal = scale * std::tan(angle), found = hypotenuse(at.x - middle.x, at.y - middle.y);
        const FieldSpot::Square square = spot.square();
        FieldFigures figures{kNone, angle > 0 ? found / ideal - 1 : 0.0, spot.light, at, {}};
        if (!spot.rays.empty())
            figures.rms_spot = std::sqrt(std::max(0.0, square.a + (2 * square.b + square.c * z) * z));
        for (const Vec2<double> direction : {along, Vec2<double>{-along.y, along.x}})
            for (const double frequency : p.request.frequencies)
                figures.mtf.push_back(spot.rays.empty() ? kNone
                                                        : spot.contrast(z, direction, frequency) *
                                                              spot.limit(direction, frequency, p.request.colours));
        result.fields.push_back(std::move(figures));
    }
    return result;
}

}  // namespace realcam
