#include "../../optics/analysis/seidel.hpp"
#include "../../optics/lens/parabasal.hpp"

#include <pybind11/stl.h>

#include "../bindings.hpp"
#include "../values/arrays.hpp"
#include "../values/short_text.hpp"
#include "../values/value_methods.hpp"

namespace realcam::bindings {

using namespace py::literals;

template <>
struct RestoredCheck<ParaxialRay> : AnyMembers {};
template <>
struct RestoredCheck<SeidelRow> : AnyMembers {};
template <>
struct RestoredCheck<SeidelTable> : AnyMembers {};

namespace {

template <class F>
auto of_rows(F&& f) {
    return [f](const SeidelTable& t) { return array_of(t.surfaces.size(), [&](auto i) { return f(t.surfaces[i]); }); };
}

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
        R"(Third-order aberrations surface by surface: arrays of shape (S,), one entry for each of the lens's surfaces.
The sum over the surfaces is the lens's. Transverse aberrations are those of a ray at the edge of the stop and of
the field, along y; names and signs as CODE V's.)");
    def_value(table);
    table.def_readonly("wavelength_nm", &SeidelTable::wavelength_nm)
        .def_readonly("lagrange_invariant_mm", &SeidelTable::lagrange_invariant)
        .def_property_readonly("marginal_height_mm", of_rows([](Row r) { return r.marginal.height; }),
                               "(S,): paraxial ray to the edge of the stop.")
        .def_property_readonly("marginal_slope", of_rows([](Row r) { return r.marginal.slope; }),
                               "(S,): behind the surface.")
        .def_property_readonly("marginal_invariant", of_rows([](Row r) { return r.marginal_invariant; }),
                               "(S,): index times angle of incidence.")
        .def_property_readonly("chief_height_mm", of_rows([](Row r) { return r.chief.height; }),
                               "(S,): paraxial ray from the edge of the field through the middle of the stop.")
        .def_property_readonly("chief_slope", of_rows([](Row r) { return r.chief.slope; }), "(S,): behind the surface.")
        .def_property_readonly("chief_invariant", of_rows([](Row r) { return r.chief_invariant; }),
                               "(S,): index times angle of incidence.")
        .def_property_readonly("spherical_mm", &transverse<&T::spherical>, "(S,): SA.")
        .def_property_readonly("tangential_coma_mm", &transverse<&T::tangential_coma>, "(S,): TCO.")
        .def_property_readonly("tangential_astigmatism_mm", &transverse<&T::tangential_astigmatism>,
                               "(S,): TAS, the blur of the tangential image surface.")
        .def_property_readonly("sagittal_astigmatism_mm", &transverse<&T::sagittal_astigmatism>,
                               "(S,): SAS, the blur of the sagittal image surface.")
        .def_property_readonly("petzval_mm", &transverse<&T::petzval>, "(S,): PTB, the blur of the Petzval surface.")
        .def_property_readonly("distortion_mm", &transverse<&T::distortion>, "(S,): DST.")
        .def_property_readonly("axial_colour_mm", &transverse<&T::axial_colour>,
                               "(S,): AX, between the two colours, of the marginal ray.")
        .def_property_readonly("lateral_colour_mm", &transverse<&T::lateral_colour>, "(S,): LAT, of the chief ray.")
        .def_property_readonly("petzval_curvature_per_mm", of_rows([](Row r) { return r.petzval_curvature; }),
                               "(S,): PTZ; their sum is the curvature of the Petzval surface.")
        .def_property_readonly(
            "seidel_mm",
            [](Table t) {
                return table_of(t.surfaces.size(), 5, [&](auto i, auto k) { return t.surfaces[i].sums[k]; });
            },
            "(S, 5): the Seidel sums S_I to S_V; a positive S_I is an undercorrected surface's.")
        .def_property_readonly(
            "colour_mm",
            [](Table t) {
                return table_of(t.surfaces.size(), 2, [&](auto i, auto k) { return t.surfaces[i].colour[k]; });
            },
            "(S, 2): C_I and C_II, axial and lateral colour, short less long wavelength.")
        .def_property_readonly(
            "coefficients_waves",
            [](Table t) {
                return table_of(t.surfaces.size(), 7, [&](auto i, auto k) {
                    const WaveCoefficients w = t.waves(t.surfaces[i]);
                    return std::array{w.w040, w.w131, w.w222, w.w220, w.w311, w.w020_colour, w.w111_colour}[k];
                });
            },
            R"((S, 7): W040, W131, W222, W220, W311, and of colour W020, W111, in
W = W040 r^4 + W131 h r^3 cos + W222 h^2 r^2 cos^2 + W220 h^2 r^2 + W311 h^3 r cos, with r and h as shares of the
pupil's radius and of the field.)")
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
        .def("seidel", &make_seidel, "field_deg"_a, py::kw_only(), "object_distance_m"_a = py::none(),
             "wavelength_nm"_a = py::none(), "colours_nm"_a = std::pair(kLineF_nm, kLineC_nm),
             R"(Third-order and primary chromatic aberrations, surface by surface, with conics, aspheres and mirrors
(W. T. Welford, Aberrations of Optical Systems, chapters 8 and 10).
field_deg: angle of the paraxial chief ray to the axis; positive: it rises towards +y and the film.
object_distance_m: object plane to front vertex, inf allowed; None is the plane in focus.
colours_nm: the short and the long wavelength.
Returns a Seidel. Raises InputError for angles of 90 deg and more, and for an afocal lens.)");
}

using namespace py::literals;

void bind_first_order(py::module_& m) {
    py::class_<FirstOrder> data(
        m, "FirstOrder",
        R"(First-order data at one wavelength. mm; positions from the front vertex. The effective focal length is 1 / power;
in an image space of another index than air the rear one is image_index times that. Of an afocal lens the focal length,
the focal distances and the f-number are infinite.)");
    def_hashable_value(data);
    data.def_readonly("effective_focal_length_mm", &FirstOrder::effective_focal_length)
        .def_readonly("back_focal_distance_mm", &FirstOrder::back_focal_distance)
        .def_readonly("front_focal_distance_mm", &FirstOrder::front_focal_distance)
        .def_readonly("f_number", &FirstOrder::f_number)
        .def_readonly("entrance_pupil_position_mm", &FirstOrder::entrance_pupil_position)
        .def_readonly("entrance_pupil_diameter_mm", &FirstOrder::entrance_pupil_diameter)
        .def_readonly("exit_pupil_position_mm", &FirstOrder::exit_pupil_position)
        .def_readonly("exit_pupil_diameter_mm", &FirstOrder::exit_pupil_diameter)
        .def_readonly("image_index", &FirstOrder::image_index, "Refractive index of the medium before the film.")
        .def("__repr__", [](const FirstOrder& d) {
            return "<realcam.FirstOrder focal length " + digits(d.effective_focal_length) + " mm, f/" +
                   digits(d.f_number) + ", back focal distance " + digits(d.back_focal_distance) + " mm>";
        });
    py::class_<Meridian> meridian(
        m, "Meridian",
        R"(A lens in one of its two principal meridians: planes through the chief ray of the film's middle in which
light stays. mm; without power the focal length and the f-number are infinite.)");
    def_hashable_value(meridian);
    meridian
        .def_readonly("azimuth_deg", &Meridian::azimuth_deg,
                      "Of the plane in front of the lens, from the x axis towards y; -90 to 90.")
        .def_readonly("focal_length_mm", &Meridian::focal_length)
        .def_readonly("back_focal_distance_mm", &Meridian::back_focal_distance,
                      "Last vertex to the focus of distant light.")
        .def_readonly("f_number", &Meridian::f_number)
        .def_readonly("entrance_pupil_diameter_mm", &Meridian::entrance_pupil_diameter)
        .def("__repr__", [](const Meridian& d) {
            return "<realcam.Meridian at " + digits(d.azimuth_deg) + " deg, focal length " + digits(d.focal_length) +
                   " mm, f/" + digits(d.f_number) + '>';
        });
}

}  // namespace realcam::bindings
