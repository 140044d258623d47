#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "../../platform.hpp"
#include "../layers/layers.hpp"

namespace REALCAM_NAMESPACE {

/// Array of a picture's values, shared between copies. It is not initialised, because all of it is written, and may lie
/// in pinned memory, which a GPU writes at full speed.
class PictureFloats {
public:
    PictureFloats() = default;
    /// Allocates an array of this size.
    explicit PictureFloats(std::size_t size) : PictureFloats(std::make_shared_for_overwrite<float[]>(size), size) {}
    /// Shares an array that exists.
    PictureFloats(std::shared_ptr<float[]> data, std::size_t size) : data_(std::move(data)), size_(size) {}
    /// Copies an array.
    explicit PictureFloats(std::span<const float> values) : PictureFloats(values.size()) {
        std::copy(values.begin(), values.end(), begin());
    }

    float* data() const { return data_.get(); }
    std::size_t size() const { return size_; }
    float* begin() const { return data(); }
    float* end() const { return data() + size_; }
    float& operator[](std::size_t i) const { return data()[i]; }

private:
    std::shared_ptr<float[]> data_;
    std::size_t size_ = 0;
};

/// Cost of a picture. Seconds of the stages are summed over the threads.
struct RenderStats {
    double seconds = 0;  ///< wall clock, in total
    double setup_seconds = 0;  ///< pupil and scene, included in `seconds`
    double lens_seconds = 0, scene_seconds = 0, other_seconds = 0;  ///< by RenderStage
    std::uint64_t sampled_rays = 0;  ///< rays sent into the lens
    std::uint64_t passed_rays = 0;  ///< rays that left the lens
    std::uint64_t scene_rays = 0;  ///< camera, shadow and bounce rays traced in the scene
    std::string device;  ///< name of the device, for display
};

/// A picture: exposure on the film, before the sensor adds its noise, depth and layers.
struct Image {
    int width = 0, height = 0;
    PictureFloats exposure;  ///< height * width * 3, lux seconds, linear Rec. 709
    PictureFloats depth;  ///< height * width, metres along the axis from the film; negative behind it, which a fisheye
                          ///< may see; infinite: no surface
    std::vector<LayerImage> layers;  ///< requested layers, except depth
    IdNames object_names, material_names;  ///< names of the ids in the layers object_id and material_id; empty without
                                           ///< these layers
    std::int64_t spp = 0;  ///< samples per pixel that were requested or, with a noise goal, their mean
    std::string shortfall;  ///< sentence for the user if a noise goal was missed or the picture was stopped; else empty
    RenderStats stats;
};

/// Removes the layers that are not in `kept` from a picture.
inline void keep_layers(Image& image, LayerSet kept) {
    std::erase_if(image.layers, [&](const LayerImage& layer) { return !kept.has(layer.layer); });
}

}  // namespace REALCAM_NAMESPACE
