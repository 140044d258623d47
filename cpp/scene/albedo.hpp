#pragma once
#include "make_bsdf.hpp"

namespace REALCAM_NAMESPACE {

/// Albedo of a surface point, 0 to 1, independent of light and view, as Open Image Denoise defines it: the reflectances
/// of the lobes at normal incidence, layered. Transmitted light counts as reflected, so that clear glass is white.
/// Clear coats are ignored.
REALCAM_INLINE Color albedo_of(const SurfacePoint& point) {
    using make_bsdf_detail::unit_range;
    const Material& m = *point.material;
    const float transmission = unit_range(point.transmission);
    if (m.model == MaterialModel::phong) {
        const Color opaque = point.diffuse + point.specular + m.mirror;
        return unit_range((1.0f - transmission) * unit_range(opaque) + transmission * unit_range(m.filter));
    }
    const Color base = unit_range(point.diffuse);
    const Color f0 = unit_range((point.specular_weight * make_bsdf_detail::normal_reflectance(m.ior)) * point.specular);
    const Color layered = f0 + (grey(1.0f) - f0) * base;
    const Color dielectric = (1.0f - transmission) * layered + transmission * base;
    return unit_range(mix(dielectric, base, unit_range(point.metallic)));
}

}  // namespace REALCAM_NAMESPACE
