#pragma once
#include "psf.hpp"

namespace REALCAM_NAMESPACE {

/// Share of the light within a circle about a place of the PSF, um from its middle point. Squares about the points
/// count by the part of their area that is in the circle. What lies beyond the array is not counted.
double energy_inside(const Psf& psf, double radius_um, Vec2<double> about_um = {0, 0});

/// Modulation of lines of a frequency, per mm on the film: across y (tangential) or x (sagittal). Not divided by the
/// light on the array, so that light beyond it counts as lost to all modulation: the tails of diffraction are smooth.
double modulation(const Psf& psf, double frequency_per_mm, bool tangential);

}  // namespace REALCAM_NAMESPACE
