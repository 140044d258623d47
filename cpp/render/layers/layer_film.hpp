#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "../../scene/assembly.hpp"
#include "../../scene/geometry/surface_point.hpp"
#include "layer_sum.hpp"
#include "layers.hpp"

namespace REALCAM_NAMESPACE {

/// Ids of the objects and materials of a scene, for the layers object_id and material_id. Id 0: no surface. Objects: 1
/// is the static geometry, and the instances follow in their order. Materials: from 1 on, those of the static geometry,
/// then those of each object, in the order in which the objects are first instanced; all instances of an object share
/// them.
class SurfaceIds {
public:
    explicit SurfaceIds(const Assembly& assembly);

    std::uint32_t object(const PixelCentreSurface& surface) const {
        return surface.triangle == kNoTriangle ? 0 : index_of(surface) + 1;
    }
    std::uint32_t material(const PixelCentreSurface& surface) const {
        return surface.triangle == kNoTriangle ? 0 : first_material_[index_of(surface)] + surface.material;
    }

    /// Names, indexed by id.
    const IdNames& object_names() const { return objects_; }
    const IdNames& material_names_by_id() const { return materials_; }

private:
    /// Index in first_material_ of the surface's geometry.
    static std::uint32_t index_of(const PixelCentreSurface& surface) {
        return surface.instance == kNoInstance ? 0 : surface.instance + 1;
    }

    IdNames objects_, materials_;
    std::vector<std::uint32_t> first_material_;  ///< first material id of the static geometry, then of each instance
};

/// Accumulated layers of a film, row by row. A vector is empty before its layers are computed.
struct LayerFilm {
    std::vector<LayerSum> sums;  ///< for kSampledLayers
    std::vector<PixelCentreSurface> pixel_centres;  ///< for kPixelCentreLayers
};

namespace layer_film_detail {

/// Makes an image of a layer; f(pixel, out) writes the values of each pixel.
template <class Pixel, class F>
LayerImage make_image(Layer layer, const std::vector<Pixel>& film, F&& f) {
    const std::size_t channels = static_cast<std::size_t>(info_of(layer).channels);
    LayerImage image{layer, std::vector<float>(channels * film.size()), {}};
    for (std::size_t i = 0; i < film.size(); ++i) f(film[i], &image.values[channels * i]);
    return image;
}

/// Makes an image of a layer of ids; f(surface) returns the id of each pixel.
template <class F>
LayerImage make_id_image(Layer layer, const std::vector<PixelCentreSurface>& film, F&& f) {
    LayerImage image{layer, {}, {}};
    image.numbers.reserve(film.size());
    for (const PixelCentreSurface& surface : film) image.numbers.push_back(f(surface));
    return image;
}

}  // namespace layer_film_detail

/// Returns the requested layers among kSampledLayers and kPixelCentreLayers, except motion. `origin_m`: origin of
/// render space in the scene.
std::vector<LayerImage> developed_layers(const LayerFilm& film, LayerSet requested, const SurfaceIds& ids,
                                         Vec3d origin_m);

}  // namespace REALCAM_NAMESPACE
