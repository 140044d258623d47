#include "light_tables.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <map>

#include "../../math/sampling_tables.hpp"
#include "../geometry/surface_point.hpp"
#include "../textures/texture_levels.hpp"

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

namespace {

/// Mean of all texels, linear.
Color mean_of(const TextureView& texture) {
    const std::size_t texels = static_cast<std::size_t>(texture.width) * static_cast<std::size_t>(texture.height);
    const std::array<float, 256> light = light_of_codes(texture.encoding);
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
    constexpr int kSteps = 6;
    constexpr float kWholeMap = 0.1f;
    std::map<std::int32_t, Color> whole;
    std::vector<float> means;
    means.reserve(static_cast<std::size_t>(mesh.emitter_count));
    for (std::int32_t i = 0; i < mesh.emitter_count; ++i) {
        checkpoint.pass();
        const std::uint32_t number = mesh.emitters[i];
        const Triangle& triangle = mesh.triangles[number];
        const Material& material = mesh.materials[triangle.material];
        const TextureReference& map = material.emission_texture;
        const float bare = luminance(material.emission);
        const bool has_map = map.texture >= 0 && mesh.uvs, has_colors = material.vertex_emission && mesh.colors;
        if ((!has_map && !has_colors) || !(bare > 0.0f)) {
            means.push_back(1.0f);
            continue;
        }
        Color all = {1, 1, 1};
        if (has_map) {
            const auto known = whole.find(map.texture);
            all = known != whole.end() ? known->second : (whole[map.texture] = mean_of(mesh.textures[map.texture]));
        }
        // Centroids of a regular subdivision of the triangle.
        Color sum{0, 0, 0};
        for (int row = 0; row < kSteps; ++row)
            for (int column = 0; column < 2 * (kSteps - row) - 1; ++column) {
                const float off = column % 2 ? 2.0f / 3.0f : 1.0f / 3.0f;
                const float step = 1.0f / static_cast<float>(kSteps);
                const Hit hit{0.0f, number, step * (static_cast<float>(column / 2) + off),
                              step * (static_cast<float>(row) + off)};
                const Color colors = has_colors ? vertex_color(mesh, triangle, hit) : Color{1, 1, 1};
                sum += colors * texture_color(mesh, map, surface_uv(mesh, triangle, hit, map).at);
            }
        // The whole map's mean must not make a triangle with black vertex colours a light.
        if (has_colors) all *= vertex_color(mesh, triangle, {0.0f, number, 1.0f / 3.0f, 1.0f / 3.0f});
        const Color mean = mix((1.0f / (kSteps * kSteps)) * sum, all, kWholeMap);
        means.push_back(luminance(material.emission * mean) / bare);
    }
    return means;
}

}  // namespace realcam
