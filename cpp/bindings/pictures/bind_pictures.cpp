// Internal functions that read and write image files. Their paths are bytes objects, from os.fsencode.

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "../../image_io/image_file.hpp"
#include "../../io/files/regular_file.hpp"
#include "../../io/text/printable.hpp"
#include "../bindings.hpp"
#include "python_image.hpp"
#include "python_view.hpp"

namespace realcam::bindings {

using namespace py::literals;

namespace {

/// Pixels (H, W, 3), linear, and the reader's warnings.
using PixelsAndWarnings = Typed<"tuple[NDArray[float32], list[str]]", py::tuple>;

/// Returns the pixels that `read` reads, an Environment; it receives a function for its warnings.
template <class Read>
PixelsAndWarnings pixels_of(const Read& read) {
    Environment environment;
    std::vector<std::string> warnings;
    {
        const Unlocked unlocked;
        environment = read([&](const std::string& warning) { warnings.push_back(warning); });
    }
    py::array_t<float> pixels({environment.height, environment.width, 3});
    std::memcpy(pixels.mutable_data(), environment.pixels.data(), environment.pixels.size() * sizeof(Vec3f));
    return py::make_tuple(pixels, warnings);
}

/// `layer`: of an OpenEXR file; "" for the main image.
PixelsAndWarnings read_environment(const py::bytes& path, const std::string& layer) {
    return pixels_of([&, file = std::string(path)](const image_io::WarnOf& warn) {
        return image_io::read_environment(file, layer, warn, heed_signals);
    });
}

PixelsAndWarnings read_picture(const py::bytes& path) {
    return pixels_of([file = std::string(path)](const image_io::WarnOf& warn) {
        return image_io::read_picture(file, warn, heed_signals);
    });
}

using FloatArray = py::array_t<float, py::array::c_style | py::array::forcecast>;

/// Returns views of the layers in a dict of arrays by name. `depth`: the depth layer, whose shape is that of the
/// picture. `arrays` receives the arrays to which the views refer; it must outlive them. Throws InputError for other
/// shapes.
std::vector<image_io::PictureView::Layer> layers_from(const py::dict& layers, const FloatArray& depth,
                                                      std::vector<py::array>& arrays) {
    std::vector<image_io::PictureView::Layer> views;
    for (std::size_t i = 0; i < kLayers.size(); ++i) {
        const LayerInfo& info = kLayers[i];
        if (!layers.contains(info.name) || static_cast<Layer>(i) == Layer::depth) continue;
        const py::object values = layers[info.name];
        py::array array;
        if (info.is_number)
            array = py::array_t<std::uint32_t, py::array::c_style | py::array::forcecast>(values);
        else
            array = FloatArray(values);
        if (array.ndim() != (info.channels == 1 ? 2 : 3) || array.shape(0) != depth.shape(0) ||
            array.shape(1) != depth.shape(1) || (array.ndim() == 3 && array.shape(2) != info.channels))
            throw InputError("the layer \"" + std::string(info.name) + "\" must have the shape (H, W" +
                             (info.channels == 1 ? ")" : ", " + std::to_string(info.channels) + ")") +
                             " of the picture");
        views.push_back({static_cast<Layer>(i), array.data()});
        arrays.push_back(std::move(array));
    }
    return views;
}

/// Writes a realcam.Image to a file. `tone`: see view_from. `color_space`: of .exr files, a name of kExrColorSpaces.
void write_picture(const py::bytes& path, const PythonImage& image, const Typed<"str | OcioView", py::object>& tone,
                   const std::string& color_space) {
    const std::shared_ptr<const View> view = view_from(tone);
    const std::optional<ExrColorSpace> exr_color_space = value_named(kExrColorSpaces, color_space);
    if (!exr_color_space)
        throw InputError("exr_color_space must be " + one_of(kExrColorSpaces) + "; it is " +
                         io::in_quotes(color_space));
    const auto exposure = attribute_of<FloatArray>(image, "pixels"), depth = attribute_of<FloatArray>(image, "depth");
    if (exposure.ndim() != 3 || exposure.shape(2) != 3 || depth.ndim() != 2 || depth.shape(0) != exposure.shape(0) ||
        depth.shape(1) != exposure.shape(1))
        throw InputError("the picture's pixels must have the shape (H, W, 3), and its depth (H, W)");
    std::vector<py::array> layer_arrays;
    const image_io::PictureView picture{static_cast<int>(depth.shape(1)),
                                        static_cast<int>(depth.shape(0)),
                                        exposure.data(),
                                        depth.data(),
                                        layers_from(py::dict(image.attr("layers")), depth, layer_arrays),
                                        attribute_of<IdNames>(image, "object_names"),
                                        attribute_of<IdNames>(image, "material_names")};
    const io::ImageMetadata metadata = metadata_of(image);
    const std::string file = path;
    const Unlocked unlocked;
    image_io::write_image(picture, file, metadata, *view, *exr_color_space, heed_signals);
}

/// Returns the metadata of picture files, text by name.
Typed<"dict[str, str]", py::dict> metadata_entries(const PythonImage& image) {
    py::dict entries;
    for (const auto& [name, value] : metadata_of(image).entries()) entries[py::str(name)] = value;
    return entries;
}

/// Metadata of an image file: pairs (name, value).
using Entries = std::vector<std::pair<std::string, std::string>>;

/// Returns the exposure (H, W, 3) in lux seconds and the metadata of an image file that realcam has written.
Typed<"tuple[NDArray[float32], list[tuple[str, str]]]", py::tuple> read_film(const py::bytes& path) {
    const std::string file = path;
    image_io::FilmFile film;
    {
        const Unlocked unlocked;
        film = image_io::read_film(file, heed_signals);
    }
    py::array_t<float> exposure({film.height, film.width, 3});
    std::memcpy(exposure.mutable_data(), film.exposure.data(), film.exposure.size() * sizeof(float));
    return py::make_tuple(exposure, film.entries);
}

/// Writes 8-bit display values (H, W, 3) to a file. `is_srgb`: true if the file declares sRGB.
void write_codes(const py::bytes& path, const py::array_t<std::uint8_t, py::array::c_style>& codes,
                 const Entries& entries, bool is_srgb) {
    if (codes.ndim() != 3 || codes.shape(2) != 3) throw InputError("expected 8-bit values of shape (H, W, 3)");
    const std::string file = path;
    const Unlocked unlocked;
    image_io::write_codes(file, static_cast<int>(codes.shape(1)), static_cast<int>(codes.shape(0)), codes.data(),
                          entries, is_srgb, heed_signals);
}

/// Returns the content of a regular file. Throws InputError, whose message is the reason without the path.
py::bytes read_file(const PathLike& path, std::uint64_t max_bytes) {
    const std::string name = path_from(path);
    std::string content;
    try {
        const Unlocked unlocked;
        if (io::RegularFile(name).size() > max_bytes)
            throw io::FileError(name, "has more than " + std::to_string(max_bytes >> 20) + " MB");
        Checkpoint checkpoint(heed_signals);
        content = io::read_whole_file(name, checkpoint);
    } catch (const io::FileError& error) {
        throw InputError(error.reason);
    }
    return content;
}

}  // namespace

void bind_pictures(py::module_& m) {
    m.def("_read_environment", &read_environment, "path"_a, "layer"_a,
          "Internal: use realcam.read_environment. Returns the pixels (H, W, 3) and a list of warnings.");
    m.def("_read_picture", &read_picture, "path"_a,
          "Internal: use realcam.image_file.read_picture. Returns the pixels (H, W, 3) and a list of warnings.");
    m.def("_write_picture", &write_picture, "path"_a, "image"_a, "tone"_a, "exr_color_space"_a,
          "Internal: use Image.save.");
    m.def("_metadata", &metadata_entries, "image"_a,
          "Internal: use Image.metadata. Returns the metadata of picture files, text by name.");
    m.def("_write_codes", &write_codes, "path"_a, "codes"_a, "entries"_a, "is_srgb"_a,
          "Internal. Writes 8-bit display values (H, W, 3) with metadata, pairs (name, value), to an image file. "
          "is_srgb: True if it declares sRGB.");
    m.def("_read_file", &read_file, "path"_a, "max_bytes"_a,
          "Internal. Returns the content of a regular file of at most max_bytes. Raises InputError with the reason.");
    register_ocio();
    m.def("_read_film", &read_film, "path"_a,
          "Internal. Returns the exposure (H, W, 3) in lux seconds and the metadata, pairs (name, value), of a file.");
}

}  // namespace realcam::bindings
