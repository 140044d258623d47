// The internal class _Denoiser, for realcam.denoiser.

#include "../../denoise/denoiser.hpp"
#include "../bindings.hpp"
#include "../values/arrays.hpp"

namespace realcam::bindings {

using namespace py::literals;

namespace {

/// Returns the denoised exposure, an array (H, W, 3). All inputs have that shape. `progress` is called with 0, because
/// the denoiser does not report its progress.
py::array_t<float> denoised(Denoiser& denoiser, const InputArray<float>& exposure, const InputArray<float>& albedo,
                            const InputArray<float>& normal, bool fast, const ProgressFunction& progress) {
    for (const auto* array : {&exposure, &albedo, &normal})
        if (array->ndim() != 3 || array->shape(0) != exposure.shape(0) || array->shape(1) != exposure.shape(1) ||
            array->shape(2) != 3 || array->size() == 0)
            throw InputError("exposure, albedo and normal must be arrays of the same shape (H, W, 3)");
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
    py::class_<Denoiser>(m, "_Denoiser", "Internal: use realcam.denoise. Open Image Denoise on a device.")
        .def(py::init<const std::string&, int, const std::string&>(), "device"_a, "threads"_a, "library"_a,
             py::call_guard<Unlocked>(),
             "device: as for realcam.render. threads: of the CPU, 0 for all. library: path of the shared library, or "
             "\"\".")
        .def_property_readonly("name", &Denoiser::name, "Name of the denoiser, for metadata.")
        .def("denoised", &denoised, "exposure"_a, "albedo"_a, "normal"_a, "fast"_a, "progress"_a = py::none(),
             "Returns the denoised exposure. All arrays have the shape (H, W, 3). fast: lower quality in less time.");
}

}  // namespace realcam::bindings
