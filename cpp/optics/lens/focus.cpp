#include "focus.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "../../math/root.hpp"
#include "../prescription/clearance.hpp"
#include "../prescription/lens_checks.hpp"
#include "best_focus.hpp"
#include "focus_error.hpp"
#include "paraxial.hpp"

namespace realcam {

namespace {

/// Formats a length in metres, with enough digits to distinguish it from the length `other`, mm.
std::string metres(double mm, double other = kInfinity) {
    char text[40], other_text[40];
    for (int digits = 3; digits <= 17; ++digits) {
        std::snprintf(text, sizeof text, "%.*g m", digits, mm / 1000);
        std::snprintf(other_text, sizeof other_text, "%.*g m", digits, other / 1000);
        if (std::string(text) != other_text) break;
    }
    return text;
}

/// Returns the lens with its focusing group moved towards the film by `shift`, mm.
LensSystem with_group_moved(LensSystem lens, double shift) {
    const auto first = static_cast<std::size_t>(lens.focusing.group_first);
    const auto last = static_cast<std::size_t>(lens.focusing.group_last);
    if (first > 0) lens.surfaces[first - 1].thickness += shift;
    if (last + 1 < lens.surfaces.size()) {
        lens.surfaces[last].thickness -= shift;
    } else {
        lens.film_distance -= shift;
    }
    return lens;
}

/// Tolerance of the object plane of a focused lens, relative to the focus distance.
constexpr double kFocusTolerance = 1e-9;

/// Throws InputError: the lens cannot focus at this distance, mm. `reason` follows the lens's name in the message.
[[noreturn]] void fail(const LensSystem& lens, double focus_distance, const std::string& reason) {
    throw InputError("cannot focus at " + metres(focus_distance) + ": lens \"" + lens.name + "\" " + reason);
}

/// Tolerance of the sum of the lengths from object to film, relative to the focus distance.
constexpr double kRounding = 1e-14;

/// Returns the film distance at which the object plane lies `focus_distance` from the film, by the secant method;
/// std::nullopt if it does not converge to an object beyond `nearest`. There the image moves less than the object, by
/// the square of the magnification, so that the method needs two or three steps. `image_of`: returns the film distance
/// for the distance of an object from the front vertex; `length`: distance from the front to the last vertex. Lengths
/// in mm.
template <class ImageOf>
std::optional<double> image_by_secants(ImageOf&& image_of, double length, double focus_distance, double nearest) {
    constexpr int kMaxSteps = 8;
    // Start as if the film were at the last vertex.
    double object = focus_distance - length, previous_excess = 0, previous_object = 0;
    for (int i = 0; i < kMaxSteps && object > nearest; ++i) {
        const double image = image_of(object), excess = object + length + image - focus_distance;
        if (!(image >= 0)) break;
        if (std::fabs(excess) <= kRounding * focus_distance) return image;
        const double slope = i == 0 ? 1 : (excess - previous_excess) / (object - previous_object);
        if (!(slope > 0.5)) break;
        previous_excess = excess;
        previous_object = object;
        object -= excess / slope;
    }
    return {};
}

/// Returns the lens focused by moving it as a whole relative to the film. The distance from object to film, by real
/// rays, has its minimum near magnification -1; the branch of more distant objects is the photographic one.
LensSystem focused_as_a_whole(LensSystem lens, double focus_distance) {
    // Film distance for an object at this distance from the front vertex.
    const auto image_of = [&](double object) { return best_focus_distance(lens, lens.wavelength_nm, object); };
    if (std::isinf(focus_distance)) {
        lens.film_distance = image_of(kInfinity);
        return lens;
    }
    const double length = lens.last_vertex();
    // Distance from this object to its image, minus the required one.
    const auto excess = [&](double object) { return object + length + image_of(object) - focus_distance; };
    // Paraxially s = -ffd + f / |m|, so m = -1 lies at s = f - ffd. That is inside the lens if the front focal point
    // lies deep in it, as in a fisheye: hence the limit of 0.
    const FirstOrder data = first_order(lens, lens.wavelength_nm);
    double near = std::max(0.0, std::fabs(data.effective_focal_length) - data.front_focal_distance);
    if (const std::optional<double> image = image_by_secants(image_of, length, focus_distance, near)) {
        lens.film_distance = *image;
        return lens;
    }
    const double far =
        focus_distance - length;  // an object whose distance to its image exceeds focus_distance by the image distance
    double excess_near = excess(near);
    // If no ray of a very near object passes the lens, move the object away until some do.
    for (int i = 30; i > 0 && std::isnan(excess_near) && near < far; --i) {
        const double further = near + std::ldexp(far - near, -i);
        excess_near = excess(further);
        if (!std::isnan(excess_near)) near = further;
    }
    if (std::isnan(excess_near)) fail(lens, focus_distance, "lets no ray from there pass");
    if (excess_near > 0 || far < near) {
        const double nearest = focus_distance + excess_near;
        throw InputError("cannot focus at " + metres(focus_distance, nearest) +
                         ": the nearest object plane that lens \"" + lens.name + "\" can bring to a film is " +
                         metres(nearest, focus_distance) + " from it");
    }
    const double excess_far = excess(far);
    if (!(excess_far >= 0)) fail(lens, focus_distance, "makes no real image behind its last surface");
    const Root object = find_root(excess, near, excess_near, far, excess_far, kRounding * focus_distance);
    if (!(std::fabs(object.value) <= kFocusTolerance * focus_distance))
        fail(lens, focus_distance, "has no sharp image of that plane");
    lens.film_distance = image_of(object.at);
    return lens;
}

/// Returns the lens focused by moving the film along the last axis to the image, by the secant method. As the focus
/// distance counts from the film, the image itself then moves by the square of the magnification, which is taken as 0
/// in the first step.
LensSystem focused_by_film(LensSystem lens, double focus_distance) {
    const double start = lens.film_distance, ahead = std::copysign(1.0, start);  // direction of the light there
    const double tolerance = 1e-12 * std::max(std::fabs(lens.film_position()), 1.0);
    double previous_error = 0, previous_distance = start;
    constexpr int kMaxSteps = 60;
    for (int i = 0; i < kMaxSteps; ++i) {
        const double error = focus_error(lens, focus_distance);
        if (std::fabs(error) <= tolerance) return lens;
        if (!std::isfinite(error)) break;
        const double slope = i == 0 ? -1 : ahead * (error - previous_error) / (lens.film_distance - previous_distance);
        previous_error = error;
        previous_distance = lens.film_distance;
        // The slope is near -1 unless the image belongs to another plane or does not exist: then the step is half the
        // error.
        lens.film_distance += ahead * (slope < -0.1 && slope > -3 ? -error / slope : 0.5 * error);
        if (!(std::fabs(lens.film_distance - start) < kLongest)) break;
    }
    fail(lens, focus_distance, "has no film position at which that plane is sharp at the film's centre");
}

/// Returns the lens focused by moving its focusing group.
LensSystem focused_by_group(const LensSystem& lens, double focus_distance) {
    const auto error = [&](double shift) { return focus_error(with_group_moved(lens, shift), focus_distance); };
    const auto& s = lens.surfaces;
    const auto first = static_cast<std::size_t>(lens.focusing.group_first);
    const auto last = static_cast<std::size_t>(lens.focusing.group_last);
    // How far the group can move away from the film, and towards it.
    const double away = first > 0 ? s[first - 1].thickness : lens.last_vertex();
    const double towards = last + 1 < s.size() ? s[last].thickness : lens.film_distance;
    const double start = error(0), tolerance = kFocusTolerance * std::fabs(lens.film_position());
    if (start == 0) return lens;
    std::optional<FaceOverlap> overlap;
    // The nearest root is the right one: some groups also image the plane at a second, distant position, at which the
    // focal length differs much. The search therefore proceeds outwards on both sides, by distance. A sign change at
    // which the image passes through infinity, or the last ray is blocked, is not a root.
    constexpr int kSteps = 200;
    // Search on one side: length of a step, error at the end of the last step, index of the next step.
    struct Side {
        double step, inner_error;
        int next = 1;
        double distance() const { return next > kSteps ? kInfinity : std::fabs(step * next); }
    };
    Side sides[2] = {{-away / kSteps, start}, {towards / kSteps, start}};
    for (int i = 0; i < 2 * kSteps; ++i) {
        Side& side = sides[sides[1].distance() < sides[0].distance()];
        const double from = side.step * (side.next - 1), to = side.step * side.next, outer_error = error(to);
        ++side.next;
        if (std::isfinite(side.inner_error) && std::isfinite(outer_error) &&
            (side.inner_error > 0) != (outer_error > 0)) {
            const Root shift = find_root(error, from, side.inner_error, to, outer_error, 1e-5 * tolerance);
            if (std::fabs(shift.value) <= tolerance) {
                LensSystem moved = with_group_moved(lens, shift.at);
                if (!lens.allow_overlap) overlap = find_overlap(moved);
                if (!overlap) return moved;
            }
        }
        side.inner_error = outer_error;
    }
    if (overlap)
        fail(lens, focus_distance,
             "would have to move its focusing group so far that surfaces " + std::to_string(overlap->first + 1) +
                 " and " + std::to_string(overlap->second + 1) + " overlap");
    throw InputError("cannot focus at " + metres(focus_distance) + ": no position of the focusing group of lens \"" +
                     lens.name + "\" (surfaces " + std::to_string(first + 1) + " to " + std::to_string(last + 1) +
                     ") images it on the film");
}

}  // namespace

LensSystem focused(const LensSystem& lens, double focus_distance) {
    if (!(focus_distance > 0))
        throw InputError("the focus distance is " + metres(focus_distance) + "; expected a positive distance or inf");
    if (focus_distance < lens.focusing.nearest_mm)
        throw InputError("cannot focus at " + metres(focus_distance, lens.focusing.nearest_mm) +
                         ": the nearest focus of lens \"" + lens.name + "\" is " +
                         metres(lens.focusing.nearest_mm, focus_distance));
    if (first_order(lens, lens.wavelength_nm).is_afocal() && !lens.focusing.moves_group())
        throw InputError("cannot focus lens \"" + lens.name + "\": it is afocal, parallel light leaves it parallel");
    LensSystem open = lens;
    open.stop_semi_diameter = lens.stop().clear_semi_diameter;
    LensSystem result = open.focusing.moves_group() ? focused_by_group(open, focus_distance)
                        : open.is_rotational()      ? focused_as_a_whole(open, focus_distance)
                                                    : focused_by_film(open, focus_distance);
    result.stop_semi_diameter = lens.stop_semi_diameter;
    result.focus_distance = focus_distance;
    if (!std::isfinite(result.film_distance))
        throw InputError("cannot focus lens \"" + lens.name + "\": no ray from the object passes it");
    if (!(result.film_distance > 0) && lens.is_rotational())
        throw InputError("cannot focus lens \"" + lens.name + "\": it makes no real image behind its last surface");
    if (const std::string why = film_distance_error(result); !why.empty())
        fail(lens, focus_distance, "would need an impossible film distance: " + why);
    return result;
}

std::optional<double> film_distance_at_infinity(LensSystem lens) {
    if (lens.is_rotational()) {
        const double distance = best_focus_distance(lens, lens.wavelength_nm, kInfinity);
        return distance > 0 ? std::optional(distance) : std::nullopt;
    }
    // Start with the paraxial focus of the centred lens.
    lens.film_distance = first_order(centred(lens), lens.wavelength_nm).back_focal_distance;
    if (!std::isfinite(lens.film_distance) || lens.film_distance == 0) return {};
    try {
        return focused_by_film(lens, kInfinity).film_distance;
    } catch (const InputError&) {
        return {};
    }
}

double f_number_at_infinity(const LensSystem& lens) {
    if (lens.focusing.moves_group() && std::isfinite(lens.focus_distance)) {
        try {
            return first_order(focused(lens, kInfinity), lens.wavelength_nm).f_number;
        } catch (const InputError&) {  // no position of the group images infinity on the film
        }
    }
    return first_order(lens, lens.wavelength_nm).f_number;
}

LensSystem stopped_down(LensSystem lens, double f_number) {
    const double full = lens.stop().clear_semi_diameter;
    lens.stop_semi_diameter = full;
    const double fastest = f_number_at_infinity(lens);
    if (!(f_number > 0) || !std::isfinite(f_number))
        throw InputError("the f-number is " + std::to_string(f_number) + "; expected a positive number");
    if (!(fastest > 0) || !std::isfinite(fastest))
        throw InputError("lens \"" + lens.name + "\" has no f-number: " +
                         (first_order(lens, lens.wavelength_nm).is_afocal()
                              ? "it is afocal, parallel light leaves it parallel"
                              : "its entrance pupil lies at infinity"));
    if (f_number < (1 - kEngravingError) * fastest) {
        char text[160];
        std::snprintf(text, sizeof text, "f/%.4g is faster than lens \"%s\", which opens to f/%.4g", f_number,
                      lens.name.c_str(), fastest);
        throw InputError(text);
    }
    lens.stop_semi_diameter = full * std::min(1.0, fastest / f_number);
    return lens;
}

}  // namespace realcam
