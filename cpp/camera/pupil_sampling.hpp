#pragma once
#include "../optics/prescription/lens_system.hpp"

namespace REALCAM_NAMESPACE {

/// Where a camera sends its rays into a lens. All but the first are there to be compared with it (docs/accuracy.md).
enum class PupilSampling : int {
    outline,       ///< where real rays were found to pass (Pupil)
    rear_element,  ///< all over the last surface (C. Kolb, D. Mitchell and P. Hanrahan, "A Realistic Camera Model for
                   ///< Computer Graphics", SIGGRAPH 1995)
    exit_pupil,  ///< the paraxial image of the stop, beside which some light of tilted bundles is lost
    pixel,  ///< over the last surface, more and more where light of the pixel has passed (PixelPupils)
};

/// A lens that passes all rays that are to be sent into this one. Throws InputError where there are none.
LensSystem sampled_lens(const LensSystem& lens, PupilSampling sampling);

}  // namespace REALCAM_NAMESPACE
