#pragma once
#include <array>
#include <cstddef>

#include "texture.hpp"

namespace REALCAM_NAMESPACE {

/// What each code of 8 bits stands for, 0 to 1, linear. On the host.
inline std::array<float, 256> light_of_codes(TextureEncoding encoding) {
    std::array<float, 256> light{};
    for (std::size_t code = 0; code < light.size(); ++code)
        light[code] = encoding == TextureEncoding::srgb ? srgb_to_linear(static_cast<std::uint8_t>(code))
                                                        : static_cast<float>(code) * (1.0f / 255.0f);
    return light;
}

}  // namespace REALCAM_NAMESPACE
