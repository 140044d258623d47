#pragma once
#include "../prescription/lens_system.hpp"

namespace REALCAM_NAMESPACE {

/// How far behind the film, mm along its normal, the light of the object plane makes its smallest RMS spot; the plane
/// lies `focus_distance` mm in front of the film. The light comes from the point that the middle of the film sees by
/// its chief ray, over the full aperture as it stands; the iris counts as round. NaN where no light comes, or the plane
/// lies inside the lens.
double focus_error(const LensSystem& lens, double focus_distance);

}  // namespace REALCAM_NAMESPACE
