#pragma once
#include <vector>

#include "field_rays.hpp"

namespace REALCAM_NAMESPACE {

/// What a bundle of rays of one object point keeps of the power of unpolarised light. Means are over the part of the
/// open stop's area that the bundle fills, so vignetting is none of the loss.
struct BundleTransmission {
    FieldRays rays;
    std::vector<double> traced, averaged;  ///< of each ray, see RayTransmittance; 0 where it does not pass
    double mean_traced, mean_averaged;
};

/// Throws what field_rays throws, and InputError where an index is not known at that wavelength.
BundleTransmission bundle_transmission(const LensSystem& lens, double wavelength_nm, const FieldPoint& field,
                                       std::vector<PupilPoint> pattern, const RayLoop& loop = {});

/// Transmittance of the ray along the axis: the product of the surfaces' transmittances, and of the mirrors'
/// reflectances, at normal incidence. An obstruction on the axis is ignored here.
double axial_transmittance(const LensSystem& lens, double wavelength_nm);

/// Share of the stop's area through which light from the axis at infinity passes. It is less than 1 where a central
/// obstruction, or a rim that is smaller than the beam, blocks some. The f-number includes neither. By real rays along
/// a radius, with the edges of shadows halved down to 1e-9 of the area. Where the stop lies in a focal plane, so that
/// light from the axis meets one point of it, 1.
double unobstructed_share(LensSystem lens, double wavelength_nm);

/// The f-number of a lens without losses that gives as bright a picture on the axis: f-number / sqrt(transmittance).
/// The transmittance is that of the axial ray. The share of the pupil that rims and obstructions block counts as a
/// loss, too. Infinite where no light passes, and where the lens has no f-number.
double t_stop(const LensSystem& lens, double wavelength_nm);

}  // namespace REALCAM_NAMESPACE
