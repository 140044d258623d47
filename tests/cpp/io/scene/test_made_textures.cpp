// Textures that are made of a file's pictures. The truth: sines, whose central differences are a closed form, and the
// definitions of the formats.

#include <cmath>
#include <string>
#include <vector>

#include "gltf_files.hpp"
#include "io/scene/made_textures.hpp"

using namespace scene_files;

namespace {

constexpr int kWidth = 16, kHeight = 12;
constexpr double kTurn = 2 * M_PI;

/// f(column, row) in red, green and blue.
template <class F>
DecodedImage floats(int width, int height, F&& f) {
    std::vector<float> rgba;
    for (int row = 0; row < height; ++row)
        for (int column = 0; column < width; ++column) {
            const auto v = static_cast<float>(f(column, row));
            rgba.insert(rgba.end(), {v, v, v, 1.0f});
        }
    return {width, height, rgba, true};
}

/// The normal of a texel.
Vec3d normal_at(const Texture& texture, int column, int row) {
    const float* p = texture.linear_rgba.data() + 4 * (row * texture.width + column);
    return {2 * static_cast<double>(p[0]) - 1, 2 * static_cast<double>(p[1]) - 1, 2 * static_cast<double>(p[2]) - 1};
}

/// Scene read from an OBJ of one triangle with texture coordinates and this material; every image decodes to `pixel`.
Scene obj_with(const Folder& folder, const std::string& material, std::vector<std::uint8_t> pixel) {
    for (const char* name : {"a.png", "b.png"}) folder.write(name, "not decoded here");
    folder.write("m.mtl", "newmtl m\n" + material);
    Reader reader;
    reader.pixel = std::move(pixel);
    return *io::read_scene(folder.write("t.obj",
                                        "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n"
                                        "usemtl m\nf 1/1 2/2 3/3\n"),
                           {}, reader.function())
                .static_geometry;
}

const Material& used(const Scene& scene) {
    return scene.materials[scene.triangles[0].material];
}
const Texture& texture_of(const Scene& scene, const TextureReference& reference) {
    REQUIRE(reference.texture >= 0);
    return scene.textures[static_cast<std::size_t>(reference.texture)];
}

}  // namespace

TEST_CASE("heights become normals by central differences, across the edges") {
    const double scale = 3;
    const DecodedImage along_u =
        floats(kWidth, kHeight, [](int column, int) { return 0.5 + 0.25 * std::sin(kTurn * column / kWidth); });
    const Texture u = io::normals_of_heights(along_u, static_cast<float>(scale), true, "u");
    // Rows run downwards, and v upwards.
    const DecodedImage along_v =
        floats(kWidth, kHeight, [](int, int row) { return 0.5 + 0.25 * std::sin(-kTurn * row / kHeight); });
    const Texture v = io::normals_of_heights(along_v, static_cast<float>(scale), true, "v");
    CHECK(u.encoding == TextureEncoding::linear);
    for (int i = 0; i < kHeight; ++i) {
        const auto wanted = [&](int length, double at) {
            const double slope = scale * 0.25 * std::cos(kTurn * at / length) * std::sin(kTurn / length);
            return (1 / std::sqrt(1 + slope * slope)) * Vec3d{-slope, 0, 1};
        };
        const Vec3d a = wanted(kWidth, i), b = wanted(kHeight, -i);
        // A rounding of heights near 1, times the scale, and that of the code.
        CHECK(length(normal_at(u, i, 5) - a) < 1e-6);
        CHECK(length(normal_at(v, 5, i) - Vec3d{0, b.x, b.z}) < 1e-6);
    }
}

TEST_CASE("heights of any scale become normals that are numbers") {
    const DecodedImage steps = floats(4, 4, [](int column, int row) { return (column + row) % 2; });
    for (const float scale : {0.0f, -1e30f, 3e38f})
        for (const float n : io::normals_of_heights(steps, scale, true, "").linear_rgba) CHECK((n >= 0 && n <= 1));
}

TEST_CASE("roughness and metallic of two sizes go into one picture") {
    const DecodedImage roughness = floats(2, 1, [](int column, int) { return column; });
    const DecodedImage metallic = floats(4, 2, [](int column, int row) { return (column + 4 * row) / 8.0; });
    const Texture both = io::roughness_and_metallic(&roughness, &metallic, "both");
    CHECK(both.width == 4);
    CHECK(both.height == 2);
    // The middles of four texels lie at -0.25, 0.25, 0.75 and 1.25 of the two, and the picture repeats.
    const double wanted[] = {0.25, 0.25, 0.75, 0.75};
    for (std::size_t i = 0; i < 4; ++i) {
        CHECK(both.rgba[4 * i + 1] == std::lround(255 * wanted[i]));
        CHECK(both.rgba[4 * i + 2] == std::lround(255 * static_cast<double>(i) / 8));
    }
    const Texture one = io::roughness_and_metallic(nullptr, &metallic, "one");
    CHECK(one.width == 4);
    CHECK(one.rgba[1] == 255);
}

