#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "axial_share.hpp"
#include "field_rays.hpp"
#include "polarised_ray.hpp"

namespace REALCAM_NAMESPACE {

/// What a bundle of rays of one object point keeps of the power of unpolarised light. Means are over the part of the
/// open stop's area that the bundle fills, so vignetting is none of the loss.
struct BundleTransmission {
    FieldRays rays;
    std::vector<double> traced, averaged;  ///< of each ray, see RayTransmittance; 0 where it does not pass
    double mean_traced, mean_averaged;
};

/// Throws what field_rays throws, and InputError where an index is not known at that wavelength.
inline BundleTransmission bundle_transmission(const LensSystem& lens, double wavelength_nm, const FieldPoint& field,
                                              std::vector<PupilPoint> pattern, const RayLoop& loop = {}) {
    const PolarisedTrace trace(lens, LightDirection::to_film, wavelength_nm);
    const ObjectPoint object(lens, wavelength_nm, field);
    BundleTransmission result{field_rays(lens, wavelength_nm, field, std::move(pattern), loop), {}, {}, 0, 0};
    const std::size_t count = result.rays.rays.size();
    result.traced.assign(count, 0);
    result.averaged.assign(count, 0);
    loop.for_all(count, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            if (!result.rays.passes(i)) continue;
            const ObjectPoint::Entry entry = result.rays.rays[i].entry;
            const RayTransmittance ray = trace(object.at(entry), object.direction(entry));
            result.traced[i] = ray.traced;
            result.averaged[i] = ray.averaged;
        }
    });
    double weight = 0;
    for (std::size_t i = 0; i < count; ++i) {
        if (!result.rays.passes(i)) continue;
        const double share = result.rays.pattern[i].weight;
        weight += share;
        result.mean_traced += share * result.traced[i];
        result.mean_averaged += share * result.averaged[i];
    }
    result.mean_traced /= weight;
    result.mean_averaged /= weight;
    return result;
}

/// Of the ray along the axis: the product of the surfaces' transmittances, and of the mirrors' reflectances, at normal
/// incidence. An obstruction on the axis counts for nothing here.
inline double axial_transmittance(const LensSystem& lens, double wavelength_nm) {
    check_wavelength_in_glasses(lens, wavelength_nm, "transmission");
    return AxialShares(lens, wavelength_nm)(crossings_of(lens));
}

/// Share of the stop's area through which light from the axis at infinity passes: less than 1 where a central
/// obstruction takes some of it, or a rim that is smaller than the beam, neither of which the f-number knows. By real
/// rays along a radius, with the edges of shadows halved down to 1e-9 of the area. Where the stop lies in a focal
/// plane, so that light from the axis meets one point of it, 1.
inline double unobstructed_share(LensSystem lens, double wavelength_nm) {
    if (!std::isfinite(first_order(lens, wavelength_nm).entrance_pupil_diameter)) return 1;
    lens.iris.blades = 0;  // a round opening of the same area
    const RayAimer aim(lens, wavelength_nm, FieldPoint{0, kInfinity});
    const double radius = std::min(lens.stop_semi_diameter, lens.stop().clear_semi_diameter);
    const auto passes = [&](double area) { return aim({radius * std::sqrt(area), 0}).status == RayStatus::ok; };
    constexpr int kSteps = 128;
    double open = 0;
    bool before = passes(0);
    for (int i = 1; i <= kSteps; ++i) {
        double low = static_cast<double>(i - 1) / kSteps, high = static_cast<double>(i) / kSteps;
        const double start = low, end = high;
        const bool now = passes(end);
        while (now != before && high - low > 1e-9) {
            const double middle = (low + high) / 2;
            (passes(middle) == before ? low : high) = middle;
        }
        if (before && now) open += end - start;
        if (before != now) open += before ? low - start : end - high;
        before = now;
    }
    return open;
}

/// The f-number of a lens without losses that gives as bright a picture on the axis: f-number / sqrt(transmittance),
/// the transmittance being that of the axial ray, and the share of the pupil that rims and obstructions take a loss
/// too. Infinite where no light passes, and where the lens has no f-number.
inline double t_stop(const LensSystem& lens, double wavelength_nm) {
    const double f_number = first_order(lens, wavelength_nm).f_number;
    if (!std::isfinite(f_number)) return kInfinity;
    return f_number / std::sqrt(axial_transmittance(lens, wavelength_nm) * unobstructed_share(lens, wavelength_nm));
}

}  // namespace REALCAM_NAMESPACE
