#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <vector>

#include "../../error.hpp"
#include "../../platform.hpp"

namespace REALCAM_NAMESPACE {

/// Additional output of a picture (AOV), per pixel: properties of the visible surfaces and of the samples. Layers whose
/// name ends in `middle` are those of the surface on the ray of the pixel's centre; others are means over the pixel's
/// samples.
enum class Layer : std::uint32_t {
    depth,  ///< along the axis from the film, m
    normal,  ///< shading normal in the scene's axes
    albedo,  ///< reflectance, 0 to 1
    circle_of_confusion_mm,  ///< diameter on the film
    sample_count,  ///< number of samples
    variance,  ///< variance of the exposure, (lux seconds)^2
    depth_middle,  ///< depth at the pixel's centre, m
    normal_middle,  ///< normal at the pixel's centre
    object_id,  ///< see SurfaceIds
    material_id,  ///< see SurfaceIds
    motion,  ///< motion vector during the exposure, pixels (motion_vectors)
    position_middle,  ///< position of the surface in the scene, m
    traced_light,  ///< part of the exposure that was splatted, lux seconds (SplattedLight)
    dual_pixel_left,  ///< exposure through the left half of the exit pupil, lux seconds
    dual_pixel_right,  ///< exposure through the right half of the exit pupil, lux seconds
};

/// Properties of a layer.
struct LayerInfo {
    const char* name;  ///< name on the command line, in shot files and in Python
    int channels;  ///< values per pixel
    bool is_number;  ///< true if the values are uint32 (LayerImage::numbers) instead of float
};

/// All layers, in the order of Layer.
inline constexpr std::array<LayerInfo, 15> kLayers = {{
    {"depth", 1, false},
    {"normal", 3, false},
    {"albedo", 3, false},
    {"circle_of_confusion_mm", 1, false},
    {"sample_count", 1, true},
    {"variance", 3, false},
    {"depth_middle", 1, false},
    {"normal_middle", 3, false},
    {"object_id", 1, true},
    {"material_id", 1, true},
    {"motion", 2, false},
    {"position_middle", 3, false},
    {"traced_light", 3, false},
    {"dual_pixel_left", 3, false},
    {"dual_pixel_right", 3, false},
}};

/// Returns the properties of a layer.
constexpr const LayerInfo& info_of(Layer layer) {
    return kLayers[static_cast<std::size_t>(layer)];
}

/// Set of layers.
class LayerSet {
public:
    constexpr LayerSet() = default;
    constexpr LayerSet(std::initializer_list<Layer> layers) {
        for (const Layer layer : layers) add(layer);
    }
    /// Returns all layers except kHalfLayers, which exclude Layer::variance.
    static constexpr LayerSet all() {
        LayerSet set;
        set.bits_ = (1u << static_cast<std::uint32_t>(Layer::dual_pixel_left)) - 1;
        return set;
    }

    constexpr void add(Layer layer) { bits_ |= 1u << static_cast<std::uint32_t>(layer); }
    constexpr void add(LayerSet other) { bits_ |= other.bits_; }
    constexpr bool has(Layer layer) const { return ((bits_ >> static_cast<std::uint32_t>(layer)) & 1u) != 0; }
    constexpr bool has_any(LayerSet other) const { return (bits_ & other.bits_) != 0; }
    constexpr bool operator==(const LayerSet&) const = default;

private:
    std::uint32_t bits_ = 0;
};

/// Layers that are summed over the samples. Their samples are traced to the first surface a second time, in kernels of
/// their own (trace_layers.hpp).
inline constexpr LayerSet kSampledLayers = {Layer::normal, Layer::albedo, Layer::circle_of_confusion_mm};
/// Layers of the surface on the ray of each pixel's centre (trace_pixel_centres).
inline constexpr LayerSet kPixelCentreLayers = {Layer::depth_middle, Layer::normal_middle, Layer::object_id,
                                                Layer::material_id,  Layer::motion,        Layer::position_middle};
/// Layers that the denoiser needs. It does not denoise the traced light.
inline constexpr LayerSet kDenoiserLayers = {Layer::albedo, Layer::normal, Layer::traced_light};
/// Layers of a dual-pixel sensor: exposure through the left and the right half of the exit pupil.
inline constexpr LayerSet kHalfLayers = {Layer::dual_pixel_left, Layer::dual_pixel_right};

/// Returns the names of all layers, separated by commas, for messages.
std::string layer_names();

/// Returns the names of the layers in a set, in the order of Layer.
std::vector<std::string> names_of(LayerSet set);

/// Parses names of layers; "all" stands for LayerSet::all(). Throws InputError if a name is unknown.
LayerSet layers_named(const std::vector<std::string>& names);

/// Names of objects or materials, indexed by their ids. Id 0 has an empty name and means no surface.
using IdNames = std::vector<std::string>;

/// One layer of a picture: height * width * channels elements, row by row, in `numbers` if LayerInfo::is_number, else
/// in `values`. The other vector is empty.
struct LayerImage {
    Layer layer;
    std::vector<float> values;
    std::vector<std::uint32_t> numbers;
};

}  // namespace REALCAM_NAMESPACE
