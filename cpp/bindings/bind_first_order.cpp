#include "../optics/lens/parabasal.hpp"
#include "bindings.hpp"
#include "short_text.hpp"
#include "value_methods.hpp"

namespace realcam::bindings {

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
