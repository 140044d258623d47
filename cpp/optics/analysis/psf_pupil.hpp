#pragma once
#include "psf.hpp"

namespace REALCAM_NAMESPACE {

/// Plane waves of one colour at equally spaced slopes: the input of a two-dimensional Fourier transform of size x size.
/// The squared magnitude of its output times `scale` is the contribution of the colour to the PSF, at points `pitch_um`
/// apart. The output is periodic, and has the centre of the PSF at index 0.
struct PsfPupil {
    int size;
    std::vector<std::complex<double>> values;  ///< row by row; slope k * step is at index k modulo size
    double scale;
};

/// Computes the plane waves of a colour. Cells of the grid of slopes that the edge of the light cuts count by the
/// fraction of them that passes. Throws InputError if the wavefront is too steep for the method, and Cancelled if
/// `loop` is cancelled.
PsfPupil psf_pupil(const psf_detail::ColourPart& part, const Psf& psf, const RayLoop& loop = {});

}  // namespace REALCAM_NAMESPACE
