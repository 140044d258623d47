#pragma once
// A picture as its file holds it. What its numbers mean follows from what it is used for.

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "../../scene/scene.hpp"

namespace realcam::io {

/// Red, green, blue and alpha of each pixel, row 0 at the top, rows without padding: 4 * width * height values. Alpha
/// is not multiplied in.
struct DecodedImage {
    int width = 0, height = 0;
    /// Codes from 0 to 255 where the file has 8 bits. Floats otherwise: codes of 16 bits as fractions of the largest,
    /// and floating-point numbers as they are, from 0 to 65504 (alpha: to 1).
    std::variant<std::vector<std::uint8_t>, std::vector<float>> rgba;
    /// Floating-point numbers in the file: as colours they are light itself, and not sRGB codes.
    bool is_linear = false;
    /// By rows: what takes its colours to linear Rec. 709, where the file says that they are others.
    std::optional<std::array<double, 9>> rec709 = std::nullopt;
};

/// 16384 x 16384, the largest texture of a GPU. A file of a megabyte can claim 40000 x 40000.
inline constexpr std::size_t kMostTexturePixels = std::size_t{1} << 28;

/// Decodes one picture: from the file `path`, or, where `path` is empty, from the bytes of a PNG or JPEG that the
/// scene file carries inside. If it throws Error or returns nothing, the scene gets a stand-in and a warning.
using ImageReader =
    std::function<std::optional<DecodedImage>(const std::string& path, std::span<const std::uint8_t> encoded_bytes)>;

/// Data are numbers, such as a roughness or a direction, which no file encodes for a screen. Opacity (and what else has
/// the fourth channel) is there, or where a picture has none, or white alone there, in the mean of the others.
enum class TextureUse { colour, data, opacity };

/// What the picture for a property of a material is used for.
inline TextureUse use_of(TextureReference Material::* property) {
    if (property == &Material::opacity_texture || property == &Material::specular_weight_texture)
        return TextureUse::opacity;
    const bool is_colour = property == &Material::diffuse_texture || property == &Material::specular_texture ||
                           property == &Material::emission_texture;
    return is_colour ? TextureUse::colour : TextureUse::data;
}

/// Whether the colours of a picture have to be decoded (IEC 61966-2-1) to become linear; its alpha is always linear.
inline bool is_srgb(const DecodedImage& image, TextureUse use) {
    return use == TextureUse::colour && !image.is_linear;
}

/// sRGB transfer function (IEC 61966-2-1), from a fraction of the largest code to linear. For codes of 8 bits the
/// renderer has srgb_to_linear.
float linear_of_srgb(float v);

/// Whether it has pixels, and their number fits its size.
bool is_whole(const DecodedImage& image);

/// Takes the pixels of a whole image as they are, less the encoding of floats.
Texture texture_of(DecodedImage image, TextureUse use, std::string name);

/// Whether any alpha is below 1.
bool has_holes(const Texture& texture);

}  // namespace realcam::io
