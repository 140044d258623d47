// Ghosts of a lens: the class Ghost, Lens.ghost and Lens.ghosts.

#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>

#include "../../camera/effects/ghosts/ghost_tables.hpp"
#include "../../embree/lens_rays.hpp"
#include "../../math/hypotenuse.hpp"
#include "../../optics/ghost/ghost.hpp"
#include "../bindings.hpp"
#include "../values/arrays.hpp"
#include "../values/short_text.hpp"
#include "../values/value_methods.hpp"

namespace realcam::bindings {

using namespace py::literals;

namespace {

/// Ghost as Python exposes it; see the docstrings. Lengths in mm.
struct Ghost {
    int first, second;
    double effective_focal_length, back_focal_distance;
    std::optional<double> share;  ///< std::nullopt if it was not requested
};

Ghost ghost_of(const LensSystem& lens, GhostPair pair, double wavelength_nm, std::optional<double> share = {}) {
    const GhostPath path = ghost_path(lens, wavelength_nm, pair);
    return {pair.first, pair.second, path.effective_focal_length, path.back_focal_distance, share};
}

std::vector<Ghost> ghosts_of(const LensSystem& lens, double film_reflectance) {
    if (!(film_reflectance >= 0 && film_reflectance <= 1))
        throw InputError("film_reflectance must lie between 0 and 1");
    const double film_radius = 0.5 * hypotenuse(lens.film_width, lens.film_height);
    const GhostTables tables(lens, film_radius, {true, film_reflectance, 0}, fast_pupil_tracer(), nullptr);
    std::vector<Ghost> ghosts;
    for (std::size_t k = 0; k < tables.pairs().size(); ++k)
        ghosts.push_back(ghost_of(lens, tables.pairs()[k], lens.wavelength_nm, tables.shares()[k]));
    std::stable_sort(ghosts.begin(), ghosts.end(), [](const Ghost& a, const Ghost& b) { return a.share > b.share; });
    return ghosts;
}

}  // namespace

void bind_ghosts(py::module_& m) {
    py::class_<Ghost> ghost(m, "Ghost",
                            R"(Ghost image: light that two surfaces reflect on its way to the film. Surface `first`
reflects it back towards the scene, then surface `second`, in front of `first`, forward again. Indices as in
Lens.surfaces; the index of the film is the number of surfaces.)");
    def_hashable_value(ghost, [](const Ghost& g) {
        require_restored(0 <= g.second && g.second < g.first && g.first <= kMaxSurfaces);
    });
    ghost.def_readonly("first", &Ghost::first, "Index of the surface that the light reaches first, or of the film.")
        .def_readonly("second", &Ghost::second, "Index of the surface in front of it that reflects the light again.")
        .def_readonly("effective_focal_length_mm", &Ghost::effective_focal_length,
                      "Focal length of the optical path with both reflections.")
        .def_readonly("back_focal_distance_mm", &Ghost::back_focal_distance,
                      "Distance from the last vertex to the ghost of a point at infinity; negative in front of it.")
        .def_readonly("share", &Ghost::share,
                      R"(Light that the ghost path brings to the film, relative to the light of the direct path, for a
scene of uniform radiance: its contribution to veiling glare, and roughly the relative brightness of a lamp's ghost
that spreads over the film. None if the ghost is the result of Lens.ghost.)")
        .def("__repr__", [](const Ghost& g) {
            return "<realcam.Ghost of surfaces " + std::to_string(g.first) + " and " + std::to_string(g.second) +
                   ", focal length " + digits(g.effective_focal_length) + " mm, back focal distance " +
                   digits(g.back_focal_distance) + " mm" + (g.share ? ", share " + digits(*g.share) : "") + '>';
        });
    py::reinterpret_borrow<py::class_<LensSystem>>(m.attr("Lens"))
        .def(
            "ghost",
            [](const LensSystem& lens, int first, int second, std::optional<double> nm) {
                return ghost_of(lens, {first, second}, wavelength_or_design(lens, nm));
            },
            "first"_a, "second"_a, py::kw_only(), "wavelength_nm"_a = py::none(),
            R"(Returns the Ghost of light that surface `first` reflects back and surface `second`, in front of it,
forward again, with paraxial data (R. H. Abd El-Maksoud and J. M. Sasian, Proc. SPIE 7428, 742807, 2009).
first, second: indices as in Lens.surfaces; first may be the film, whose index is the number of surfaces.
wavelength_nm: None: the design wavelength.
Raises InputError unless both are refracting surfaces, or the film and a refracting surface, in that order.)")
        .def("ghosts", &ghosts_of, py::kw_only(), "film_reflectance"_a = 0,
             R"(Returns the list of all ghosts that reach the lens's film at the design wavelength, the brightest first,
with their shares. Computed with rays through both reflections, and reflectances for light along the axis; surfaces of
unknown coating count as bare.
film_reflectance: specular reflectance of the film, 0 to 1; above 0 the list includes ghosts of film and surface.
Raises InputError if a refractive index is unknown.)");
}

}  // namespace realcam::bindings
