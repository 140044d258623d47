#include "python_image.hpp"

#include "../bindings.hpp"
#include "../values/arrays.hpp"

namespace realcam::bindings {

using namespace py::literals;

namespace {

py::tuple texts_from(const IdNames& names) {
    py::tuple texts(names.size());
    for (std::size_t i = 0; i < names.size(); ++i) texts[i] = text_from(names[i]);
    return texts;
}

/// Returns a layer as an array (H, W) or (H, W, channels).
py::array array_of_layer(LayerImage layer, py::ssize_t height, py::ssize_t width) {
    const LayerInfo& info = info_of(layer.layer);
    if (info.is_number) return array_from(std::move(layer.numbers), {height, width});
    if (info.channels == 1) return array_from(std::move(layer.values), {height, width});
    return array_from(std::move(layer.values), {height, width, info.channels});
}

}  // namespace

PythonImage python_image(Image image, const Camera& camera, const RenderSettings& settings, const std::string& plan) {
    const py::array pixels = array_from(std::move(image.exposure), {image.height, image.width, 3}),
                    depth = array_from(std::move(image.depth), {image.height, image.width});
    py::dict arrays;
    if (settings.layers.has(Layer::depth)) arrays[info_of(Layer::depth).name] = depth;
    for (LayerImage& layer : image.layers)
        arrays[info_of(layer.layer).name] = array_of_layer(std::move(layer), image.height, image.width);
    return py::module_::import("realcam.image")
        .attr("Image")("pixels"_a = pixels, "depth"_a = depth, "camera"_a = camera, "spp"_a = image.spp,
                       "seed"_a = settings.seed, "stats"_a = image.stats, "layers"_a = arrays,
                       "object_names"_a = texts_from(image.object_names),
                       "material_names"_a = texts_from(image.material_names), "settings"_a = settings, "plan"_a = plan,
                       "shortfall"_a = image.shortfall);
}

io::ImageMetadata metadata_of(const PythonImage& image) {
    io::ImageMetadata metadata =
        io::metadata_of(attribute_of<Camera>(image, "camera"), attribute_of<RenderSettings>(image, "settings"));
    metadata.spp = attribute_of<int>(image, "spp");
    metadata.seed = attribute_of<std::uint32_t>(image, "seed");
    metadata.denoiser = attribute_of<std::string>(image, "denoiser");
    metadata.plan = attribute_of<std::string>(image, "plan");
    return metadata;
}

}  // namespace realcam::bindings
