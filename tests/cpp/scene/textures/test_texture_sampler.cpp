// How a texture is seen beyond its edges. The truth is glTF 2.0's and OpenGL's: REPEAT takes the fraction,
// MIRRORED_REPEAT turns round at whole numbers, CLAMP_TO_EDGE ends at the outermost texels' middles.

#include <cmath>
#include <string>
#include <vector>

#include "gltf_files.hpp"
#include "scene/textures/texture.hpp"

namespace {

using namespace scene_files;

/// A row of texels 0, 1, 2 and 3.
struct Row {
    std::vector<float> numbers;
    TextureView view;

    Row() {
        for (int i = 0; i < 4; ++i) numbers.insert(numbers.end(), {float(i), 0, 0, 1});
        view = {nullptr, numbers.data(), 4, 1, TextureEncoding::linear};
    }
    double at(double u, TextureSampler sampler) const {
        return double(sample_texture(view, {static_cast<float>(u), 0.5f}, sampler).r);
    }
};

/// Column, from 0 to 3, of the texel with this index, which may lie outside the texture.
int texel_of(int number, TextureWrap wrap) {
    const int repeated = ((number % 4) + 4) % 4;
    if (wrap == TextureWrap::repeat) return repeated;
    if (wrap == TextureWrap::clamp) return std::min(std::max(number, 0), 3);
    const int in_pair = ((number % 8) + 8) % 8;
    return in_pair < 4 ? in_pair : 7 - in_pair;
}

std::string scene_with_sampler(const Folder& folder, const std::string& sampler) {
    folder.write("tri.bin", triangle_bytes());
    folder.write("map.png", "not decoded here");
    return folder.write("s.gltf", gltf(R"([{"mesh":0}])", "[0]",
                                       R"(,"images":[{"uri":"map.png"}],"samplers":[)" + sampler +
                                           R"(],"textures":[{"source":0,"sampler":0},{"source":0}],
               "materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}},"emissiveFactor":[1,1,1],
               "emissiveTexture":{"index":1}}])"));
}

}  // namespace

TEST_CASE("Wrap modes and filters by their definitions, far beyond the picture too") {
    const Row row;
    for (const TextureWrap wrap : {TextureWrap::repeat, TextureWrap::clamp, TextureWrap::mirror})
        for (int i = -4000; i <= 4000; i += (std::abs(i) < 50 ? 1 : 501)) {
            // Sixteenths of a texel, off its middle: x texels from the picture's left edge.
            const double x = i / 16.0 + 1 / 64.0, u = x / 4;
            const int left = static_cast<int>(std::floor(x - 0.5));
            const double share = x - 0.5 - left;
            const double between = (1 - share) * texel_of(left, wrap) + share * texel_of(left + 1, wrap);
            INFO(static_cast<int>(wrap), " ", x);
            CHECK(row.at(u, {wrap, wrap, TextureFilter::linear}) == doctest::Approx(between).epsilon(2e-3));
            CHECK(row.at(u, {wrap, wrap, TextureFilter::nearest}) == texel_of(static_cast<int>(std::floor(x)), wrap));
        }
    CHECK(std::isfinite(row.at(1e38, {TextureWrap::mirror, TextureWrap::mirror, TextureFilter::linear})));
    CHECK(std::isfinite(row.at(-std::numeric_limits<double>::infinity(),
                               {TextureWrap::clamp, TextureWrap::clamp, TextureFilter::linear})));
}

TEST_CASE("Both directions have their own wrap mode, upwards as well") {
    // 1 x 2: black above white.
    const std::vector<float> numbers = {0, 0, 0, 1, 1, 1, 1, 1};
    const TextureView view = {nullptr, numbers.data(), 1, 2, TextureEncoding::linear};
    const auto at = [&](float v, TextureWrap wrap) {
        return sample_texture(view, {0.5f, v}, {TextureWrap::repeat, wrap, TextureFilter::linear}).r;
    };
    CHECK(at(1.25f, TextureWrap::clamp) == 0);   // above the upper edge the upper row
    CHECK(at(1.25f, TextureWrap::repeat) == 1);  // the lower row again
    CHECK(at(1.25f, TextureWrap::mirror) == 0);
    CHECK(at(-0.25f, TextureWrap::clamp) == 1);
    CHECK(at(-0.25f, TextureWrap::repeat) == 0);
    CHECK(at(-0.25f, TextureWrap::mirror) == 1);
}

TEST_CASE("glTF samplers reach the material that names them, each texture its own") {
    const Folder folder;
    const auto samplers = [&](const std::string& sampler) {
        const Scene scene = read(scene_with_sampler(folder, sampler));
        CHECK(scene.materials[0].emission_texture.sampler == TextureSampler{});
        return scene.materials[0].diffuse_texture.sampler;
    };
    CHECK(samplers(R"({"wrapS":33071,"wrapT":33648})") ==
          TextureSampler{TextureWrap::clamp, TextureWrap::mirror, TextureFilter::linear});
    CHECK(samplers(R"({"wrapT":33071,"magFilter":9728,"minFilter":9987})") ==
          TextureSampler{TextureWrap::repeat, TextureWrap::clamp, TextureFilter::nearest});
    CHECK(samplers(R"({"wrapS":10497,"magFilter":9729})") == TextureSampler{});
    CHECK(warns(read(scene_with_sampler(folder, R"({"wrapS":1,"magFilter":"x"})")), "wrap modes or filters"));
}

TEST_CASE("MTL: -clamp on ends at the picture's edge") {
    const Folder folder;
    folder.write("a.mtl", "newmtl a\nmap_Kd -clamp on w.png\nmap_Ks -clamp off w.png\nKs 1 1 1\n");
    folder.write("w.png", "not decoded here");
    const Scene scene = read(folder.write(
        "a.obj", "mtllib a.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n"));
    CHECK(scene.warnings.empty());
    CHECK(scene.materials[0].diffuse_texture.sampler ==
          TextureSampler{TextureWrap::clamp, TextureWrap::clamp, TextureFilter::linear});
    CHECK(scene.materials[0].specular_texture.sampler == TextureSampler{});
}
