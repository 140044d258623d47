#pragma once
#include <vector>

#include "paraxial.hpp"

namespace REALCAM_NAMESPACE {

/// First-order data of light that two surfaces reflect once each on its way to the film.
struct GhostPath {
    double effective_focal_length;  ///< mm
    double back_focal_distance;     ///< last vertex to where light from infinity is focused, mm; negative: before it
};

/// The ghost of light that runs forward to surface `first`, is reflected there, runs back to surface `second` in front
/// of it, is reflected again, and runs forward through the rest of the lens. Surfaces are numbered from 0.
///
/// A paraxial ray meets the surfaces one by one; at each reflection, a mirror's too, the index changes its sign (R. H.
/// Abd El-Maksoud and J. M. Sasian, "Paraxial ghost image analysis", Proc. SPIE 7428, 742807, 2009). Throws InputError
/// where the two are not refracting surfaces in that order.
inline GhostPath ghost_path(const LensSystem& lens, double wavelength_nm, int first, int second) {
    const int count = static_cast<int>(lens.surfaces.size());
    const auto surface = [&](int i) -> const Surface& { return lens.surfaces[static_cast<std::size_t>(i)]; };
    if (!(0 <= second && second < first && first < count))
        throw InputError(
            "a ghost is reflected by two surfaces, the first time by the one nearer to the film: wanted are "
            "numbers with 0 <= second < first < " +
            std::to_string(count));
    for (const int i : {first, second})
        if (surface(i).type != SurfaceType::refracting)
            throw InputError("surface " + std::to_string(i) +
                             " is no refracting one; a ghost is light that a refracting surface reflects");
    const std::vector<double> n = lens.indices(wavelength_nm), z = lens.vertices();
    ParaxialRay ray{1, 0};
    int at = 0;         // the surface that the ray meets next
    int along = 1;      // +1: in the order of the table, -1: against it
    double direction_sign = 1;   // of the light along z, which a mirror of the lens turns too
    int reflections = 0;
    while (at < count) {
        const auto k = static_cast<std::size_t>(at);
        const bool ghost = (reflections == 0 && at == first) || (reflections == 1 && at == second);
        const double before = direction_sign * (along > 0 ? n[k] : n[k + 1]);
        const bool turns = ghost || surface(at).type == SurfaceType::mirror;
        if (turns) direction_sign = -direction_sign;
        if (ghost) {
            along = -along;
            ++reflections;
        }
        const double after = direction_sign * (turns ? std::fabs(before) : along > 0 ? n[k + 1] : n[k]);
        ray = refract_paraxial(ray, surface(at).curvature, before, after);
        at += along;
        if (at < count) ray.height += (z[static_cast<std::size_t>(at)] - z[k]) * ray.slope;
    }
    return {-1 / ray.slope, -ray.height / ray.slope};
}

}  // namespace REALCAM_NAMESPACE
