#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <vector>

#include "../error.hpp"
#include "../platform.hpp"

namespace REALCAM_NAMESPACE {

/// What may be wanted of a picture besides light: per pixel, numbers that describe what was seen there.
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
    bool is_number;  ///< uint32 instead of float
};

/// In the order of Layer.
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
    /// Each but those that exclude another one, kHalfLayers.
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

/// Those for which samples are traced to their first surface once more.
inline constexpr LayerSet kSampledLayers = {Layer::normal, Layer::albedo, Layer::circle_of_confusion_mm};
/// Those of the surface in the middle ray of each pixel.
inline constexpr LayerSet kMiddleLayers = {Layer::depth_middle, Layer::normal_middle, Layer::object_id,
                                           Layer::material_id,  Layer::motion,        Layer::position_middle};
/// By which the picture is denoised; the light that was traced is kept out of that.
inline constexpr LayerSet kDenoiserLayers = {Layer::albedo, Layer::normal, Layer::traced_light};
/// The exposure through the left and the right half of the exit pupil.
inline constexpr LayerSet kHalfLayers = {Layer::dual_pixel_left, Layer::dual_pixel_right};

/// The names of all layers, for messages.
std::string layer_names();

std::vector<std::string> names_of(LayerSet set);

/// The layers of these names; "all" means each. Throws InputError for another name.
LayerSet layers_named(const std::vector<std::string>& names);

/// The names of objects or materials by their ids. 0, which has no name, is nothing.
using IdNames = std::vector<std::string>;

/// One layer of a picture: height * width * channels values, or, where the layer is one of numbers, such numbers.
struct LayerImage {
    Layer layer;
    std::vector<float> values;
    std::vector<std::uint32_t> numbers;
};

}  // namespace REALCAM_NAMESPACE
