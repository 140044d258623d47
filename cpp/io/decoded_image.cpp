#include "decoded_image.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "../camera/develop.hpp"

namespace realcam::io {
namespace {

double linear_of_srgb(double v) {
    return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

double unit(float v) {
    return v > 0 ? std::min(static_cast<double>(v), 1.0) : 0.0;
}

std::uint8_t code_of(double fraction) {
    return static_cast<std::uint8_t>(std::lround(255 * fraction));
}

template <class Value, class Light>
Vec3f mean_of_pixels(const std::vector<Value>& rgba, Light&& light, Checkpoint& checkpoint) {
    Vec3d sum = {0, 0, 0};
    for (std::size_t i = 0; i < rgba.size(); i += 4) {
        checkpoint.pass();
        sum += Vec3d{light(rgba[i]), light(rgba[i + 1]), light(rgba[i + 2])};
    }
    return static_cast<Vec3f>((4.0 / static_cast<double>(rgba.size())) * sum);
}

}  // namespace

bool is_whole(const DecodedImage& image) {
    const std::size_t size = std::visit([](const auto& values) { return values.size(); }, image.rgba);
    return image.width > 0 && image.height > 0 &&
           size == std::size_t{4} * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
}

Vec3f mean_of(const DecodedImage& image, TextureUse use, Checkpoint& checkpoint) {
    const bool encoded = is_srgb(image, use);
    const auto light = [&](double v) { return encoded ? linear_of_srgb(v) : v; };
    if (const auto* values = std::get_if<std::vector<float>>(&image.rgba))
        return mean_of_pixels(*values, light, checkpoint);
    std::array<double, 256> table{};
    for (std::size_t i = 0; i < table.size(); ++i) table[i] = light(static_cast<double>(i) / 255.0);
    return mean_of_pixels(
        std::get<std::vector<std::uint8_t>>(image.rgba), [&](std::uint8_t code) { return table[code]; }, checkpoint);
}

std::vector<std::uint8_t> srgb8(DecodedImage image) {
    if (auto* codes = std::get_if<std::vector<std::uint8_t>>(&image.rgba)) return std::move(*codes);
    const auto& values = std::get<std::vector<float>>(image.rgba);
    std::vector<std::uint8_t> codes(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
        const bool is_light = image.is_linear && i % 4 != 3;
        codes[i] = is_light ? srgb_code(unit(values[i])) : code_of(unit(values[i]));
    }
    return codes;
}

}  // namespace realcam::io
