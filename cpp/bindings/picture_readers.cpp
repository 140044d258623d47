#include "picture_readers.hpp"

#include <cstring>

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

std::optional<io::DecodedImage> read_texture(const std::string& path, std::span<const std::uint8_t> bytes) {
    const py::gil_scoped_acquire acquire;
    const auto encoded = py::memoryview::from_memory(bytes.data(), static_cast<py::ssize_t>(bytes.size()));
    const py::object result = pictures().attr("read_texture")(py::bytes(path), encoded);
    if (result.is_none()) return std::nullopt;
    const auto pixels = result.cast<InputArray<std::uint8_t>>();
    return io::DecodedImage{static_cast<int>(pixels.shape(1)),
                            static_cast<int>(pixels.shape(0)),
                            {pixels.data(), pixels.data() + pixels.size()}};
}

Environment read_environment(const std::string& path) {
    const auto pixels = pictures().attr("read_environment")(py::bytes(path)).cast<InputArray<float>>();
    Environment environment;
    environment.height = static_cast<std::int32_t>(pixels.shape(0));
    environment.width = static_cast<std::int32_t>(pixels.shape(1));
    environment.pixels.resize(static_cast<std::size_t>(pixels.size()) / 3);
    std::memcpy(environment.pixels.data(), pixels.data(), environment.pixels.size() * sizeof(Vec3f));
    return environment;
}

}  // namespace

shot::PictureReaders picture_readers() {
    return {read_texture, read_environment};
}

}  // namespace realcam::bindings
