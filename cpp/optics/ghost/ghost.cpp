#include "ghost.hpp"

namespace realcam {

GhostPath ghost_path(const LensSystem& lens, double wavelength_nm, GhostPair pair) {
    lens.require_rotational("a ghost's first-order data");
    const int count = static_cast<int>(lens.surfaces.size());
    if (!(0 <= pair.second && pair.second < pair.first && pair.first <= count))
        throw InputError(
            "a ghost is reflected by two surfaces, the first time by the one nearer to the film: expected "
            "indices with 0 <= second < first <= " +
            std::to_string(count) + ", the last of which is the film's");
    for (const int i : {pair.first, pair.second})
        if (!is_film(lens, i) && lens.surfaces[static_cast<std::size_t>(i)].type != SurfaceType::refracting)
            throw InputError("surface " + std::to_string(i) +
                             " does not refract; a ghost is light that a refracting surface reflects");
    const LensSystem with_film = with_film_mirror(lens, 1, kLongest);
    const auto surface = [&](int i) -> const Surface& { return with_film.surfaces[static_cast<std::size_t>(i)]; };
    const std::vector<double> n = with_film.indices(wavelength_nm), z = with_film.vertices();
    ParaxialRay rays[] = {{1, 0}, {0, 1}};
    double direction_sign = 1;  // sign of the light's direction along z
    double last_z = 0;              // z of the last vertex crossed
    std::vector<GhostPath::SurfaceHeights> surface_heights;
    for (const Crossing& crossing : crossings_of(lens, pair)) {
        const double z_here = z[static_cast<std::size_t>(crossing.surface)];
        const double before = direction_sign * crossing.index_before(n);
        if (crossing.is_reflected || surface(crossing.surface).type == SurfaceType::mirror)
            direction_sign = -direction_sign;
        const double behind = direction_sign * crossing.index_behind(n);
        for (ParaxialRay& ray : rays) {
            ray.height += (z_here - last_z) * ray.slope;
            ray = refract_paraxial(ray, surface(crossing.surface).vertex_curvature(), before, behind);
        }
        if (!is_film(lens, crossing.surface))
            surface_heights.push_back({crossing.surface, rays[0].height, rays[1].height});
        last_z = z_here;
    }
    return {-1 / rays[0].slope, -rays[0].height / rays[0].slope, rays[0], rays[1], surface_heights};
}

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
