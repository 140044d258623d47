#include "texture_levels.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "texture.hpp"

namespace realcam {

namespace {

/// Averages texels in linear light: sRGB codes are decoded first, because the mean of codes is too dark.
class Averaging {
public:
    Averaging(const TextureView& texture, Checkpoint& checkpoint)
        : checkpoint_(checkpoint), light_(light_of_codes(texture.encoding)) {
        if (texture.rgba) {
            // Inverse transfer table, linear value to code; 4096 steps of the square root separate dark codes.
            for (std::size_t i = 0; i < codes_.size(); ++i) codes_[i] = exact_code(light_at(i));
        }
    }

    /// Appends the next coarser level of the level that starts at `from`. For odd sizes each texel is the area-weighted
    /// mean of the part of the finer level that it covers.
    template <class Value>
    void append(std::vector<Value>& levels, const Value* from, int width, int height) {
        const int out_width = half_size(width), out_height = half_size(height);
        for (int row = 0; row < out_height; ++row) {
            checkpoint_.pass();
            const Span rows = span_of(row, out_height, height);
            for (int column = 0; column < out_width; ++column) {
                const Span columns = span_of(column, out_width, width);
                float sum[4] = {};
                for (int y = rows.first; y < rows.end; ++y)
                    for (int x = columns.first; x < columns.end; ++x) {
                        const float share = rows.share(y) * columns.share(x);
                        const Value* p = from + 4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                                     static_cast<std::size_t>(x));
                        for (int c = 0; c < 4; ++c) sum[c] += share * light_of(p[c], c);
                    }
                for (int c = 0; c < 4; ++c) push(levels, sum[c], c);
            }
        }
    }

private:
    struct Span {
        double low, high;
        int first, end;
        float share(int i) const {
            return static_cast<float>((std::min(high, i + 1.0) - std::max(low, static_cast<double>(i))) / (high - low));
        }
    };
    static Span span_of(int i, int count, int finer) {
        const double step = static_cast<double>(finer) / count, low = i * step, high = (i + 1) * step;
        return {low, high, static_cast<int>(low), std::min(finer, static_cast<int>(std::ceil(high - 1e-9)))};
    }

    float light_of(float v, int) const { return v; }
    float light_of(std::uint8_t code, int channel) const {
        return channel < 3 ? light_[code] : static_cast<float>(code) * (1.0f / 255.0f);
    }
    static void push(std::vector<float>& levels, float v, int) { levels.push_back(v); }
    void push(std::vector<std::uint8_t>& levels, float v, int channel) const {
        const float kept = std::clamp(v, 0.0f, 1.0f);
        levels.push_back(channel < 3 ? codes_[static_cast<std::size_t>(std::lround(std::sqrt(kept) * kSteps))]
                                     : static_cast<std::uint8_t>(std::lround(255 * kept)));
    }

    static constexpr int kSteps = 4095;
    static float light_at(std::size_t step) {
        const float root = static_cast<float>(step) / kSteps;
        return root * root;
    }
    std::uint8_t exact_code(float v) const {
        const auto above = std::lower_bound(light_.begin(), light_.end(), v);
        if (above == light_.begin()) return 0;
        if (above == light_.end()) return 255;
        const auto code = static_cast<std::uint8_t>(above - light_.begin());
        return v - *(above - 1) < *above - v ? static_cast<std::uint8_t>(code - 1) : code;
    }

    Checkpoint& checkpoint_;
    std::array<float, 256> light_;
    std::array<std::uint8_t, kSteps + 1> codes_{};
};

}  // namespace

TextureLevels coarser_levels(TextureView& texture, Checkpoint& checkpoint) {
    TextureLevels levels;
    Averaging averaging(texture, checkpoint);
    for (std::int32_t w = texture.width, h = texture.height; w > 1 || h > 1; w = half_size(w), h = half_size(h))
        ++texture.coarse_levels;
    const std::size_t numbers = 4 * static_cast<std::size_t>(coarse_texels(texture));
    // Reserved at once, because each level is computed from the previous one in the same vector.
    if (texture.rgba)
        levels.rgba.reserve(numbers);
    else
        levels.linear_rgba.reserve(numbers);
    texture.coarse_rgba = levels.rgba.data();
    texture.coarse_linear_rgba = levels.linear_rgba.data();
    for (int level = 0; level < texture.coarse_levels; ++level) {
        const TextureView finer = level_of(texture, level);
        if (texture.rgba)
            averaging.append(levels.rgba, finer.rgba, finer.width, finer.height);
        else
            averaging.append(levels.linear_rgba, finer.linear_rgba, finer.width, finer.height);
    }
    return levels;
}

std::array<float, 256> light_of_codes(TextureEncoding encoding) {
    std::array<float, 256> light{};
    for (std::size_t code = 0; code < light.size(); ++code)
        light[code] = encoding == TextureEncoding::srgb ? srgb_to_linear(static_cast<std::uint8_t>(code))
                                                        : static_cast<float>(code) * (1.0f / 255.0f);
    return light;
}

}  // namespace realcam
