#pragma once
#include <vector>

#include "crossing.hpp"
#include "paraxial.hpp"

namespace REALCAM_NAMESPACE {

/// First-order data of light that two surfaces reflect once each on its way to the film.
struct GhostPath {
    double effective_focal_length;  ///< mm
    double back_focal_distance;     ///< last vertex to where light from infinity is focused, mm; negative: before it
};

/// The ghost of a pair of surfaces.
///
/// A paraxial ray meets the surfaces one by one; at each reflection, a mirror's too, the index changes its sign (R. H.
/// Abd El-Maksoud and J. M. Sasian, "Paraxial ghost image analysis", Proc. SPIE 7428, 742807, 2009). Throws InputError
/// where the two are not refracting surfaces in that order.
inline GhostPath ghost_path(const LensSystem& lens, double wavelength_nm, GhostPair pair) {
    const int count = static_cast<int>(lens.surfaces.size());
    const auto surface = [&](int i) -> const Surface& { return lens.surfaces[static_cast<std::size_t>(i)]; };
    if (!(0 <= pair.second && pair.second < pair.first && pair.first < count))
        throw InputError(
            "a ghost is reflected by two surfaces, the first time by the one nearer to the film: wanted are "
            "numbers with 0 <= second < first < " +
            std::to_string(count));
    for (const int i : {pair.first, pair.second})
        if (surface(i).type != SurfaceType::refracting)
            throw InputError("surface " + std::to_string(i) +
                             " is no refracting one; a ghost is light that a refracting surface reflects");
    const std::vector<double> n = lens.indices(wavelength_nm), z = lens.vertices();
    ParaxialRay ray{1, 0};
    double direction_sign = 1;  // of the light along z
    double at = 0;              // z of the vertex that it met last
    for (const Crossing& crossing : crossings_of(lens, pair)) {
        const double here = z[static_cast<std::size_t>(crossing.surface)];
        ray.height += (here - at) * ray.slope;
        const double before = direction_sign * crossing.index_before(n);
        if (crossing.is_reflected || surface(crossing.surface).type == SurfaceType::mirror)
            direction_sign = -direction_sign;
        const double behind = direction_sign * crossing.index_behind(n);
        ray = refract_paraxial(ray, surface(crossing.surface).curvature, before, behind);
        at = here;
    }
    return {-1 / ray.slope, -ray.height / ray.slope};
}

}  // namespace REALCAM_NAMESPACE
