#pragma once
#include <optional>
#include <string_view>
#include <vector>

#include "texture_transform.hpp"

namespace realcam::io {

/// What follows a keyword such as map_Kd on its line.
struct MtlPicture {
    std::string_view name;       ///< of the file, blanks included
    TextureTransform transform;  ///< by -s and -o: u becomes s u + o, which is how other programs read and write them
    bool clamps = false;  ///< -clamp on
    double bm = 1;  ///< -bm
    bool has_bm = false;
    std::vector<std::string_view> other_options;  ///< those whose arguments are not the format's default
};

/// "-s 2 2 -clamp on my wood.png", which nobody has to outlive but the text. Nothing where there is no name, or no
/// number behind -s, -o or -bm. Numbers may be infinite or NaN.
std::optional<MtlPicture> parse_mtl_picture(std::string_view text);

}  // namespace realcam::io
