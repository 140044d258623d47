#pragma once
#include <cmath>
#include <cstdio>

#include "lens_path.hpp"
#include "paraxial.hpp"

namespace REALCAM_NAMESPACE {

/// Last vertex to the film plane on which the real rays from an axial point make the smallest RMS spot, mm.
///
/// The rays fill the aperture evenly; x(z) = x0 + m z is straight behind the lens, so the plane of the least sum of
/// squares is z = -sum(x0 m) / sum(m^2). Returns NaN where no ray passes.
inline double best_focus_distance(const LensSystem& lens, double wavelength_nm, double object_distance) {
    constexpr int kRays = 256;
    const LensPath<double> path(lens, LightDirection::to_film, wavelength_nm);
    const FirstOrder data = first_order(lens, wavelength_nm);
    const double reach = 0.75 * data.entrance_pupil_diameter;  // past the paraxial rim: real pupils are larger at times
    LensRays<double, kRays> rays;
    for (int i = 0; i < kRays; ++i) {
        const double height = reach * std::sqrt((i + 0.5) / kRays);
        Vec3d origin{height, 0, 0}, direction{0, 0, 1};
        if (std::isfinite(object_distance)) {
            // From the axial point to the entrance pupil, begun at the front vertex: from an object kilometres away the
            // intersections would lose all their digits.
            const double to_pupil = object_distance + data.entrance_pupil_position;
            origin.x = height * object_distance / to_pupil;
            direction = normalized(Vec3d{height, 0, to_pupil});
        }
        rays.origin.set(i, origin);
        rays.direction.set(i, direction);
        rays.status[i] = 0;
    }
    PathRecord<double, kRays> record{};
    trace_lens(path.view(), rays, record);
    double cross = 0, square = 0;
    for (int i = 0; i < kRays; ++i) {
        if (rays.status[i] != 0) continue;
        const double slope = rays.direction.x[i] / rays.direction.z[i];
        cross += (rays.origin.x[i] - slope * rays.origin.z[i]) * slope;
        square += slope * slope;
    }
    return -cross / square;
}

namespace focus_detail {

inline std::string metres(double mm) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g m", mm / 1000);
    return text;
}

/// The lens with its focusing group moved towards the film.
inline LensSystem with_group_moved(LensSystem lens, double shift) {
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

/// Root of f by bisection; f(low) and f(high) have different signs.
template <class F>
double bisect(F&& f, double low, double high) {
    const bool rising = f(high) > 0;
    for (int i = 0; i < 200 && low != high; ++i) {
        const double middle = 0.5 * (low + high);
        if (middle == low || middle == high) break;
        ((f(middle) > 0) == rising ? high : low) = middle;
    }
    return 0.5 * (low + high);
}

/// Front vertex to the object plane, for a lens that moves as a whole, by the paraxial image.
/// The distance from object to film has its minimum at magnification -1; the far branch is the photographic one.
inline double paraxial_object_distance(const LensSystem& lens, double focus_distance) {
    const FirstOrder data = first_order(lens, lens.wavelength_nm);
    const double f = std::fabs(data.effective_focal_length);
    const auto object_to_film = [&](double s) {
        return s + lens.last_vertex() + paraxial_image_distance(lens, lens.wavelength_nm, s);
    };
    // s = -ffd + f / |m| and the image f |m| behind the rear focal point, so m = -1 lies at s = f - ffd; inside the
    // lens where the front focal point lies deep in it, as in a fisheye.
    const double nearest = std::max(0.0, f - data.front_focal_distance);
    if (object_to_film(nearest) > focus_distance)
        throw InputError("cannot focus at " + metres(focus_distance) + ": the nearest object plane that lens \"" +
                         lens.name + "\" can bring to a film is " + metres(object_to_film(nearest)) + " from it");
    double far = nearest + f;
    while (object_to_film(far) < focus_distance) far *= 2;
    return bisect([&](double s) { return object_to_film(s) - focus_distance; }, nearest, far);
}

inline LensSystem moved_as_a_whole(LensSystem lens, double focus_distance) {
    if (std::isinf(focus_distance)) {
        lens.film_distance = best_focus_distance(lens, lens.wavelength_nm, kInfinity);
        return lens;
    }
    // Real rays move the image from the paraxial plane by little; object to film is kept by going round.
    double object = paraxial_object_distance(lens, focus_distance);
    for (int i = 0; i < 50; ++i) {
        lens.film_distance = best_focus_distance(lens, lens.wavelength_nm, object);
        const double excess = object + lens.film_position() - focus_distance;
        if (!(std::fabs(excess) > 1e-9 * focus_distance)) break;
        object -= excess;
    }
    return lens;
}

inline LensSystem moved_by_group(const LensSystem& lens, double focus_distance) {
    const auto error = [&](double shift) {
        const LensSystem moved = with_group_moved(lens, shift);
        const double object = focus_distance - moved.film_position();
        return best_focus_distance(moved, lens.wavelength_nm, object) - moved.film_distance;
    };
    const auto& s = lens.surfaces;
    const auto first = static_cast<std::size_t>(lens.focusing.group_first);
    const auto last = static_cast<std::size_t>(lens.focusing.group_last);
    const double back = first > 0 ? s[first - 1].thickness : lens.last_vertex();
    const double forth = last + 1 < s.size() ? s[last].thickness : lens.film_distance;
    // From the resting place outwards, to the first change of sign on either side.
    constexpr int kSteps = 200;
    const double start = error(0);
    for (int i = 1; i <= kSteps; ++i)
        for (const double reach : {-back, forth}) {
            const double inner = reach * (i - 1) / kSteps, outer = reach * i / kSteps;
            if (start == 0) return lens;
            if ((error(inner) > 0) != (error(outer) > 0)) return with_group_moved(lens, bisect(error, inner, outer));
        }
    throw InputError("cannot focus at " + metres(focus_distance) + ": no position of the focusing group of lens \"" +
                     lens.name + "\" (surfaces " + std::to_string(first + 1) + " to " + std::to_string(last + 1) +
                     ") images it on the film");
}

}  // namespace focus_detail

/// The lens focused on an object plane `focus_distance` mm from the film (infinity allowed): real rays from the axial
/// point, over the full aperture, make their smallest spot on the film. Moves the film, or the focusing group.
/// A diaphragm that is closed does not refocus the lens, as on a camera.
/// Throws InputError where the lens cannot.
inline LensSystem focused(const LensSystem& lens, double focus_distance) {
    using namespace focus_detail;
    if (!(focus_distance > 0))
        throw InputError("the focus distance is " + metres(focus_distance) + "; a positive distance or inf is wanted");
    if (focus_distance < lens.focusing.nearest_mm)
        throw InputError("cannot focus at " + metres(focus_distance) + ": the nearest focus of lens \"" + lens.name +
                         "\" is " + metres(lens.focusing.nearest_mm));
    LensSystem open = lens;
    open.stop_semi_diameter = lens.stop().clear_semi_diameter;
    LensSystem result =
        open.focusing.moves_group() ? moved_by_group(open, focus_distance) : moved_as_a_whole(open, focus_distance);
    result.stop_semi_diameter = lens.stop_semi_diameter;
    result.focus_distance = focus_distance;
    if (!std::isfinite(result.film_distance))
        throw InputError("cannot focus lens \"" + lens.name + "\": no ray from the object passes it");
    if (!(result.film_distance > 0))
        throw InputError("cannot focus lens \"" + lens.name + "\": it makes no real image behind its last surface");
    return result;
}

/// The lens with its diaphragm closed to an f-number (of the lens at infinity; exact for paraxial rays).
/// Throws InputError where the lens is not as fast. A number 0.5% below the lens's own counts as wide open: f-numbers
/// are engraved with two digits.
inline LensSystem stopped_down(LensSystem lens, double f_number) {
    const double full = lens.stop().clear_semi_diameter;
    lens.stop_semi_diameter = full;
    const double fastest = first_order(lens, lens.wavelength_nm).f_number;
    if (!(f_number > 0) || !std::isfinite(f_number))
        throw InputError("the f-number is " + std::to_string(f_number) + "; a positive number is wanted");
    if (f_number < 0.995 * fastest) {
        char text[160];
        std::snprintf(text, sizeof text, "f/%.4g is faster than lens \"%s\", which opens to f/%.4g", f_number,
                      lens.name.c_str(), fastest);
        throw InputError(text);
    }
    lens.stop_semi_diameter = full * std::min(1.0, fastest / f_number);
    return lens;
}

}  // namespace REALCAM_NAMESPACE
