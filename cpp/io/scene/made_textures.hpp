#pragma once
// Textures that the renderer needs and that are computed from those of the file. `name`: name of the new texture, for
// messages.

#include "decoded_image.hpp"

namespace realcam::io {

/// Converts a height map to a normal map in tangent space. Heights are the means of red, green and blue times `scale`,
/// in widths of a texel; slopes are central differences, across the picture's edges if it repeats.
/// `repeats`: the texture repeats in both directions.
Texture normals_of_heights(const DecodedImage& heights, float scale, bool repeats, std::string name);

/// Returns a texture with roughness in green and metallic in blue, from the means of red, green and blue of each
/// picture; a null picture stands for 1 everywhere. The texture has the larger size of the two pictures in each
/// direction; the smaller one is interpolated.
Texture roughness_and_metallic(const DecodedImage* roughness, const DecodedImage* metallic, std::string name);

/// Returns a texture with roughness in green: 1 - factor * alpha, where alpha is the glossiness
/// (KHR_materials_pbrSpecularGlossiness).
Texture roughness_of_glossiness(const DecodedImage& image, float factor, std::string name);

}  // namespace realcam::io
