#pragma once
#include <cmath>

#include "../optics/lens_system.hpp"
#include "../optics/paraxial.hpp"

namespace REALCAM_NAMESPACE {

/// Where a camera sends its rays into a lens. All but the first are there to be compared with it (docs/accuracy.md).
enum class PupilSampling : int {
    outline,       ///< where real rays were found to pass (Pupil)
    rear_element,  ///< all over the last surface (C. Kolb, D. Mitchell and P. Hanrahan, "A Realistic Camera Model for
                   ///< Computer Graphics", SIGGRAPH 1995)
    exit_pupil,  ///< the paraxial image of the stop, beside which some light of tilted bundles is lost
    pixel,  ///< over the last surface, more and more where light of the pixel has passed (PixelPupils)
};

namespace pupil_sampling_detail {

/// What passes the last surface as if nothing bent or stopped it there.
inline LensSystem last_surface_alone(const LensSystem& lens) {
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

inline LensSystem exit_pupil_alone(const LensSystem& lens) {
    const FirstOrder data = first_order(lens, lens.wavelength_nm);
    const double distance = lens.film_position() - data.exit_pupil_position;
    if (!(distance > 0) || !std::isfinite(distance))
        throw InputError("the exit pupil of lens \"" + lens.name +
                         "\" lies behind the film or at infinity, so that nothing can be sent there");
    LensSystem alone = lens;
    Surface stop;
    stop.type = SurfaceType::stop;
    stop.clear_semi_diameter = alone.stop_semi_diameter = 0.5 * data.exit_pupil_diameter;
    alone.surfaces = {stop};
    alone.film_distance = distance;
    alone.iris = {};
    return alone;
}

}  // namespace pupil_sampling_detail

/// A lens that passes all rays that are to be sent into this one. Throws InputError where there are none.
inline LensSystem sampled_lens(const LensSystem& lens, PupilSampling sampling) {
    if (sampling != PupilSampling::outline && lens.indices(lens.wavelength_nm).back() != Glass::air().index(kLineD_nm))
        throw InputError("pupil_sampling: lens \"" + lens.name + "\" has its film in glass; outline is wanted");
    switch (sampling) {
        case PupilSampling::pixel:
        case PupilSampling::rear_element: return pupil_sampling_detail::last_surface_alone(lens);
        case PupilSampling::exit_pupil: return pupil_sampling_detail::exit_pupil_alone(lens);
        case PupilSampling::outline: break;
    }
    return lens;
}

}  // namespace REALCAM_NAMESPACE
