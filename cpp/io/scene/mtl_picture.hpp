#pragma once
#include <optional>
#include <string_view>
#include <vector>

#include "texture_transform.hpp"

namespace realcam::io {

/// Arguments of an MTL texture statement such as map_Kd.
struct MtlPicture {
    std::string_view name;       ///< file name, including blanks
    TextureTransform transform;  ///< from -s and -o: u becomes s u + o, as in other programs
    bool clamps = false;  ///< -clamp on
    double bm = 1;  ///< argument of -bm: factor of bump heights
    bool has_bm = false;  ///< -bm is present
    std::vector<std::string_view> other_options;  ///< unsupported options whose arguments are not the format's default
};

/// Parses a statement's arguments, such as "-s 2 2 -clamp on my wood.png"; `text` must outlive the result. Returns
/// std::nullopt if there is no file name, or no number after -s, -o or -bm. Numbers may be infinite or NaN.
std::optional<MtlPicture> parse_mtl_picture(std::string_view text);

}  // namespace realcam::io
