#pragma once
#include "psf.hpp"

namespace REALCAM_NAMESPACE {

/// Plane waves of a colour at equal steps of slope, the input of a Fourier transform. Its size x size sums at pitch_um,
/// |.|^2 times `scale`, are the colour's contribution to the PSF, with the array's centre at index 0, and periodic.
struct PsfPupil {
    int size;
    std::vector<std::complex<double>> values;  ///< row by row, from slope 0 on: step k at index k modulo size
    double scale;
};

/// Cells that the edge of the light cuts count by the fraction of them that passes.
PsfPupil psf_pupil(const psf_detail::Part& part, const Psf& psf, const RayLoop& loop = {});

}  // namespace REALCAM_NAMESPACE
