#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "../../scene/assembly.hpp"
#include "../../scene/geometry/surface_point.hpp"
#include "layer_sum.hpp"
#include "layers.hpp"

namespace REALCAM_NAMESPACE {

/// Ids of the objects and materials of a scene. Objects: 1 is static geometry, and instances follow in their order.
/// Materials: from 1 on, those of static geometry, then those of each object, in the order in which it is first
/// instanced; all instances of an object share them.
class SurfaceIds {
public:
    explicit SurfaceIds(const Assembly& assembly);

    std::uint32_t object(const PixelCentreSurface& surface) const {
        return surface.triangle == kNoTriangle ? 0 : index_of(surface) + 1;
    }
    std::uint32_t material(const PixelCentreSurface& surface) const {
        return surface.triangle == kNoTriangle ? 0 : first_material_[index_of(surface)] + surface.material;
    }

    const IdNames& object_names() const { return objects_; }
    const IdNames& names_of_materials() const { return materials_; }

private:
    static std::uint32_t index_of(const PixelCentreSurface& surface) {
        return surface.instance == kNoInstance ? 0 : surface.instance + 1;
    }

    IdNames objects_, materials_;
    std::vector<std::uint32_t> first_material_;  ///< first id: of static geometry, then of each instance
};

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
