// Derivatives of pictures by the numbers of their camera, for realcam.render_gradient.

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <memory>
#include <optional>
#include <string>

#include "../../devices/devices.hpp"
#include "../../render/gradients/camera_gradient.hpp"
#include "../bindings.hpp"
#include "../lens/lens_variables.hpp"
#include "../values/arrays.hpp"

namespace realcam::bindings {

using namespace py::literals;

namespace {

/// Returns the numbers of a picture-sized array (H, W, 3). Throws InputError if its shape differs.
const float* picture_of(const InputArray<float>& array, const CameraGradient& of, const char* name) {
    if (array.ndim() != 3 || array.shape(0) != of.height() || array.shape(1) != of.width() || array.shape(2) != 3)
        throw InputError(std::string(name) + " must be an array of shape (" + std::to_string(of.height()) + ", " +
                         std::to_string(of.width()) + ", 3), like the picture");
    return array.data();
}

const float* control_of(const std::optional<InputArray<float>>& array, const CameraGradient& of) {
    return array ? picture_of(*array, of, "control") : nullptr;
}

/// Throws InputError if a number of samples is out of range.
GradientSamples samples_of(std::int64_t seed, int spp, int outline_spp, const std::string& terms, bool pairs) {
    validate_spp(spp);
    if (outline_spp < 1 || outline_spp > (1 << 24)) throw InputError("outline_spp must lie between 1 and 16777216");
    if (terms != "both" && terms != "interior" && terms != "boundary")
        throw InputError("terms must be \"both\", \"interior\" or \"boundary\"");
    return {.seed = seed_from(seed),
            .spp = spp,
            .outline_spp = outline_spp,
            .pairs = pairs,
            .interior = terms != "boundary",
            .boundary = terms != "interior"};
}

}  // namespace

void bind_picture_gradient(py::module_& m) {
    const auto new_gradient = [](const Assembly& scene, const Camera& camera, const RenderSettings& settings,
                                 const Variables& variables, const std::string& device) {
        std::vector<LensVariable> list = variables_from(variables);
        const Unlocked unlocked;
        return make_gradient(device, scene, camera, settings, std::move(list));
    };
    const auto picture = [](CameraGradient& self, std::int64_t seed, int spp, bool uniform) {
        GradientSamples samples = samples_of(seed, spp, 1, "both", false);
        samples.uniform = uniform;
        std::vector<float> exposure;
        {
            const Unlocked unlocked;
            exposure = self.picture(samples, heed_signals);
        }
        return array_from(std::move(exposure), {self.height(), self.width(), 3});
    };
    const auto reverse = [](CameraGradient& self, const InputArray<float>& adjoint,
                            const std::optional<InputArray<float>>& control, std::int64_t seed, int spp,
                            int outline_spp, const std::string& terms, bool pairs) {
        const GradientSamples samples = samples_of(seed, spp, outline_spp, terms, pairs);
        const float *of = picture_of(adjoint, self, "adjoint"), *less = control_of(control, self);
        std::vector<double> gradient;
        {
            const Unlocked unlocked;
            gradient = self.reverse(of, less, samples, heed_signals);
        }
        const auto count = static_cast<py::ssize_t>(gradient.size());
        return array_from(std::move(gradient), {count});
    };
    const auto forward = [](CameraGradient& self, const InputArray<double>& directions,
                            const std::optional<InputArray<float>>& control, std::int64_t seed, int spp,
                            int outline_spp, const std::string& terms, bool pairs) {
        const GradientSamples samples = samples_of(seed, spp, outline_spp, terms, pairs);
        const float* less = control_of(control, self);
        const auto numbers = static_cast<py::ssize_t>(self.number_count());
        if (directions.ndim() != 2 || directions.shape(1) != numbers)
            throw InputError("directions must be an array of shape (P, " + std::to_string(numbers) + ")");
        const std::vector<double> list(directions.data(), directions.data() + directions.size());
        std::vector<float> pictures;
        {
            const Unlocked unlocked;
            pictures = self.forward(list, less, samples, heed_signals);
        }
        return array_from(std::move(pictures), {directions.shape(0), self.height(), self.width(), 3});
    };
    py::class_<CameraGradient>(m, "_PictureGradient", "Internal: use realcam.render_gradient.")
        .def(py::init(new_gradient), "scene"_a, "camera"_a, "settings"_a, "variables"_a, "device"_a,
             R"(Prepares derivatives of a picture. variables: see Lens._ray_derivatives.
device: as for render; several GPUs are refused.
The numbers of a camera are, in this order: the variables; translation (mm) and rotation (rad) of the film about its
centre relative to the camera, along the film's axes; translation and rotation of the camera, along the camera's axes;
the radius of the diaphragm (mm); and a common factor of the semi-diameters of all surfaces but the stop.)")
        .def(
            "picture", picture, py::kw_only(), "seed"_a, "spp"_a, "uniform"_a = false,
            R"(Returns the picture with the filter, (H, W, 3), in lux seconds. uniform: of uniform light of radiance 1.)")
        .def("reverse", reverse, "adjoint"_a, "control"_a, py::kw_only(), "seed"_a, "spp"_a, "outline_spp"_a,
             "terms"_a = "both", "pairs"_a = true,
             R"(Returns the derivatives of sum(adjoint * picture) by all numbers of the camera, (N,).
adjoint: (H, W, 3). control: control variate of the radiance, (H, W, 3), or None; derivatives by the pose are then those
of picture - control * uniform picture. terms: "both", or one of "interior" and "boundary", for tests.
pairs: False: all samples on the film are independent, for comparison.)")
        .def("forward", forward, "directions"_a, "control"_a, py::kw_only(), "seed"_a, "spp"_a, "outline_spp"_a,
             "terms"_a = "both", "pairs"_a = true,
             R"(Returns the derivatives of the picture along directions (P, N) of the numbers, (P, H, W, 3).)")
        .def_property_readonly("scene_moves", &CameraGradient::scene_moves,
                               "True if the scene moves during the exposure.")
        .def_property_readonly("number_count", &CameraGradient::number_count, "Number of numbers of the camera, N.")
        .def_property_readonly(
            "unexplained_edges",
            [](const CameraGradient& self) { return std::pair(self.unexplained_edges(), self.all_edges()); },
            "Edges of the pupil that no rim explains, and lines on which edges were sought, in the last call of "
            "reverse.");
}

}  // namespace realcam::bindings
