#pragma once
#include <string>

#include "../prescription/lens_system.hpp"

namespace REALCAM_NAMESPACE {

/// A rectangle on the film, mm, in the axes of the film.
struct FilmArea {
    Vec2<double> least, most;  ///< smallest and largest x and y
};

/// Mirror symmetries of a lens, including the placement of its film.
struct MirrorPlanes {
    bool x = false, y = false;  ///< `x`: symmetric under x -> -x; `y`: under y -> -y
};

/// True if the pupil of a film point depends only on the point's distance from the axis: for a centred, rotationally
/// symmetric lens with a flat film. The class Pupil finds and samples such pupils faster than PupilGrid.
bool has_radial_pupil(const LensSystem& lens);

/// Throws InputError unless the lens has a radial pupil. `what`: subject of the message, such as "a thin lens".
void require_radial_pupil(const LensSystem& lens, const std::string& what);

/// Returns the mirror symmetries of a lens; a symmetry may be missed for surface terms and apertures of unusual kinds.
MirrorPlanes mirror_planes(const LensSystem& lens);

}  // namespace REALCAM_NAMESPACE
