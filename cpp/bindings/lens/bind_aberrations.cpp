// Third-order aberrations (the class Seidel, Lens.seidel) and the classes of first-order data, FirstOrder and Meridian.

#include <pybind11/stl.h>

#include "../../optics/analysis/seidel.hpp"
#include "../../optics/lens/parabasal.hpp"
#include "../bindings.hpp"
#include "../values/arrays.hpp"
#include "../values/short_text.hpp"
#include "../values/value_methods.hpp"

namespace realcam::bindings {

using namespace py::literals;

namespace {

/// Returns a function of a table that returns the array (S,) of f(surface).
template <class F>
auto by_surface(F&& f) {
    return [f](const SeidelTable& t) { return array_of(t.surfaces.size(), [&](auto i) { return f(t.surfaces[i]); }); };
}

/// Returns an array (S,) of one transverse aberration, mm.
template <double TransverseAberrations::* member>
py::array_t<double> transverse(const SeidelTable& t) {
    return array_of(t.surfaces.size(), [&](auto i) { return t.transverse(t.surfaces[i]).*member; });
}

void bind_seidel_table(py::module_& m) {
    using T = TransverseAberrations;
    using Row = const SeidelRow&;
    using Table = const SeidelTable&;
    py::class_<SeidelTable> table(
        m, "Seidel",
        R"(Third-order aberrations surface by surface: arrays of shape (S,), one entry for each of the lens's surfaces;
their sums are the aberrations of the lens. Transverse aberrations (mm) are those of a ray at the edge of the stop and
of the field, along y, with names and signs as in CODE V. See Lens.seidel.)");
    def_value(table);
    table.def_readonly("wavelength_nm", &SeidelTable::wavelength_nm, "Wavelength of the monochromatic aberrations.")
        .def_readonly("lagrange_invariant_mm", &SeidelTable::lagrange_invariant,
                      "Lagrange invariant of the marginal and the chief ray.")
        .def_property_readonly("marginal_height_mm", by_surface([](Row r) { return r.marginal.height; }),
                               "(S,): height of the paraxial ray through the edge of the stop.")
        .def_property_readonly("marginal_slope", by_surface([](Row r) { return r.marginal.slope; }),
                               "(S,): slope of the marginal ray behind each surface.")
        .def_property_readonly("marginal_invariant", by_surface([](Row r) { return r.marginal_invariant; }),
                               "(S,): refractive index times paraxial angle of incidence of the marginal ray.")
        .def_property_readonly("chief_height_mm", by_surface([](Row r) { return r.chief.height; }),
                               "(S,): height of the paraxial ray from the edge of the field through the centre of the "
                               "stop.")
        .def_property_readonly("chief_slope", by_surface([](Row r) { return r.chief.slope; }),
                               "(S,): slope of the chief ray behind each surface.")
        .def_property_readonly("chief_invariant", by_surface([](Row r) { return r.chief_invariant; }),
                               "(S,): refractive index times paraxial angle of incidence of the chief ray.")
        .def_property_readonly("spherical_mm", &transverse<&T::spherical>,
                               "(S,): transverse spherical aberration (CODE V: SA).")
        .def_property_readonly("tangential_coma_mm", &transverse<&T::tangential_coma>,
                               "(S,): transverse tangential coma (CODE V: TCO).")
        .def_property_readonly("tangential_astigmatism_mm", &transverse<&T::tangential_astigmatism>,
                               "(S,): transverse blur due to the tangential image surface (CODE V: TAS).")
        .def_property_readonly("sagittal_astigmatism_mm", &transverse<&T::sagittal_astigmatism>,
                               "(S,): transverse blur due to the sagittal image surface (CODE V: SAS).")
        .def_property_readonly("petzval_mm", &transverse<&T::petzval>,
                               "(S,): transverse blur due to the Petzval surface (CODE V: PTB).")
        .def_property_readonly("distortion_mm", &transverse<&T::distortion>,
                               "(S,): transverse distortion (CODE V: DST).")
        .def_property_readonly("axial_colour_mm", &transverse<&T::axial_colour>,
                               "(S,): transverse aberration of the marginal ray between the two colours (CODE V: AX).")
        .def_property_readonly("lateral_colour_mm", &transverse<&T::lateral_colour>,
                               "(S,): transverse aberration of the chief ray between the two colours (CODE V: LAT).")
        .def_property_readonly("petzval_curvature_per_mm", by_surface([](Row r) { return r.petzval_curvature; }),
                               "(S,): contributions to the curvature of the Petzval surface (CODE V: PTZ).")
        .def_property_readonly(
            "seidel_mm",
            [](Table t) {
                return table_of(t.surfaces.size(), 5, [&](auto i, auto k) { return t.surfaces[i].sums[k]; });
            },
            "(S, 5): Seidel sums S_I to S_V; S_I is positive for undercorrected spherical aberration.")
        .def_property_readonly(
            "colour_mm",
            [](Table t) {
                return table_of(t.surfaces.size(), 2, [&](auto i, auto k) { return t.surfaces[i].colour[k]; });
            },
            "(S, 2): chromatic sums C_I (axial colour) and C_II (lateral colour), short minus long wavelength.")
        .def_property_readonly(
            "coefficients_waves",
            [](Table t) {
                return table_of(t.surfaces.size(), 7, [&](auto i, auto k) {
                    const WaveCoefficients w = t.waves(t.surfaces[i]);
                    return std::array{w.w040, w.w131, w.w222, w.w220, w.w311, w.w020_colour, w.w111_colour}[k];
                });
            },
            R"((S, 7): wavefront coefficients W040, W131, W222, W220, W311, and the chromatic ones W020 and W111, in
waves: W = W040 r^4 + W131 h r^3 cos(phi) + W222 h^2 r^2 cos^2(phi) + W220 h^2 r^2 + W311 h^3 r cos(phi), with r the
pupil radius and h the field, both relative to their maximum, and phi the azimuth in the pupil from the y axis.)")
        .def("__repr__", [](Table t) {
            return "<realcam.Seidel " + counted(t.surfaces.size(), "surface") + " at " + digits(t.wavelength_nm) +
                   " nm>";
        });
}

SeidelTable make_seidel(const LensSystem& lens, double field_deg, std::optional<double> object_distance_m,
                        std::optional<double> wavelength_nm, std::pair<double, double> colours_nm) {
    const double wavelength = wavelength_or_design(lens, wavelength_nm);
    for (const double nm : {colours_nm.first, colours_nm.second}) wavelength_or_design(lens, nm);
    return seidel(lens, wavelength, field_from(field_deg, object_distance_m), colours_nm.first, colours_nm.second);
}

}  // namespace

void bind_seidel(py::module_& m) {
    bind_seidel_table(m);
    py::reinterpret_borrow<py::class_<LensSystem>>(m.attr("Lens"))
        .def(
            "seidel", &make_seidel, "field_deg"_a, py::kw_only(), "object_distance_m"_a = py::none(),
            "wavelength_nm"_a = py::none(), "colours_nm"_a = std::pair(kLineF_nm, kLineC_nm),
            R"(Computes third-order and primary chromatic aberrations surface by surface, including conics, aspheres and
mirrors (W. T. Welford, Aberrations of Optical Systems, chapters 8 and 10).
field_deg: angle of the paraxial chief ray to the axis; positive: the light travels towards +y on its way to the film.
object_distance_m: distance from the object plane to the front vertex, inf allowed; None: the plane in focus.
wavelength_nm: wavelength of the monochromatic aberrations; None: the design wavelength.
colours_nm: the short and the long wavelength of the chromatic aberrations.
Returns a Seidel. Raises InputError for an angle of 90 degrees or more, and for an afocal lens.)");
}

void bind_first_order(py::module_& m) {
    py::class_<FirstOrder> data(
        m, "FirstOrder",
        R"(First-order (paraxial) data at one wavelength. For an afocal lens the focal length, the focal distances and
the f-number are infinite.)");
    def_hashable_value(data);
    data.def_readonly("effective_focal_length_mm", &FirstOrder::effective_focal_length,
                      "1 / power. In an image space other than air the rear focal length is image_index times that.")
        .def_readonly("back_focal_distance_mm", &FirstOrder::back_focal_distance,
                      "Distance from the last vertex to the rear focal point.")
        .def_readonly("front_focal_distance_mm", &FirstOrder::front_focal_distance,
                      "Position of the front focal point, from the front vertex.")
        .def_readonly("f_number", &FirstOrder::f_number, "Focal length / diameter of the entrance pupil.")
        .def_readonly("entrance_pupil_position_mm", &FirstOrder::entrance_pupil_position,
                      "z of the entrance pupil, from the front vertex.")
        .def_readonly("entrance_pupil_diameter_mm", &FirstOrder::entrance_pupil_diameter,
                      "Diameter of the entrance pupil.")
        .def_readonly("exit_pupil_position_mm", &FirstOrder::exit_pupil_position,
                      "z of the exit pupil, from the front vertex.")
        .def_readonly("exit_pupil_diameter_mm", &FirstOrder::exit_pupil_diameter, "Diameter of the exit pupil.")
        .def_readonly("image_index", &FirstOrder::image_index, "Refractive index of the medium in front of the film.")
        .def("__repr__", [](const FirstOrder& d) {
            return "<realcam.FirstOrder focal length " + digits(d.effective_focal_length) + " mm, f/" +
                   digits(d.f_number) + ", back focal distance " + digits(d.back_focal_distance) + " mm>";
        });
    py::class_<Meridian> meridian(
        m, "Meridian",
        R"(First-order data of a lens in one of its two principal meridians: planes containing the chief ray of the film
centre; a ray launched in one of them stays in it. Without power, the focal length and the f-number are infinite. See
Lens.meridians.)");
    def_hashable_value(meridian);
    meridian
        .def_readonly("azimuth_deg", &Meridian::azimuth_deg,
                      "Azimuth of the plane in front of the lens, from the x axis towards y; -90 to 90.")
        .def_readonly("focal_length_mm", &Meridian::focal_length, "Focal length.")
        .def_readonly("back_focal_distance_mm", &Meridian::back_focal_distance,
                      "Distance from the last vertex to the focus of light from infinity.")
        .def_readonly("f_number", &Meridian::f_number, "Focal length / width of the entrance pupil.")
        .def_readonly("entrance_pupil_diameter_mm", &Meridian::entrance_pupil_diameter,
                      "Width of the entrance pupil in this plane.")
        .def("__repr__", [](const Meridian& d) {
            return "<realcam.Meridian at " + digits(d.azimuth_deg) + " deg, focal length " + digits(d.focal_length) +
                   " mm, f/" + digits(d.f_number) + '>';
        });
}

}  // namespace realcam::bindings
