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
        throw InputError("film_reflectance must be a share from 0 to 1");
    const double film_radius = 0.5 * hypotenuse(lens.film_width, lens.film_height);
    const GhostTables tables(lens, film_radius, {true, film_reflectance, 0}, fast_pupil_tracer(), nullptr);
    std::vector<Ghost> ghosts;
    for (std::size_t k = 0; k < tables.pairs().size(); ++k)
        ghosts.push_back(ghost_of(lens, tables.pairs()[k], lens.wavelength_nm, tables.shares()[k]));
    std::stable_sort(ghosts.begin(), ghosts.end(), [](const Ghost& a, const Ghost& b) { return a.share > b.share; });
    return ghosts;
}

}  // namespace

template <>
struct RestoredCheck<Ghost> {
    static void check(const Ghost& ghost) {
        require_restored(0 <= ghost.second && ghost.second < ghost.first && ghost.first <= kMaxSurfaces);
    }
};

void bind_ghosts(py::module_& m) {
    py::class_<Ghost> ghost(m, "Ghost",
                            R"(Light that two surfaces reflect on its way to the film: first `first`, back towards the
scene, then `second`, in front of it. Surfaces are numbered from 0, as in Lens.surfaces; the film has the number
behind the last one's.)");
    def_hashable_value(ghost);
    ghost.def_readonly("first", &Ghost::first)
        .def_readonly("second", &Ghost::second)
        .def_readonly("effective_focal_length_mm", &Ghost::effective_focal_length)
        .def_readonly("back_focal_distance_mm", &Ghost::back_focal_distance,
                      "Last vertex to where the ghost of a point at infinity is sharp; negative in front of it.")
        .def_readonly("share", &Ghost::share,
                      R"(What it brings to the film of the light that the lens itself brings there, of light that comes
from all sides alike: its brightness in veiling glare, and about that of a lamp's ghost over the film. None where
Lens.ghost made it.)")
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
            R"(The ghost of light that surface `first` reflects back, and surface `second`, in front of it, forward
again. Surfaces are numbered from 0, as in Lens.surfaces; `first` may be the film, with the number behind the last
one's. Paraxial (R. H. Abd El-Maksoud and J. M. Sasian, Proc. SPIE 7428, 742807, 2009). Raises InputError where the
two are not refracting surfaces, or the film and one, in that order.)")
        .def("ghosts", &ghosts_of, py::kw_only(), "film_reflectance"_a = 0,
             R"(All ghosts that reach the lens's film at the design wavelength, the brightest first, with their shares:
by rays through both reflections, with the reflectances of light along the axis. Surfaces of unknown
coating count as bare. With a film that reflects some share of the light as a mirror does, also those of film and
surface. Raises InputError where an index is not known.)");
}

}  // namespace realcam::bindings
