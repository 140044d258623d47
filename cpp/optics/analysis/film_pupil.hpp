#pragma once
#include <array>
#include <vector>

#include "../../math/vec3.hpp"
#include "../prescription/lens_system.hpp"
#include "../trace/ray_loop.hpp"

namespace REALCAM_NAMESPACE {

/// The pupil as a film point sees it, in optical direction cosines across the film's normal: x and y of light on its
/// way to the film.
struct FilmPupil {
    /// Irradiance for unit radiance of all that the lens sees: the area of the pupil. In the middle of a lens of
    /// revolution that is pi sin^2(theta').
    double irradiance = 0;
    std::vector<std::array<Vec2<double>, 2>> outline;  ///< pieces of the edge of what passes
};

/// By real rays at one wavelength, whose edges are found on spokes about the chief ray; the diaphragm counts as it is.
/// Dark where no ray of the film point reaches the middle of the stop.
FilmPupil film_pupil(const LensSystem& lens, double wavelength_nm, Vec2<double> film, const RayLoop& loop = {});

}  // namespace REALCAM_NAMESPACE
