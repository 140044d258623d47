#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "../checkpoint.hpp"
#include "../math/append_cdf.hpp"
#include "scene.hpp"

namespace REALCAM_NAMESPACE {

// By which probabilities the pixels of an environment are chosen. Most by their power; a share without regard to it,
// because a light that is 1e8 times dimmer than another is all the light there is where the other does not reach.

inline constexpr double kEvenShare = 0.125;  ///< its price: where power is the best choice, 1/7 more variance

/// `weights` by their sum, less kEvenShare; that share by `even_weights`, which are 0 where `weights` are.
inline std::vector<double> mixed(std::vector<double> weights, const std::vector<double>& even_weights) {
    double sum = 0, even_sum = 0;
    for (double w : weights) sum += w;
    for (double w : even_weights) even_sum += w;
    if (!(sum > 0)) return weights;
    for (std::size_t i = 0; i < weights.size(); ++i)
        weights[i] = (1 - kEvenShare) * (weights[i] / sum) + kEvenShare * (even_weights[i] / even_sum);
    return weights;
}

struct EnvironmentTables {
    std::vector<float> marginal_cdf, conditional_cdf;  ///< empty for a constant environment
    float mean_luminance = 0;                          ///< over all directions
};

/// For choosing the pixels of an image by their light and, for the even share, by their solid angle where they have
/// any.
inline EnvironmentTables environment_tables(const Environment& e, Checkpoint& checkpoint) {
    EnvironmentTables tables;
    if (e.pixels.empty()) {
        tables.mean_luminance = luminance(e.constant);
        return tables;
    }
    const auto width = static_cast<std::size_t>(e.width), height = static_cast<std::size_t>(e.height);
    std::vector<double> light, solid_angle;
    for (std::size_t row = 0; row < height; ++row) {
        checkpoint.pass(width);
        const double sine =
            std::sin(3.141592653589793 * (static_cast<double>(row) + 0.5) / static_cast<double>(height));
        for (std::size_t column = 0; column < width; ++column) {
            light.push_back(sine * static_cast<double>(luminance(e.pixels[row * width + column])));
            solid_angle.push_back(light.back() > 0 ? sine : 0.0);
        }
    }
    double sum = 0;
    for (double l : light) sum += l;
    // A row of pixels fills 2 pi sine pi / height of the 4 pi.
    tables.mean_luminance = static_cast<float>(sum * 1.5707963267948966 / static_cast<double>(width * height));
    const std::vector<double> weights = mixed(light, solid_angle);
    std::vector<double> rows;
    for (std::size_t row = 0; row < height; ++row) {
        checkpoint.pass(width);
        const auto first = weights.begin() + static_cast<std::ptrdiff_t>(row * width);
        const std::vector<double> pixels(first, first + static_cast<std::ptrdiff_t>(width));
        append_cdf(pixels, tables.conditional_cdf);
        double row_sum = 0;
        for (double w : pixels) row_sum += w;
        rows.push_back(row_sum);
    }
    append_cdf(rows, tables.marginal_cdf);
    return tables;
}

}  // namespace REALCAM_NAMESPACE
