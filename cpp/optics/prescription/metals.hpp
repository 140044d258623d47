#pragma once
#include "coating_material.hpp"

namespace REALCAM_NAMESPACE {

// Measured refractive indices n + ik of mirror metals, as clean evaporated films. Wavelengths in nm.

/// A. D. Rakic, "Algorithm for the determination of intrinsic optical constants of metal films: application to
/// aluminum", Appl. Opt. 34, 4755 (1995), table 1.
CoatingMaterial aluminium();

/// P. B. Johnson and R. W. Christy, "Optical constants of the noble metals", Phys. Rev. B 6, 4370 (1972), table I.
CoatingMaterial silver();

}  // namespace REALCAM_NAMESPACE
