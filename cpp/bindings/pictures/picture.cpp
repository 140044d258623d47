#include "picture.hpp"

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

PictureFields picture_from(Image image, LayerSet layers) {
    const py::array pixels = array_from(std::move(image.exposure), {image.height, image.width, 3}),
                    depth = array_from(std::move(image.depth), {image.height, image.width});
    py::dict arrays;
    if (layers.has(Layer::depth)) arrays[info_of(Layer::depth).name] = depth;
    for (LayerImage& layer : image.layers)
        arrays[info_of(layer.layer).name] = array_of_layer(std::move(layer), image.height, image.width);
    return py::dict("pixels"_a = pixels, "depth"_a = depth, "spp"_a = image.spp, "stats"_a = image.stats,
                    "layers"_a = arrays, "object_names"_a = texts_from(image.object_names),
                    "material_names"_a = texts_from(image.material_names), "shortfall"_a = image.shortfall);
}

}  // namespace realcam::bindings
