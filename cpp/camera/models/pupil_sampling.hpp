#pragma once
#include "../../optics/prescription/lens_system.hpp"

namespace REALCAM_NAMESPACE {

/// Region of the lens to which a camera sends its rays. All but the first exist for comparison (docs/accuracy.md).
enum class PupilSampling : int {
    outline,       ///< the pupil, found with real rays (Pupil)
    rear_element,  ///< all over the last surface (C. Kolb, D. Mitchell and P. Hanrahan, "A Realistic Camera Model for
                   ///< Computer Graphics", SIGGRAPH 1995)
    exit_pupil,  ///< the paraxial image of the stop; misses some light of oblique bundles
    pixel,  ///< the last surface, increasingly where light of the pixel has passed (PixelPupils)
};

/// Lens whose pupil is the region to sample for this lens. Throws InputError if there is no such region.
LensSystem sampled_lens(const LensSystem& lens, PupilSampling sampling);

}  // namespace REALCAM_NAMESPACE
