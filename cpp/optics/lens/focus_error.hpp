#pragma once
#include "../prescription/lens_system.hpp"

namespace REALCAM_NAMESPACE {

/// Returns the focus error of a lens of any kind: the distance behind the film, along its normal, at which the light of
/// an object plane makes its smallest RMS spot, mm; negative if that is in front of the film. The plane lies
/// `focus_distance` mm in front of the film. The light comes from the plane's point on the chief ray of the film's
/// centre, through the current opening of the diaphragm, which is treated as round. Returns NaN if no light arrives, or
/// if the plane lies inside the lens. Throws InputError if there is no such chief ray.
double focus_error(const LensSystem& lens, double focus_distance);

}  // namespace REALCAM_NAMESPACE
