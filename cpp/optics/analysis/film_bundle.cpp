#include "film_bundle.hpp"

namespace realcam {

LensSystem with_round_stop(LensSystem lens) {
    lens.iris = {};
    return lens;
}

FilmBundle::FilmBundle(const LensPath<double>& path, double film_distance, const PupilView& pupil, double film_radius)
    : view_(path.view()), index_(path.entry_index), origin_{film_radius, 0, film_distance} {
    const PupilRowPosition row = pupil_row_position(pupil, static_cast<float>(film_radius), 0);
    middle = {0, static_cast<double>(row.centre)};
    reach = {static_cast<double>(row.half_height), static_cast<double>(row.half_width)};
}

}  // namespace realcam
