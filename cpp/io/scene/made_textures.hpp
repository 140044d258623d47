#pragma once
// Textures that are not in a file as the renderer reads them: made of the file's by arithmetic.

#include "decoded_image.hpp"

namespace realcam::io {

/// Directions in tangent space of heights, which are the means of red, green and blue times `scale`, in widths of a
/// texel: by central differences, across the picture's edges where it repeats.
Texture normals_of_heights(const DecodedImage& heights, float scale, bool repeats, std::string name);

/// Roughness in green and metallic in blue, from the means of red, green and blue of either picture; null: 1. Of two
/// sizes the larger in each direction, with the other one interpolated.
Texture roughness_and_metallic(const DecodedImage* roughness, const DecodedImage* metallic, std::string name);

/// Roughness in green, which is 1 - factor times alpha, the glossiness (KHR_materials_pbrSpecularGlossiness).
Texture roughness_of_glossiness(const DecodedImage& image, float factor, std::string name);

}  // namespace realcam::io