TEST_CASE("MTL: maps of roughness, metallic, shininess and heights") {
    const Folder folder;
    const Scene both = obj_with(folder, "Pr 0.5\nPm 1\nmap_Pr a.png\nmap_Pm b.png\n", {51, 51, 51, 255});
    CHECK(used(both).roughness == 0.5f);
    const Texture& map = texture_of(both, used(both).metallic_roughness_texture);
    CHECK(map.rgba == std::vector<std::uint8_t>{255, 51, 51, 255});
    CHECK(map.encoding == TextureEncoding::linear);
    CHECK(both.textures.size() == 1);
    CHECK(both.warnings.empty());

    const Scene metal = obj_with(folder, "Pm 1\nmap_Pm a.png\n", {51, 51, 51, 255});
    CHECK(texture_of(metal, used(metal).metallic_roughness_texture).rgba ==
          std::vector<std::uint8_t>{255, 255, 51, 255});

    const Scene shiny = obj_with(folder, "Ks 1 1 1\nNs 100\nmap_Ns a.png\n", {102, 102, 102, 255});
    CHECK(used(shiny).model == MaterialModel::phong);
    CHECK(texture_of(shiny, used(shiny).metallic_roughness_texture).rgba[1] == 102);
    CHECK_FALSE(used(shiny).is_plain());

    const Scene bumped = obj_with(folder, "map_Bump -bm 2 -s 3 3 a.png\n", {9, 9, 9, 255});
    CHECK(texture_of(bumped, used(bumped).normal_texture).linear_rgba == std::vector<float>{0.5f, 0.5f, 1, 1});
    CHECK(used(bumped).normal_texture.to_u.x == 3);
    CHECK(bumped.warnings.empty());
    const Scene beside = obj_with(folder, "bump a.png\nnorm b.png\n", {128, 128, 255, 255});
    REQUIRE(beside.warnings.size() == 1);
    CHECK(has(beside.warnings[0], "bump map beside a normal map"));

    const Scene apart = obj_with(folder, "Pr 1\nmap_Pr -s 2 2 a.png\nmap_Pm b.png\n", {51, 51, 51, 255});
    REQUIRE(apart.warnings.size() == 1);
    CHECK(has(apart.warnings[0], "with different transforms"));
    const Scene missing = obj_with(folder, "Pr 1\nmap_Pr none.png\n", {51, 51, 51, 255});
    CHECK(used(missing).metallic_roughness_texture.texture == -1);
    REQUIRE(missing.warnings.size() == 1);
    CHECK(has(missing.warnings[0], "none.png"));
}

TEST_CASE("glTF: maps of transmission, coat and specular; gloss becomes roughness") {
    const Folder folder;
    folder.write("tri.bin", triangle_bytes());
    folder.write("a.png", "not decoded here");
    const auto read_with = [&](const std::string& extensions) {
        const std::string more =
            R"(,"textures":[{"source":0}],"images":[{"uri":"a.png"}],"materials":[{"extensions":{)" + extensions +
            "}}]";
        Reader reader;
        reader.pixel = {10, 20, 30, 102};
        return *io::read_scene(folder.write("m.gltf", gltf(R"([{"mesh":0}])", "[0]", more)), {}, reader.function())
                    .static_geometry;
    };
    const std::string map = R"({"index":0})";
    const Scene scene =
        read_with(R"("KHR_materials_transmission":{"transmissionFactor":0.5,"transmissionTexture":)" + map +
                  R"(},"KHR_materials_clearcoat":{"clearcoatFactor":1,"clearcoatTexture":)" + map +
                  R"(,"clearcoatRoughnessTexture":)" + map + R"(,"clearcoatNormalTexture":{"index":0,"scale":0.5}},)" +
                  R"("KHR_materials_specular":{"specularTexture":)" + map + R"(,"specularColorTexture":)" + map +
                  R"(},"KHR_materials_volume":{"thicknessFactor":1,"thicknessTexture":)" + map + "}");
    const Material& m = used(scene);
    for (const auto member :
         {&Material::transmission_texture, &Material::clearcoat_texture, &Material::clearcoat_roughness_texture,
          &Material::clearcoat_normal_texture, &Material::specular_weight_texture})
        CHECK(texture_of(scene, m.*member).encoding == TextureEncoding::linear);
    CHECK(texture_of(scene, m.specular_texture).encoding == TextureEncoding::srgb);
    CHECK(m.clearcoat_normal_scale == 0.5f);
    CHECK(scene.textures.size() == 2);  // one picture, as numbers and as colours
    REQUIRE(scene.warnings.size() == 1);
    CHECK(has(scene.warnings[0], "thickness"));

    // glossiness 0.5 x 102/255 = 0.2
    const Scene older = read_with(
        R"("KHR_materials_pbrSpecularGlossiness":{"glossinessFactor":0.5,"specularGlossinessTexture":)" + map + "}");
    CHECK(used(older).roughness == 1);
    CHECK(texture_of(older, used(older).metallic_roughness_texture).rgba[1] == 204);
    CHECK(texture_of(older, used(older).specular_texture).encoding == TextureEncoding::srgb);
    CHECK(older.warnings.empty());
}
