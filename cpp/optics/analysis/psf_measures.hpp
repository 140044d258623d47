#pragma once
#include "psf.hpp"

namespace REALCAM_NAMESPACE {

/// Fraction of the light within a circle; `about_um` is its centre relative to the PSF's centre point. Pixels count by
/// the fraction of their area in the circle. Light beyond the array is not counted.
double energy_inside(const Psf& psf, double radius_um, Vec2<double> about_um = {0, 0});

/// Modulation (MTF) at a frequency, periods per mm on the film: across y (tangential) or x (sagittal). It is not
/// divided by the light on the array, so that light beyond it counts as lost to all modulation: the tails of
/// diffraction are smooth.
double modulation(const Psf& psf, double frequency_per_mm, bool tangential);

}  // namespace REALCAM_NAMESPACE
