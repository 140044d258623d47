#pragma once
#include <array>
#include <vector>

#include "../../math/vec3.hpp"
#include "../prescription/lens_system.hpp"
#include "../trace/ray_loop.hpp"

namespace REALCAM_NAMESPACE {

/// Exit pupil as seen from a film point, in optical direction cosines across the film's normal: x and y of light
/// travelling towards the film.
struct FilmPupil {
    /// Irradiance for unit radiance of the whole scene: the area of the pupil. At the centre of a lens of revolution it
    /// is pi sin^2(theta').
    double irradiance = 0;
    std::vector<std::array<Vec2<double>, 2>> outline;  ///< segments of the edge of what passes
};

/// Computes the pupil with real rays at one wavelength; its edges are found on radial scan lines about the chief ray,
/// and the diaphragm has its real shape. The result is empty, with an irradiance of 0, if no ray of the film point
/// reaches the stop's centre.
FilmPupil film_pupil(const LensSystem& lens, double wavelength_nm, Vec2<double> film, const RayLoop& loop = {});

}  // namespace REALCAM_NAMESPACE
