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

/// Additional output of a picture, per pixel: properties of the visible surfaces and of the samples.
enum class Layer : std::uint32_t {
    depth,
    normal,
    albedo,
    circle_of_confusion_mm,
    sample_count,
    variance,
    depth_middle,
    normal_middle,
    object_id,
    material_id,
    motion,
    position_middle,
    traced_light,
    dual_pixel_left,
    dual_pixel_right,
};

struct LayerInfo {
    const char* name;  ///< on the command line, in shot files and in Python
    int channels;
    bool is_number;  ///< values are uint32 instead of float
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

constexpr const LayerInfo& info_of(Layer layer) {
    return kLayers[static_cast<std::size_t>(layer)];
}

class LayerSet {
public:
    constexpr LayerSet() = default;
    constexpr LayerSet(std::initializer_list<Layer> layers) {
        for (const Layer layer : layers) add(layer);
    }
    /// All layers except kHalfLayers, which exclude another one.
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

/// Layers for which samples are traced to their first surface a second time.
inline constexpr LayerSet kSampledLayers = {Layer::normal, Layer::albedo, Layer::circle_of_confusion_mm};
/// Layers of the surface on the ray of each pixel's centre.
inline constexpr LayerSet kPixelCentreLayers = {Layer::depth_middle, Layer::normal_middle, Layer::object_id,
                                                Layer::material_id,  Layer::motion,        Layer::position_middle};
/// Layers for the denoiser, which leaves out the traced light.
inline constexpr LayerSet kDenoiserLayers = {Layer::albedo, Layer::normal, Layer::traced_light};
/// Exposure through the left and the right half of the exit pupil.
inline constexpr LayerSet kHalfLayers = {Layer::dual_pixel_left, Layer::dual_pixel_right};

/// The names of all layers, for messages.
std::string layer_names();

std::vector<std::string> names_of(LayerSet set);

/// Parses names of layers; "all" stands for LayerSet::all(). Throws InputError if a name is unknown.
LayerSet layers_named(const std::vector<std::string>& names);

/// Names of objects or materials, indexed by their ids. Id 0 has an empty name and means no surface.
using IdNames = std::vector<std::string>;

/// One layer of a picture: height * width * channels elements, in `numbers` if LayerInfo::is_number, else in `values`.
struct LayerImage {
    Layer layer;
    std::vector<float> values;
    std::vector<std::uint32_t> numbers;
};

}  // namespace REALCAM_NAMESPACE
