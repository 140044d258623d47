#pragma once
#include <cstddef>
#include <limits>
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

/// A mean; 0 of nothing.
inline float mean(double sum, double weight) {
    return weight > 0 ? static_cast<float>(sum / weight) : 0.0f;
}

}  // namespace layer_film_detail

/// Of kSampledLayers and kMiddleLayers, those that are wanted.
inline std::vector<LayerImage> developed(const LayerFilm& film, LayerSet wanted, const SurfaceIds& ids) {
    using namespace layer_film_detail;
    std::vector<LayerImage> images;
    const auto add = [&](Layer layer, auto&& make) {
        if (wanted.has(layer)) images.push_back(make(layer));
    };
    add(Layer::normal, [&](Layer layer) {
        return made(layer, film.sums, [](const LayerSum& sum, float* out) {
            for (int c = 0; c < 3; ++c) out[c] = mean(sum.normal[c], sum.met);
        });
    });
    add(Layer::albedo, [&](Layer layer) {
        return made(layer, film.sums, [](const LayerSum& sum, float* out) {
            for (int c = 0; c < 3; ++c) out[c] = mean(sum.albedo[c], sum.met);
        });
    });
    add(Layer::circle_of_confusion_mm, [&](Layer layer) {
        return made(layer, film.sums, [](const LayerSum& sum, float* out) {
            *out = sum.weight > 0 ? mean(sum.circle_mm, sum.weight) : std::numeric_limits<float>::quiet_NaN();
        });
    });
    add(Layer::depth_middle, [&](Layer layer) {
        return made(layer, film.middle, [](const MiddleSurface& surface, float* out) { *out = surface.depth; });
    });
    add(Layer::normal_middle, [&](Layer layer) {
        return made(layer, film.middle, [](const MiddleSurface& surface, float* out) {
            out[0] = surface.normal.x;
            out[1] = surface.normal.y;
            out[2] = surface.normal.z;
        });
    });
    add(Layer::object_id, [&](Layer layer) {
        return numbered(layer, film.middle, [&](const MiddleSurface& surface) { return ids.object(surface); });
    });
    add(Layer::material_id, [&](Layer layer) {
        return numbered(layer, film.middle, [&](const MiddleSurface& surface) { return ids.material(surface); });
    });
    return images;
}

}  // namespace REALCAM_NAMESPACE
