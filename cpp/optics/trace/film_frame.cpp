#include "film_frame.hpp"

#include <utility>

namespace realcam {

namespace {

/// Returns -1 if light leaves the lens against the z direction of the last axis, else 1.
double direction_at_film(const LensSystem& lens) {
    const std::vector<Crossing> crossings = crossings_of(lens);
    double sign = 1;
    for (std::size_t m = 0; m < crossings.size(); ++m) {
        sign *= path_frames_detail::axis_sign_before(lens, crossings, m);
        if (lens.surfaces[static_cast<std::size_t>(crossings[m].surface)].type == SurfaceType::mirror) sign = -sign;
    }
    return sign;
}

/// True if lens and film are centred on one axis and the film lies behind the last vertex, not in front of it as for a
/// single mirror.
bool is_centred(const LensSystem& lens) {
    return !path_frames_detail::has_placements(lens) && lens.film_placement.is_in_place() && lens.film_distance >= 0;
}

}  // namespace

Affine<double> film_frame(const LensSystem& lens) {
    const Affine<double> film =
        surface_frames(lens).last_axis * along_axis(lens.film_distance) * lens.film_placement.frame();
    if (direction_at_film(lens) > 0) return film;
    // Turned by 180 degrees about y.
    return film * Affine<double>{{-1, 0, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 0}};
}

PathEnds film_path_ends(const LensSystem& lens, LightDirection direction) {
    if (is_centred(lens)) return {};
    const Affine<double> film = film_frame(lens);
    PathEnds ends{film * along_axis(-lens.film_distance),
                  Affine<double>{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {film.origin.x, film.origin.y, 0}}};
    if (direction == LightDirection::to_film) std::swap(ends.entry, ends.exit);
    return ends;
}

double camera_film_position(const LensSystem& lens) {
    return is_centred(lens) ? lens.film_position() : film_frame(lens).origin.z;
}

}  // namespace realcam
