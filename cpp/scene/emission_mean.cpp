#include "emission_mean.hpp"

#include <array>
#include <cstddef>
#include <map>

#include "code_light.hpp"
#include "surface_point.hpp"

namespace realcam {

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
