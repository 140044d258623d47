// The tabulated exit pupil of a lens, for the exporter realcam.mitsuba.

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <optional>
#include <utility>
#include <vector>

#include "../../embree/lens_rays.hpp"
#include "../../optics/prescription/known_wavelengths.hpp"
#include "../../optics/pupil/film_symmetry.hpp"
#include "../../optics/pupil/pupil.hpp"
#include "../../optics/trace/open_iris.hpp"
#include "../bindings.hpp"
#include "../values/arrays.hpp"

namespace realcam::bindings {

using namespace py::literals;

namespace {

/// Contents of a PupilView (see pupil_view.hpp) as flat arrays.
struct PupilArrays {
    std::vector<float> nodes;  ///< (rows + 1, 3): members of SymmetricPupilNode
    std::vector<float> outline;  ///< (rows, sectors, 5): members of PupilSector
    py::ssize_t rows, sectors;
    double image_radius_mm;  ///< film radius beyond which no light arrives
};

PupilArrays pupil_arrays(const LensSystem& lens, double film_radius_mm, const std::vector<double>& wavelengths_nm) {
    require_radial_pupil(lens, "the table of the pupil of lens \"" + lens.name + "\"");
    for (const double nm : wavelengths_nm) check_glasses_known(lens, {nm, nm}, "dispersion");
    const Pupil pupil(lens, film_radius_mm, fast_pupil_tracer(), wavelengths_nm);
    const PupilView view = pupil.view();
    PupilArrays arrays{{}, {}, view.rows, PupilView::kSectors, pupil.image_radius()};
    for (int i = 0; i <= view.rows; ++i) {
        const SymmetricPupilNode& node = view.nodes[i];
        arrays.nodes.insert(arrays.nodes.end(), {node.centre_l, node.half_width, node.half_height});
    }
    for (int i = 0; i < view.rows * PupilView::kSectors; ++i) {
        const PupilSector& s = view.outline[i];
        arrays.outline.insert(arrays.outline.end(), {s.x, s.y, s.dx, s.dy, s.hole_squared});
    }
    return arrays;
}

}  // namespace

void bind_pupil_table(py::module_& m) {
    m.def(
        "_pupil_table",
        [](const LensSystem& lens, double film_radius_mm, const std::vector<double>& wavelengths_nm) {
            PupilArrays found = [&] {
                const Unlocked unlocked;
                return pupil_arrays(lens, film_radius_mm, wavelengths_nm);
            }();
            return py::make_tuple(array_from(std::move(found.nodes), {found.rows + 1, 3}),
                                  array_from(std::move(found.outline), {found.rows, found.sectors, 5}),
                                  found.image_radius_mm);
        },
        "lens"_a, "film_radius_mm"_a, "wavelengths_nm"_a,
        R"(Internal. Tabulates the exit pupil as seen from film radii up to film_radius_mm, from which rays are sampled
(PupilView in pupil_view.hpp). Returns nodes (rows + 1, 3), sectors (rows, sectors, 5), and the film radius in mm beyond
which no light arrives. wavelengths_nm: the table contains all light that passes at any of these. Raises InputError for
a lens that is not rotationally symmetric, and if a glass is unknown at a wavelength.)");
    m.def(
        "_iris_apothem_mm",
        [](const LensSystem& lens) -> std::optional<double> {
            if (lens.iris.blades == 0 || lens.is_wide_open()) return std::nullopt;
            return open_iris(lens.iris, lens.stop_semi_diameter, lens.stop().clear_semi_diameter).apothem;
        },
        "lens"_a,
        "Internal. Returns the distance from the axis to the middle of a blade's edge; None if no blade is in the "
        "light.");
}

}  // namespace realcam::bindings
