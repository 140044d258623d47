#include "light_tables.hpp"

#include <cmath>

#include "../math/append_cdf.hpp"

namespace realcam {

std::vector<double> mixed(std::vector<double> weights, const std::vector<double>& even_weights) {
    double sum = 0, even_sum = 0;
    for (double w : weights) sum += w;
    for (double w : even_weights) even_sum += w;
    if (!(sum > 0)) return weights;
    for (std::size_t i = 0; i < weights.size(); ++i)
        weights[i] = (1 - kEvenShare) * (weights[i] / sum) + kEvenShare * (even_weights[i] / even_sum);
    return weights;
}

EnvironmentTables environment_tables(const Environment& e, Checkpoint& checkpoint) {
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
    // A row of pixels covers 2 pi sine pi / height of the 4 pi steradians.
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

}  // namespace realcam
