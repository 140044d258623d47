#pragma once
#include <vector>

#include "field_rays.hpp"

namespace REALCAM_NAMESPACE {

/// Transmittance of the rays of one object point for unpolarised light. Means are over the part of the open stop's area
/// that the bundle fills, so that vignetting is not a loss.
struct BundleTransmission {
    FieldRays rays;
    std::vector<double> traced, averaged;  ///< for each ray, see RayTransmittance; 0 if it does not pass
    double mean_traced, mean_averaged;
};

/// Throws what field_rays throws, and InputError if an index is not known at this wavelength.
BundleTransmission bundle_transmission(const LensSystem& lens, double wavelength_nm, const FieldPoint& field,
                                       std::vector<PupilPoint> pattern, const RayLoop& loop = {});

/// Transmittance of the ray along the axis: the product of the surfaces' transmittances, and of the mirrors'
/// reflectances, at normal incidence. An obstruction on the axis is ignored here.
double axial_transmittance(const LensSystem& lens, double wavelength_nm);

/// Fraction of the stop's area through which light from the axis at infinity passes. It is less than 1 if a central
/// obstruction, or a rim that is smaller than the beam, blocks light. The f-number includes neither. Computed with real
/// rays along a radius, with the edges of shadows bisected down to 1e-9 of the area. Returns 1 if the stop lies in a
/// focal plane, where light from the axis meets a single point of it.
double unobstructed_share(LensSystem lens, double wavelength_nm);

/// T-stop: the f-number of a lossless lens with an equally bright picture on the axis, f-number / sqrt(transmittance).
/// The transmittance is that of the axial ray times the fraction of the pupil that rims and obstructions leave open.
/// Infinite if no light passes, or the lens has no f-number.
double t_stop(const LensSystem& lens, double wavelength_nm);

}  // namespace REALCAM_NAMESPACE
