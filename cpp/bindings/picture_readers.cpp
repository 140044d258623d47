#include "picture_readers.hpp"

#include <pybind11/stl.h>

#include <array>
#include <cstring>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"

namespace realcam::bindings {
namespace {

py::module_ pictures() {
    try {
        return py::module_::import("realcam._pictures");
    } catch (py::error_already_set& error) {
        if (!error.matches(PyExc_ImportError)) throw;
        throw ImageFileError("this build of realcam has no OpenImageIO, and cannot read pictures");
    }
}

template <class Value>
io::DecodedImage image_of(const py::array& array, bool is_linear) {
    const auto pixels = array.cast<InputArray<Value>>();
    return {static_cast<int>(pixels.shape(1)), static_cast<int>(pixels.shape(0)),
            std::vector<Value>(pixels.data(), pixels.data() + pixels.size()), is_linear};
}

std::optional<io::DecodedImage> read_texture(const std::string& path, std::span<const std::uint8_t> bytes) {
    const py::gil_scoped_acquire acquire;
    const auto encoded = py::memoryview::from_memory(bytes.data(), static_cast<py::ssize_t>(bytes.size()));
    const py::object result = pictures().attr("read_texture")(py::bytes(path), encoded);
    if (result.is_none()) return std::nullopt;
    const auto [pixels, is_linear, rec709] =
        result.cast<std::tuple<py::array, bool, std::optional<std::array<double, 9>>>>();
    io::DecodedImage image = py::isinstance<py::array_t<float>>(pixels) ? image_of<float>(pixels, is_linear)
                                                                        : image_of<std::uint8_t>(pixels, is_linear);
    image.rec709 = rec709;
    return image;
}

Environment read_environment(const std::string& path, const std::function<void(const std::string&)>& warn) {
    const py::gil_scoped_acquire acquire;
    const auto [pixels, warnings] = pictures()
                                        .attr("read_environment")(py::bytes(path))
                                        .cast<std::pair<InputArray<float>, std::vector<std::string>>>();
    for (const std::string& warning : warnings) warn(warning);
    Environment environment;
    environment.height = static_cast<std::int32_t>(pixels.shape(0));
    environment.width = static_cast<std::int32_t>(pixels.shape(1));
    environment.pixels.resize(static_cast<std::size_t>(pixels.size()) / 3);
    std::memcpy(environment.pixels.data(), pixels.data(), environment.pixels.size() * sizeof(Color));
    return environment;
}

}  // namespace

shot::PictureReaders picture_readers() {
    return {read_texture, read_environment};
}

}  // namespace realcam::bindings
