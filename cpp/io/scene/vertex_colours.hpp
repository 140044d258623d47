#pragma once
#include <string>
#include <vector>

#include "../../scene/scene_view.hpp"

namespace realcam::io {

/// Converts vertex colours of OBJ and PLY files to linear. Neither format defines its numbers; all programs that write
/// them use sRGB, as fractions of the largest value. If a number is above 1, all are values up to 255. Negative numbers
/// and NaN become 0. Alpha is linear. Returns a warning for corrected numbers, or an empty string.
std::string decode_vertex_colours(std::vector<VertexColor>& colours);

/// True if any alpha is below 1.
bool are_transparent(const std::vector<VertexColor>& colours);

}  // namespace realcam::io
