#pragma once
#include <cstddef>
#include <vector>

#include "layer_sum.hpp"
#include "layers.hpp"
#include "surface_ids.hpp"

namespace REALCAM_NAMESPACE {

/// Accumulated layers of a film, row by row. A vector is empty before its layers are computed.
struct LayerFilm {
    std::vector<LayerSum> sums;
    std::vector<PixelCentreSurface> middle;
};

namespace layer_film_detail {

/// Makes an image of a layer; f(pixel, out) writes the values of each pixel.
template <class Pixel, class F>
LayerImage made(Layer layer, const std::vector<Pixel>& film, F&& f) {
    const std::size_t channels = static_cast<std::size_t>(info_of(layer).channels);
    LayerImage image{layer, std::vector<float>(channels * film.size()), {}};
    for (std::size_t i = 0; i < film.size(); ++i) f(film[i], &image.values[channels * i]);
    return image;
}

template <class F>
LayerImage numbered(Layer layer, const std::vector<PixelCentreSurface>& film, F&& f) {
    LayerImage image{layer, {}, {}};
    image.numbers.reserve(film.size());
    for (const PixelCentreSurface& surface : film) image.numbers.push_back(f(surface));
    return image;
}

}  // namespace layer_film_detail

/// The requested layers among kSampledLayers and kPixelCentreLayers, except motion. `origin_m`: origin of the placed
/// scene.
std::vector<LayerImage> developed(const LayerFilm& film, LayerSet wanted, const SurfaceIds& ids, Vec3d origin_m);

}  // namespace REALCAM_NAMESPACE
