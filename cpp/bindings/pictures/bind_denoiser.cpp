#include "../../denoise/denoiser.hpp"
#include "../bindings.hpp"
#include "../values/arrays.hpp"

namespace realcam::bindings {

using namespace py::literals;

namespace {

py::array_t<float> denoised(Denoiser& denoiser, const InputArray<float>& exposure, const InputArray<float>& albedo,
                            const InputArray<float>& normal, bool fast, const ProgressFunction& progress) {
    for (const auto* array : {&exposure, &albedo, &normal})
        if (array->ndim() != 3 || array->shape(0) != exposure.shape(0) || array->shape(1) != exposure.shape(1) ||
            array->shape(2) != 3 || array->size() == 0)
            throw InputError("exposure, albedo and normal must be arrays of (H, W, 3) numbers, of one H and W");
    const int width = static_cast<int>(exposure.shape(1)), height = static_cast<int>(exposure.shape(0));
    const NoisyPicture picture = {width, height, exposure.data(), albedo.data(), normal.data()};
    const Progress report = progress_of(progress);
    std::vector<float> result = [&] {
        const Unlocked unlocked;
        return denoiser.denoised(picture, fast ? DenoiseQuality::fast : DenoiseQuality::high,
                                 [&] { return report(0.0); });
    }();
    return array_from(std::move(result), {height, width, 3});
}

}  // namespace

void bind_denoiser(py::module_& m) {
    py::class_<Denoiser>(m, "_Denoiser")
        .def(py::init<const std::string&, int, const std::string&>(), "device"_a, "threads"_a, "library"_a,
             py::call_guard<Unlocked>())
        .def_property_readonly("name", &Denoiser::name)
        .def("denoised", &denoised, "exposure"_a, "albedo"_a, "normal"_a, "fast"_a, "progress"_a = py::none());
}

}  // namespace realcam::bindings
