#pragma once
#include "../prescription/lens_system.hpp"

namespace REALCAM_NAMESPACE {

/// Distance behind the film, mm along its normal, at which the light of the object plane makes its smallest RMS spot.
/// The plane lies `focus_distance` mm in front of the film. The light comes from the plane's point on the chief ray of
/// the film's centre, through the current opening of the diaphragm, which is treated as round. NaN if no light arrives,
/// or the plane lies inside the lens.
double focus_error(const LensSystem& lens, double focus_distance);

}  // namespace REALCAM_NAMESPACE
