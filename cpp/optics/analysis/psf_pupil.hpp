#pragma once
#include "psf.hpp"

namespace REALCAM_NAMESPACE {

/// The plane waves of a colour at even steps of their slopes: what a Fourier transform takes. Its size x size sums at
/// pitch_um, |.|^2 times `scale`, are the colour's share of the PSF, with the array's middle at index 0, and periodic.
struct PsfPupil {
    int size;
    std::vector<std::complex<double>> values;  ///< row by row, from slope 0 on: k at index k modulo size
    double scale;
};

/// Edges of the light cut cells, which then count by the share of them that passes.
PsfPupil psf_pupil(const psf_detail::Part& part, const Psf& psf, const RayLoop& loop = {});

}  // namespace REALCAM_NAMESPACE
