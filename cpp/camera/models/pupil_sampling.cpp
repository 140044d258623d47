#include "pupil_sampling.hpp"

#include <cmath>

#include "../../optics/lens/paraxial.hpp"

namespace realcam {

namespace {

/// Lens that consists of the clear aperture of the last surface, without refraction and with a stop that blocks
/// nothing.
LensSystem last_surface_alone(const LensSystem& lens) {
    LensSystem alone = lens;
    Surface last = lens.surfaces.back();
    last.type = SurfaceType::refracting;
    last.inner_semi_diameter = 0;
    Surface stop;
    stop.type = SurfaceType::stop;
    stop.clear_semi_diameter = alone.stop_semi_diameter = kLongest;
    stop.thickness = 1;
    last.material = stop.material;
    alone.surfaces = {stop, last};
    alone.iris = {};
    return alone;
}

/// Lens that consists of the paraxial exit pupil alone. Throws InputError if it does not lie at a finite distance in
/// front of the film.
LensSystem exit_pupil_alone(const LensSystem& lens) {
    const FirstOrder data = first_order(lens, lens.wavelength_nm);
    const double distance = lens.film_position() - data.exit_pupil_position;
    if (!(distance > 0) || !std::isfinite(distance))
        throw InputError("the exit pupil of lens \"" + lens.name +
                         "\" lies behind the film or at infinity, so that no rays can be sent through it");
    LensSystem alone = lens;
    Surface stop;
    stop.type = SurfaceType::stop;
    stop.clear_semi_diameter = alone.stop_semi_diameter = 0.5 * data.exit_pupil_diameter;
    alone.surfaces = {stop};
    alone.film_distance = distance;
    alone.iris = {};
    return alone;
}

}  // namespace

LensSystem sampled_lens(const LensSystem& lens, PupilSampling sampling) {
    if (sampling != PupilSampling::outline && lens.indices(lens.wavelength_nm).back() != Glass::air().index(kLineD_nm))
        throw InputError("pupil_sampling: lens \"" + lens.name + "\" has its film in glass; use outline");
    switch (sampling) {
        case PupilSampling::pixel:
        case PupilSampling::rear_element: return last_surface_alone(lens);
        case PupilSampling::exit_pupil: return exit_pupil_alone(lens);
        case PupilSampling::outline: break;
    }
    return lens;
}

}  // namespace realcam
