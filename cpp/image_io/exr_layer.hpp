#pragma once
#include <string>
#include <vector>

#include "openimageio.hpp"

namespace realcam::image_io {

/// Channels of one layer of an OpenEXR file, in the order grey; grey, alpha; red, green, blue; or red, green, blue,
/// alpha.
struct ExrLayer {
    std::size_t part = 0;
    std::vector<int> channels;
};

/// Chooses the layer that holds the picture: `name`, ignoring case, or, if `name` is empty, the channels R, G and B
/// without a prefix, the only layer with R, G and B, or the one that renderers name beauty, combined or similar. A
/// layer of a file of several parts is named after its part. Throws Error, with the reason alone, if the choice is
/// ambiguous, there is no such layer, or its channels are whole numbers, which are not light.
ExrLayer choose_layer(const std::vector<EncodedHeader>& parts, const std::string& name);

}  // namespace realcam::image_io
