#pragma once
#include "lens_system.hpp"

namespace REALCAM_NAMESPACE {

/// The lens with its film as one more surface: a plane mirror of that reflectance, open up to `radius` mm. For light
/// that the film sends back into the lens.
inline LensSystem with_film_mirror(LensSystem lens, double reflectance, double radius) {
    Surface film;
    film.type = SurfaceType::mirror;
    film.clear_semi_diameter = radius;
    film.coating.kind = CoatingKind::reflectance;
    film.coating.reflectance = reflectance;
    lens.surfaces.back().thickness = lens.film_distance;
    lens.surfaces.push_back(film);
    return lens;
}

}  // namespace REALCAM_NAMESPACE
