#include "texture_levels.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "texture.hpp"

namespace realcam {

namespace {

/// Averages texels in linear light: sRGB codes are decoded first, because the mean of codes is too dark. `Value` is
/// std::uint8_t for codes or float for linear values.
class MipmapFilter {
public:
    MipmapFilter(const TextureView& texture, Checkpoint& checkpoint)
        : checkpoint_(checkpoint), linear_of_code_(linear_values_of_codes(texture.encoding)) {
        if (texture.rgba) {
            // Table from linear values to codes, indexed by the square root of the value: 4096 steps of it are fine
            // enough to separate dark codes.
            for (std::size_t i = 0; i < codes_.size(); ++i) codes_[i] = nearest_code(linear_of_step(i));
        }
    }

    /// Appends to `levels` the next coarser level of a level with this width and height, whose texels are `finer`. Each
    /// texel is the area-weighted mean of the part of the finer level that it covers, also for odd sizes.
    template <class Value>
    void append(std::vector<Value>& levels, const Value* finer, int width, int height) {
        const int out_width = half_size(width), out_height = half_size(height);
        for (int row = 0; row < out_height; ++row) {
            checkpoint_.pass();
            const Span rows = span_of(row, out_height, height);
            for (int column = 0; column < out_width; ++column) {
                const Span columns = span_of(column, out_width, width);
                float sum[4] = {};
                for (int y = rows.first; y < rows.end; ++y)
                    for (int x = columns.first; x < columns.end; ++x) {
                        const float weight = rows.weight(y) * columns.weight(x);
                        const Value* p = finer + 4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                                      static_cast<std::size_t>(x));
                        for (int c = 0; c < 4; ++c) sum[c] += weight * linear_of(p[c], c);
                    }
                for (int c = 0; c < 4; ++c) push(levels, sum[c], c);
            }
        }
    }

private:
    /// Rows or columns of the finer level that a texel of the coarser one covers.
    struct Span {
        double low, high;  ///< ends, in texels
        int first, end;  ///< range of the covered texels; `end` is excluded
        /// Fraction of the span that is covered by texel i.
        float weight(int i) const {
            return static_cast<float>((std::min(high, i + 1.0) - std::max(low, static_cast<double>(i))) / (high - low));
        }
    };
    /// Span of texel i of `count`, if the finer level has `finer_count`.
    static Span span_of(int i, int count, int finer_count) {
        const double step = static_cast<double>(finer_count) / count, low = i * step, high = (i + 1) * step;
        // Reduced by 1e-9, so that rounding does not add a texel of weight 0.
        return {low, high, static_cast<int>(low), std::min(finer_count, static_cast<int>(std::ceil(high - 1e-9)))};
    }

    float linear_of(float v, int) const { return v; }
    float linear_of(std::uint8_t code, int channel) const {
        return channel < 3 ? linear_of_code_[code] : static_cast<float>(code) * (1.0f / 255.0f);
    }
    static void push(std::vector<float>& levels, float v, int) { levels.push_back(v); }
    void push(std::vector<std::uint8_t>& levels, float v, int channel) const {
        const float clamped = std::clamp(v, 0.0f, 1.0f);
        levels.push_back(channel < 3 ? codes_[static_cast<std::size_t>(std::lround(std::sqrt(clamped) * kSteps))]
                                     : static_cast<std::uint8_t>(std::lround(255 * clamped)));
    }

    static constexpr int kSteps = 4095;  ///< last index of codes_
    static float linear_of_step(std::size_t step) {
        const float root = static_cast<float>(step) / kSteps;
        return root * root;
    }
    std::uint8_t nearest_code(float v) const {
        const auto above = std::lower_bound(linear_of_code_.begin(), linear_of_code_.end(), v);
        if (above == linear_of_code_.begin()) return 0;
        if (above == linear_of_code_.end()) return 255;
        const auto code = static_cast<std::uint8_t>(above - linear_of_code_.begin());
        return v - *(above - 1) < *above - v ? static_cast<std::uint8_t>(code - 1) : code;
    }

    Checkpoint& checkpoint_;
    std::array<float, 256> linear_of_code_;
    std::array<std::uint8_t, kSteps + 1> codes_{};  ///< code of the linear value (i / kSteps)^2
};

}  // namespace

TextureLevels coarser_levels(TextureView& texture, Checkpoint& checkpoint) {
    TextureLevels levels;
    MipmapFilter filter(texture, checkpoint);
    for (std::int32_t w = texture.width, h = texture.height; w > 1 || h > 1; w = half_size(w), h = half_size(h))
        ++texture.coarse_levels;
    const std::size_t values = 4 * static_cast<std::size_t>(coarse_texels(texture));
    // Reserved at once, because each level is computed from the previous one in the same vector.
    if (texture.rgba)
        levels.rgba.reserve(values);
    else
        levels.linear_rgba.reserve(values);
    texture.coarse_rgba = levels.rgba.data();
    texture.coarse_linear_rgba = levels.linear_rgba.data();
    for (int level = 0; level < texture.coarse_levels; ++level) {
        const TextureView finer = level_of(texture, level);
        if (texture.rgba)
            filter.append(levels.rgba, finer.rgba, finer.width, finer.height);
        else
            filter.append(levels.linear_rgba, finer.linear_rgba, finer.width, finer.height);
    }
    return levels;
}

std::array<float, 256> linear_values_of_codes(TextureEncoding encoding) {
    std::array<float, 256> light{};
    for (std::size_t code = 0; code < light.size(); ++code)
        light[code] = encoding == TextureEncoding::srgb ? srgb_to_linear(static_cast<std::uint8_t>(code))
                                                        : static_cast<float>(code) * (1.0f / 255.0f);
    return light;
}

}  // namespace realcam
