#pragma once
#include <vector>

#include "field_rays.hpp"

namespace REALCAM_NAMESPACE {

/// Transmittance of the rays of one object point for unpolarised light. The means are over the rays that pass, so that
/// vignetting is not counted as a loss.
struct BundleTransmission {
    FieldRays rays;
    std::vector<double> traced, averaged;  ///< for each ray, see RayTransmittance; 0 if the ray does not pass
    double mean_traced, mean_averaged;
};

/// Computes the transmittance of the rays of a field point through a pattern of points on the stop. Throws what
/// field_rays throws, and InputError if a refractive index is not known at this wavelength.
BundleTransmission bundle_transmission(const LensSystem& lens, double wavelength_nm, const FieldPoint& field,
                                       std::vector<PupilPoint> pattern, const RayLoop& loop = {});

/// Returns the transmittance of the ray along the axis: the product of the surfaces' transmittances and of the mirrors'
/// reflectances at normal incidence. Central obstructions are ignored. Throws InputError if a refractive index is not
/// known at this wavelength.
double axial_transmittance(const LensSystem& lens, double wavelength_nm);

/// Returns the fraction of the stop's area through which light from infinity on the axis passes. It is less than 1 if a
/// central obstruction, or a rim that is smaller than the beam, blocks light; the f-number includes neither. It is
/// computed by real rays along a radius; edges of shadows are bisected to 1e-9 of the area. Returns 1 if the stop lies
/// in a focal plane, where light from the axis hits a single point of it.
double unobstructed_share(LensSystem lens, double wavelength_nm);

/// Returns the T-stop: the f-number of a lossless lens whose picture is equally bright on the axis. It is the f-number
/// over the square root of axial_transmittance times unobstructed_share; infinite if no light passes or the lens has no
/// f-number.
double t_stop(const LensSystem& lens, double wavelength_nm);

}  // namespace REALCAM_NAMESPACE
