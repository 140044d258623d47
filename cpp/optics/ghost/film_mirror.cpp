#include "film_mirror.hpp"

namespace realcam {

LensSystem with_film_mirror(LensSystem lens, double reflectance, double radius) {
    Surface film;
    film.type = SurfaceType::mirror;
    film.clear_semi_diameter = radius;
    film.curvature = 1 / lens.film_radius_of_curvature;
    film.placement = lens.film_placement;
    film.coating.kind = CoatingKind::reflectance;
    film.coating.reflectance = reflectance;
    lens.surfaces.back().thickness = lens.film_distance;
    lens.surfaces.push_back(film);
    return lens;
}

}  // namespace realcam
