#include "light_tables.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <map>

#include "../../math/sampling_tables.hpp"
#include "../geometry/surface_point.hpp"
#include "../textures/texture_levels.hpp"

namespace realcam {

std::vector<double> defensive_mixture(std::vector<double> weights, const std::vector<double>& uniform_weights) {
    double sum = 0, uniform_sum = 0;
    for (double w : weights) sum += w;
    for (double w : uniform_weights) uniform_sum += w;
    if (!(sum > 0)) return weights;
    for (std::size_t i = 0; i < weights.size(); ++i)
        weights[i] = (1 - kUniformWeight) * (weights[i] / sum) + kUniformWeight * (uniform_weights[i] / uniform_sum);
    return weights;
}

EnvironmentTables environment_tables(const Environment& e, Checkpoint& checkpoint) {
    EnvironmentTables tables;
    if (e.pixels.empty()) {
        tables.mean_luminance = luminance(e.constant);
        return tables;
    }
    const auto width = static_cast<std::size_t>(e.width), height = static_cast<std::size_t>(e.height);
    // Relative power and solid angle of each pixel; the solid angle of black pixels is set to 0.
    std::vector<double> power, solid_angle;
    for (std::size_t row = 0; row < height; ++row) {
        checkpoint.pass(width);
        const double sine =
            std::sin(3.141592653589793 * (static_cast<double>(row) + 0.5) / static_cast<double>(height));
        for (std::size_t column = 0; column < width; ++column) {
            power.push_back(sine * static_cast<double>(luminance(e.pixels[row * width + column])));
            solid_angle.push_back(power.back() > 0 ? sine : 0.0);
        }
    }
    double sum = 0;
    for (double p : power) sum += p;
    // A row of pixels covers a solid angle of 2 pi sine pi / height; divided by 4 pi, that is sine pi / 2 / height.
    tables.mean_luminance = static_cast<float>(sum * 1.5707963267948966 / static_cast<double>(width * height));
    const std::vector<double> weights = defensive_mixture(power, solid_angle);
    std::vector<double> row_weights;
    for (std::size_t row = 0; row < height; ++row) {
        checkpoint.pass(width);
        const auto first = weights.begin() + static_cast<std::ptrdiff_t>(row * width);
        const std::vector<double> pixels(first, first + static_cast<std::ptrdiff_t>(width));
        append_cdf(pixels, tables.conditional_cdf);
        double row_sum = 0;
        for (double w : pixels) row_sum += w;
        row_weights.push_back(row_sum);
    }
    append_cdf(row_weights, tables.marginal_cdf);
    return tables;
}

namespace {

/// Mean of all texels, linear.
Color mean_of(const TextureView& texture) {
    const std::size_t texels = static_cast<std::size_t>(texture.width) * static_cast<std::size_t>(texture.height);
    const std::array<float, 256> light = linear_values_of_codes(texture.encoding);
    std::array<double, 3> sum{};
    for (std::size_t i = 0; i < texels; ++i)
        for (std::size_t c = 0; c < 3; ++c)
            sum[c] +=
                static_cast<double>(texture.rgba ? light[texture.rgba[4 * i + c]] : texture.linear_rgba[4 * i + c]);
    const double share = 1.0 / static_cast<double>(texels);
    return {static_cast<float>(share * sum[0]), static_cast<float>(share * sum[1]), static_cast<float>(share * sum[2])};
}

}  // namespace

std::vector<float> emission_means(const MeshView& mesh, Checkpoint& checkpoint) {
    constexpr int kSteps = 6;  // subdivisions of each edge, for kSteps^2 samples
    constexpr float kMapWeight = 0.1f;  // weight of the whole map's mean
    std::map<std::int32_t, Color> map_means;  // by index of the texture
    std::vector<float> means;
    means.reserve(static_cast<std::size_t>(mesh.emitter_count));
    for (std::int32_t i = 0; i < mesh.emitter_count; ++i) {
        checkpoint.pass();
        const std::uint32_t index = mesh.emitters[i];
        const Triangle& triangle = mesh.triangles[index];
        const Material& material = mesh.materials[triangle.material];
        const TextureReference& map = material.emission_texture;
        const float unmodified = luminance(material.emission);
        const bool has_map = map.texture >= 0 && mesh.uvs, has_colors = material.vertex_emission && mesh.colors;
        if ((!has_map && !has_colors) || !(unmodified > 0.0f)) {
            means.push_back(1.0f);
            continue;
        }
        Color map_mean = {1, 1, 1};
        if (has_map) {
            const auto known = map_means.find(map.texture);
            map_mean = known != map_means.end() ? known->second
                                                : (map_means[map.texture] = mean_of(mesh.textures[map.texture]));
        }
        // Centroids of a regular subdivision of the triangle.
        Color sum{0, 0, 0};
        for (int row = 0; row < kSteps; ++row)
            for (int column = 0; column < 2 * (kSteps - row) - 1; ++column) {
                // Columns alternate between upright and inverted triangles.
                const float offset = column % 2 ? 2.0f / 3.0f : 1.0f / 3.0f;
                const float step = 1.0f / static_cast<float>(kSteps);
                const Hit hit{0.0f, index, step * (static_cast<float>(column / 2) + offset),
                              step * (static_cast<float>(row) + offset)};
                const Color colors = has_colors ? vertex_color(mesh, triangle, hit) : Color{1, 1, 1};
                sum += colors * texture_color(mesh, map, surface_uv(mesh, triangle, hit, map).at);
            }
        // The whole map's mean must not make a triangle with black vertex colours a light.
        if (has_colors) map_mean *= vertex_color(mesh, triangle, {0.0f, index, 1.0f / 3.0f, 1.0f / 3.0f});
        const Color mean = mix((1.0f / (kSteps * kSteps)) * sum, map_mean, kMapWeight);
        means.push_back(luminance(material.emission * mean) / unmodified);
    }
    return means;
}

}  // namespace realcam
