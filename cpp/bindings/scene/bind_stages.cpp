// Stages of USD: registers the functions of realcam.usd, which reads them, as the stage reader of the core.

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "../../io/scene_file.hpp"
#include "../../io/stage_reader.hpp"
#include "../bindings.hpp"
#include "../values/arrays.hpp"
#include "picture_readers.hpp"

namespace realcam::bindings {

using namespace py::literals;

namespace {

/// Calls a function of realcam.usd and converts its result. Its errors keep their kind, because commands in C++ report
/// them too. May be called with or without the GIL.
template <class Result, class... Arguments>
Result call_usd(const char* function, const std::string& path, const Arguments&... arguments) {
    const py::gil_scoped_acquire locked;
    try {
        return py::module_::import("realcam.usd").attr(function)(text_from(path), arguments...).template cast<Result>();
    } catch (py::error_already_set& error) {
        const py::module_ core = py::module_::import("realcam._core");
        const auto message = [&] { return path_from(py::str(error.value())); };
        if (error.matches(core.attr("InputError"))) throw InputError(message());
        if (error.matches(core.attr("SceneFileError"))) throw SceneFileError(message());
        if (error.matches(core.attr("Cancelled"))) throw Cancelled();
        throw;
    }
}

/// Reads the bytes of a .glb; see io::read_glb.
Assembly read_glb(const PathLike& path, const py::bytes& glb, std::vector<std::string> warnings, double scale,
                  const std::vector<std::string>& objects) {
    const std::string name = path_from(path);
    std::string bytes = glb;
    const Unlocked unlocked;
    return io::read_glb(name, std::move(bytes), std::move(warnings), {scale, objects, heed_signals},
                        picture_readers().texture);
}

/// Returns the values of a picture as stored in its file, (H, W, 4): uint8, or float32 with 16-bit values as fractions
/// of the largest. `path`: its file; empty: `bytes` are those of a PNG or JPEG. Throws ImageFileError.
Typed<"NDArray[uint8] | NDArray[float32]", py::array> read_texture(const PathLike& path, const py::bytes& bytes) {
    const std::string name = path_from(path), encoded = bytes;
    std::optional<io::DecodedImage> image;
    {
        const Unlocked unlocked;
        const auto* data = reinterpret_cast<const std::uint8_t*>(encoded.data());
        image = picture_readers().texture(name, {data, encoded.size()});
    }
    if (!image || !io::is_whole(*image)) throw ImageFileError("is not a picture");
    const std::vector<py::ssize_t> shape = {image->height, image->width, 4};
    return std::visit([&](const auto& values) -> py::array { return py::array_t(shape, values.data()); }, image->rgba);
}

}  // namespace

void bind_stages(py::module_& m) {
    m.def("_read_glb", &read_glb, "path"_a, "glb"_a, "warnings"_a, "scale"_a, "objects"_a,
          "Internal. Returns the Scene of the bytes of a .glb. path: names it in messages. warnings: precede those of "
          "the reader. scale, objects: see Scene.load.");
    m.def(
        "_read_texture", &read_texture, "path"_a, "bytes"_a,
        "Internal. Returns the values of a picture as stored, (H, W, 4): uint8 or float32. path: its file; \"\": bytes "
        "are those of a PNG or JPEG. Raises ImageFileError.");
    io::set_stage_reader(
        {[](const std::string& path, const io::SceneFileOptions& options) {
             return call_usd<Assembly>("read_stage", path, options.scale, options.objects, options.variants);
         },
         [](const std::string& path, const io::SceneFileOptions& options, const std::string& camera) {
             return call_usd<std::string>("camera_settings", path, options.scale, options.variants, camera);
         }});
}

}  // namespace realcam::bindings
