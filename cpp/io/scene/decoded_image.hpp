#pragma once
// Decoded images: pictures as stored in their files, whose numbers are interpreted by the use of the texture, and
// vertex colours.

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "../../scene/scene.hpp"
#include "../../scene/scene_view.hpp"

namespace realcam::io {

/// Converts vertex colours of OBJ and PLY files to linear. Neither format defines its numbers; all programs that write
/// them use sRGB, as fractions of the largest value. If a number is above 1, all are values up to 255. Negative numbers
/// and NaN become 0. Alpha is linear. Returns a warning for corrected numbers, or an empty string.
std::string decode_vertex_colours(std::vector<VertexColor>& colours);

/// True if the alpha of any vertex colour is below 1.
bool are_transparent(const std::vector<VertexColor>& colours);

/// Function that converts colours in place to linear Rec. 709: red, green and blue of each pixel.
using ColorConversion = std::function<void(std::span<float> rgb)>;

/// Red, green, blue and alpha of each pixel, row 0 at the top, rows without padding: 4 * width * height values. Alpha
/// is not premultiplied.
struct DecodedImage {
    int width = 0, height = 0;
    /// Values from 0 to 255 if the file has 8 bits. Floats otherwise: 16-bit values as fractions of the largest, and
    /// floating-point numbers unchanged, from 0 to 65504 (alpha: to 1).
    std::variant<std::vector<std::uint8_t>, std::vector<float>> rgba;
    /// True if the file has floating-point numbers: colours are then linear, and not encoded as sRGB.
    bool is_linear = false;
    /// Matrix, by rows, to linear Rec. 709, if the file specifies other primaries.
    std::optional<std::array<double, 9>> rec709 = std::nullopt;
    /// Conversion of colours from the colour space that the user has specified, in place of `is_linear` and `rec709`;
    /// 8-bit values are converted as fractions of 255. Empty: none is specified.
    ColorConversion to_rec709 = {};
};

/// Limit of the size of textures: 16384 x 16384 pixels, the largest texture of a GPU. A file of a megabyte can claim
/// 40000 x 40000.
inline constexpr std::size_t kMaxTexturePixels = std::size_t{1} << 28;

/// Function that decodes one picture, from the file `path`, or, if `path` is empty, from the bytes of a PNG or JPEG
/// that is embedded in the scene file. If it throws Error or returns std::nullopt, the scene gets a checker pattern
/// instead and a warning.
using ImageReader =
    std::function<std::optional<DecodedImage>(const std::string& path, std::span<const std::uint8_t> encoded_bytes)>;

/// Use of a texture.
enum class TextureUse {
    colour,
    data,  ///< numbers, such as a roughness or a direction, which are never encoded as sRGB
    /// Opacity and other properties of the alpha channel; in the alpha channel, or, if a picture has no alpha or only
    /// white there, in the mean of the other channels.
    opacity,
};

/// Returns the use of the texture of a material property.
inline TextureUse use_of(TextureReference Material::* property) {
    if (property == &Material::opacity_texture || property == &Material::specular_weight_texture)
        return TextureUse::opacity;
    const bool is_colour = property == &Material::diffuse_texture || property == &Material::specular_texture ||
                           property == &Material::emission_texture;
    return is_colour ? TextureUse::colour : TextureUse::data;
}

/// True if the colours of a picture must be decoded from sRGB (IEC 61966-2-1) to linear; its alpha is always linear.
inline bool is_srgb(const DecodedImage& image, TextureUse use) {
    return use == TextureUse::colour && !image.is_linear;
}

/// Converts sRGB to linear (IEC 61966-2-1); `v` is a fraction of the largest value. For 8-bit values the renderer has
/// srgb_to_linear.
float linear_of_srgb(float v);

/// True if an image has at least one pixel, and the number of values that its size requires.
bool is_whole(const DecodedImage& image);

/// Converts an image, for which is_whole must hold, to a texture. 8-bit values remain encoded, and floats become
/// linear.
Texture texture_of(DecodedImage image, TextureUse use, std::string name);

/// True if the alpha of any texel is below 1.
bool has_holes(const Texture& texture);

}  // namespace realcam::io
