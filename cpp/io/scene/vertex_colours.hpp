#pragma once
#include <string>
#include <vector>

#include "../../scene/scene_view.hpp"

namespace realcam::io {

/// Colours of vertices as OBJ and PLY have them become linear. Neither format says what its numbers are; all programs
/// that write them mean sRGB codes, as fractions of the largest. Where one is above 1, all are codes up to 255. What is
/// no number from 0 on becomes 0. Alpha is linear. Returns what was put up with, for a warning; empty: nothing.
std::string decode_vertex_colours(std::vector<VertexColor>& colours);

/// Whether any alpha is below 1.
bool are_transparent(const std::vector<VertexColor>& colours);

}  // namespace realcam::io
