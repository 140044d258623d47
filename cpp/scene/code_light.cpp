#include "code_light.hpp"

#include <cstddef>

#include "texture.hpp"

namespace realcam {

std::array<float, 256> light_of_codes(TextureEncoding encoding) {
    std::array<float, 256> light{};
    for (std::size_t code = 0; code < light.size(); ++code)
        light[code] = encoding == TextureEncoding::srgb ? srgb_to_linear(static_cast<std::uint8_t>(code))
                                                        : static_cast<float>(code) * (1.0f / 255.0f);
    return light;
}

}  // namespace realcam
