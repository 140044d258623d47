#include "transmission.hpp"

#include <cmath>
#include <utility>

#include "../coating/polarised_ray.hpp"
#include "../lens/exposure.hpp"
#include "../lens/paraxial.hpp"
#include "../trace/film_frame.hpp"
#include "ray_aiming.hpp"

namespace realcam {

BundleTransmission bundle_transmission(const LensSystem& lens, double wavelength_nm, const FieldPoint& field,
                                       std::vector<PupilPoint> pattern, const RayLoop& loop) {
    const PolarisedTrace trace(lens, LightDirection::to_film, wavelength_nm, -1,
                               film_path_ends(lens, LightDirection::to_film));
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
        const double ray_weight = result.rays.pattern[i].weight;
        weight += ray_weight;
        result.mean_traced += ray_weight * result.traced[i];
        result.mean_averaged += ray_weight * result.averaged[i];
    }
    result.mean_traced /= weight;
    result.mean_averaged /= weight;
    return result;
}

double axial_transmittance(const LensSystem& lens, double wavelength_nm) {
    check_wavelength_in_glasses(lens, wavelength_nm, "transmission");
    return AxialTransmittance(lens, wavelength_nm)(crossings_of(lens));
}

double unobstructed_share(LensSystem lens, double wavelength_nm) {
    if (!std::isfinite(first_order(lens, wavelength_nm).entrance_pupil_diameter)) return 1;
    lens.iris.blades = 0;  // a round opening of the same area
    const RayAimer aim(lens, wavelength_nm, FieldPoint{0, kInfinity});
    const double radius = lens.open_stop_radius();
    const auto passes = [&](double area) { return aim({radius * std::sqrt(area), 0}).status == RayStatus::ok; };
    constexpr int kSteps = 128;
    double unobstructed = 0;
    bool passes_start = passes(0);
    for (int i = 1; i <= kSteps; ++i) {
        double low = static_cast<double>(i - 1) / kSteps, high = static_cast<double>(i) / kSteps;
        const double start = low, end = high;
        const bool passes_end = passes(end);
        while (passes_end != passes_start && high - low > 1e-9) {
            const double middle = (low + high) / 2;
            (passes(middle) == passes_start ? low : high) = middle;
        }
        if (passes_start && passes_end) unobstructed += end - start;
        if (passes_start != passes_end) unobstructed += passes_start ? low - start : end - high;
        passes_start = passes_end;
    }
    return unobstructed;
}

double t_stop(const LensSystem& lens, double wavelength_nm) {
    const double f_number = first_order(lens, wavelength_nm).f_number;
    if (!std::isfinite(f_number)) return kInfinity;
    return f_number / std::sqrt(axial_transmittance(lens, wavelength_nm) * unobstructed_share(lens, wavelength_nm));
}

}  // namespace realcam
