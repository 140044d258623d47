#pragma once
#include <cstddef>
#include <vector>

#include "layer_sum.hpp"
#include "layers.hpp"
#include "surface_ids.hpp"

namespace REALCAM_NAMESPACE {

/// What the layers of a film have collected, row by row. Empty: nothing of the kind yet.
struct LayerFilm {
    std::vector<LayerSum> sums;
    std::vector<MiddleSurface> middle;
};

namespace layer_film_detail {

/// f(pixel, out) for each pixel's values.
template <class Pixel, class F>
LayerImage made(Layer layer, const std::vector<Pixel>& film, F&& f) {
    const std::size_t channels = static_cast<std::size_t>(info_of(layer).channels);
    LayerImage image{layer, std::vector<float>(channels * film.size()), {}};
    for (std::size_t i = 0; i < film.size(); ++i) f(film[i], &image.values[channels * i]);
    return image;
}

template <class F>
LayerImage numbered(Layer layer, const std::vector<MiddleSurface>& film, F&& f) {
    LayerImage image{layer, {}, {}};
    image.numbers.reserve(film.size());
    for (const MiddleSurface& surface : film) image.numbers.push_back(f(surface));
    return image;
}

}  // namespace layer_film_detail

/// The wanted layers among kSampledLayers and kMiddleLayers, but motion. `origin_m`: of the scene as it was placed.
std::vector<LayerImage> developed(const LayerFilm& film, LayerSet wanted, const SurfaceIds& ids, Vec3d origin_m);

}  // namespace REALCAM_NAMESPACE
