// Materials and lights of glTF files, property by property. The truth is the specification of glTF 2.0 and of its
// Khronos extensions: names, defaults and ranges.

#include <cmath>
#include <limits>
#include <string>

#include "gltf_files.hpp"
#include "io/gltf/gltf_file.hpp"

using namespace scene_files;
using io::AlphaMode;
using io::FileTexture;
using io::GltfMaterial;

namespace {

/// A texture info of the picture "N.png" with "more" members, such as "\"scale\":2".
std::string info(int picture, const std::string& more = "") {
    return "{\"index\":" + std::to_string(picture) + (more.empty() ? "" : "," + more) + "}";
}

struct GltfFile {
    Folder folder;
    io::FileScene scene;

    GltfFile() { folder.write("tri.bin", triangle_bytes()); }

    void read(const std::string& more) {
        Checkpoint checkpoint;
        scene = io::read_gltf(folder.write("m.gltf", gltf(R"([{"mesh":0}])", "[0]", more)), {}, checkpoint);
    }
    /// The material with the members of `json`, in a file with twenty textures and as many pictures.
    GltfMaterial material(const std::string& json, const std::string& more = "") {
        std::string textures, images;
        for (int i = 0; i < 20; ++i) {
            textures += (i ? "," : "") + std::string("{\"source\":") + std::to_string(i) + "}";
            images += (i ? "," : "") + std::string("{\"uri\":\"") + std::to_string(i) + ".png\"}";
        }
        read(",\"materials\":[{" + json + "}],\"textures\":[" + textures + "],\"images\":[" + images + "]" + more);
        return std::get<GltfMaterial>(scene.materials[0].content);
    }
    GltfMaterial extended(const std::string& extension, const std::string& json) {
        return material("\"extensions\":{\"" + extension + "\":{" + json + "}}");
    }
    bool warned(const std::string& part) const {
        for (const std::string& warning : scene.warnings)
            if (has(warning, part)) return true;
        return false;
    }
};

void check_picture(const FileTexture& texture, int picture) {
    CHECK(texture.picture == picture);
}

}  // namespace

TEST_CASE("glTF: metallic-roughness, maps of the surface, emission and alpha") {
    GltfFile file;
    const GltfMaterial m = file.material(
        R"("pbrMetallicRoughness":{"baseColorFactor":[0.1,0.2,0.3,0.4],"metallicFactor":0.5,"roughnessFactor":0.6,
           "baseColorTexture":)" +
        info(1) + R"(,"metallicRoughnessTexture":)" + info(2) + R"(},
           "normalTexture":)" +
        info(3, R"("scale":-1.5)") + R"(,"emissiveTexture":)" + info(5) + R"(,
           "emissiveFactor":[0.7,0.8,0.9],"alphaMode":"MASK","alphaCutoff":0.25,"doubleSided":true,
           "extensions":{"KHR_materials_emissive_strength":{"emissiveStrength":100}})");
    check_vec(m.base_color_factor, .1, .2, .3);
    CHECK(m.alpha == 0.4f);
    CHECK(m.metallic_factor == 0.5f);
    CHECK(m.roughness_factor == 0.6f);
    check_picture(m.base_color_texture, 1);
    check_picture(m.metallic_roughness_texture, 2);
    check_picture(m.normal_texture, 3);
    CHECK(m.normal_scale == -1.5f);
    check_picture(m.emissive_texture, 5);
    check_vec(m.emissive_factor, .7, .8, .9);
    CHECK(m.emissive_strength == 100.0f);
    CHECK(m.alpha_mode == AlphaMode::mask);
    CHECK(m.alpha_cutoff == 0.25f);
    CHECK(m.double_sided);
    CHECK(file.scene.warnings.empty());
    CHECK(file.material(R"("alphaMode":"BLEND")").alpha_mode == AlphaMode::blend);
    CHECK(file.material(R"("alphaMode":"OPAQUE")").alpha_mode == AlphaMode::opaque);
}

TEST_CASE("glTF: what a material does not say") {
    GltfFile file;
    const GltfMaterial m = file.material(R"("name":"m","extensions":{"KHR_materials_ior":{},"KHR_materials_volume":{},
        "KHR_materials_transmission":{},"KHR_materials_clearcoat":{},"KHR_materials_specular":{}})");
    check_vec(m.base_color_factor, 1, 1, 1);
    CHECK(m.alpha == 1.0f);
    CHECK(m.metallic_factor == 1.0f);
    CHECK(m.roughness_factor == 1.0f);
    check_vec(m.emissive_factor, 0, 0, 0);
    CHECK(m.emissive_strength == 1.0f);
    CHECK(m.normal_scale == 1.0f);
    CHECK(m.occlusion_strength == 1.0f);
    CHECK(m.alpha_mode == AlphaMode::opaque);
    CHECK(m.alpha_cutoff == 0.5f);
    CHECK_FALSE(m.double_sided);
    CHECK_FALSE(m.unlit);
    CHECK(m.ior == 1.5f);
    CHECK(m.transmission.factor == 0.0f);
    CHECK(m.volume.thickness_factor == 0.0f);
    CHECK(std::isinf(m.volume.attenuation_distance));
    check_vec(m.volume.attenuation_color, 1, 1, 1);
    CHECK(m.clearcoat.factor == 0.0f);
    CHECK(m.clearcoat.roughness_factor == 0.0f);
    CHECK(m.clearcoat.normal_scale == 1.0f);
    CHECK(m.specular.factor == 1.0f);
    check_vec(m.specular.color_factor, 1, 1, 1);
    CHECK_FALSE(m.specular_glossiness);
    CHECK(m.textures().empty());
    const auto older = file.extended("KHR_materials_pbrSpecularGlossiness", "").specular_glossiness;
    REQUIRE(older);
    check_vec(older->diffuse_factor, 1, 1, 1);
    check_vec(older->specular_factor, 1, 1, 1);
    CHECK(older->glossiness_factor == 1.0f);
    CHECK(older->alpha == 1.0f);
    CHECK(file.scene.warnings.empty());
}

TEST_CASE("glTF: extensions of materials") {
    GltfFile file;
    CHECK(file.extended("KHR_materials_ior", R"("ior":1.33)").ior == 1.33f);
    CHECK(file.extended("KHR_materials_ior", R"("ior":0)").ior == 0.0f);  // "a value of 0 ... fresnel term becomes 1"
    CHECK(file.scene.warnings.empty());
    CHECK(file.extended("KHR_materials_unlit", "").unlit);

    const auto transmission =
        file.extended("KHR_materials_transmission", R"("transmissionFactor":0.9,"transmissionTexture":)" + info(6))
            .transmission;
    CHECK(transmission.factor == 0.9f);
    check_picture(transmission.texture, 6);

    const auto volume = file.extended("KHR_materials_volume", R"("thicknessFactor":2.5,"attenuationDistance":0.006,
            "attenuationColor":[0.5,0.25,0.125],"thicknessTexture":)" +
                                                                  info(7))
                            .volume;
    CHECK(volume.thickness_factor == 2.5f);
    CHECK(volume.attenuation_distance == 0.006f);
    check_vec(volume.attenuation_color, .5, .25, .125);
    check_picture(volume.thickness_texture, 7);
    for (const char* name : {"multiscatterColorFactor", "multiscatterColor"}) {
        const auto scatter = file.extended("KHR_materials_volume_scatter",
                                           "\"" + std::string(name) + R"(":[0.5,0.25,0.125],"scatterAnisotropy":-0.25)")
                                 .volume;
        check_vec(scatter.multiscatter_color_factor, .5, .25, .125);
        CHECK(scatter.scatter_anisotropy == -0.25f);
    }
    file.extended("KHR_materials_volume_scatter", R"("multiscatterColorTexture":)" + info(7));
    CHECK(file.warned("multiscatterColorTexture is not modelled"));

    const auto clearcoat = file.extended("KHR_materials_clearcoat",
                                         R"("clearcoatFactor":0.75,"clearcoatRoughnessFactor":0.125,
            "clearcoatTexture":)" + info(8) + R"(,"clearcoatRoughnessTexture":)" +
                                             info(9) + R"(,"clearcoatNormalTexture":)" + info(10, R"("scale":2)"))
                               .clearcoat;
    CHECK(clearcoat.factor == 0.75f);
    CHECK(clearcoat.roughness_factor == 0.125f);
    check_picture(clearcoat.texture, 8);
    check_picture(clearcoat.roughness_texture, 9);
    check_picture(clearcoat.normal_texture, 10);
    CHECK(clearcoat.normal_scale == 2.0f);

    const auto specular =
        file.extended("KHR_materials_specular", R"("specularFactor":0.5,"specularColorFactor":[2,0.5,0.25],
            "specularTexture":)" + info(11) + R"(,"specularColorTexture":)" +
                                                    info(12))
            .specular;
    CHECK(specular.factor == 0.5f);
    check_vec(specular.color_factor, 2, .5, .25);  // "may be greater than 1"
    check_picture(specular.texture, 11);
    check_picture(specular.color_texture, 12);

    const GltfMaterial m = file.extended("KHR_materials_pbrSpecularGlossiness",
                                         R"("diffuseFactor":[0.1,0.2,0.3,0.4],"specularFactor":[0.5,0.6,0.7],
            "glossinessFactor":0.8,"diffuseTexture":)" +
                                             info(13) + R"(,"specularGlossinessTexture":)" + info(14));
    REQUIRE(m.specular_glossiness);
    check_vec(m.specular_glossiness->diffuse_factor, .1, .2, .3);
    CHECK(m.specular_glossiness->alpha == 0.4f);
    check_vec(m.specular_glossiness->specular_factor, .5, .6, .7);
    CHECK(m.specular_glossiness->glossiness_factor == 0.8f);
    check_picture(m.specular_glossiness->diffuse_texture, 13);
    check_picture(m.specular_glossiness->specular_glossiness_texture, 14);
    check_picture(m.colour_texture(), 13);
}

TEST_CASE("glTF: every texture has its transform and its set of coordinates") {
    GltfFile file;
    int picture = 0;
    const auto next = [&] {
        const std::string scale = std::to_string(++picture);
        return info(picture, R"("texCoord":1,"extensions":{"KHR_texture_transform":{"scale":[)" + scale + ",1]}}");
    };
    const auto all_of = [&](const std::string& json, int count) {
        const GltfMaterial material = file.material(json);
        CHECK(material.textures().size() == static_cast<std::size_t>(count));
        for (const FileTexture* texture : material.textures()) {
            CHECK(texture->uv_set == 0);
            CHECK(texture->transform(1, 0).x == static_cast<float>(texture->picture));
        }
        CHECK(file.scene.materials[0].uv_sets() == std::vector<std::uint32_t>{1});
        CHECK(file.scene.warnings.empty());
    };
    // One statement each: the order in which the operands of a sum are computed is not fixed.
    std::string json = R"("pbrMetallicRoughness":{"baseColorTexture":)" + next();
    json += R"(,"metallicRoughnessTexture":)" + next();
    json += R"(},"normalTexture":)" + next();
    json += R"(,"emissiveTexture":)" + next();
    json += R"(,"extensions":{"KHR_materials_transmission":{"transmissionTexture":)" + next();
    json += R"(},"KHR_materials_volume":{"thicknessTexture":)" + next();
    json += R"(},"KHR_materials_clearcoat":{"clearcoatTexture":)" + next();
    json += R"(,"clearcoatRoughnessTexture":)" + next();
    json += R"(,"clearcoatNormalTexture":)" + next();
    json += R"(},"KHR_materials_specular":{"specularTexture":)" + next();
    json += R"(,"specularColorTexture":)" + next();
    all_of(json + "}}", 11);
    // In place of base colour and metallic-roughness.
    json += R"(},"KHR_materials_pbrSpecularGlossiness":{"diffuseTexture":)" + next();
    json += R"(,"specularGlossinessTexture":)" + next();
    all_of(json + "}}", 11);
    // texCoord of the transform overrides that of the texture.
    const GltfMaterial m = file.material(R"("normalTexture":)" + info(0, R"("texCoord":1,
        "extensions":{"KHR_texture_transform":{"texCoord":0}})"));
    CHECK(m.uv_sets == std::vector<std::uint32_t>{0});
}

TEST_CASE("glTF: vertices get the sets of coordinates of the material's textures") {
    GltfFile file;
    const auto uvs = [&](const std::string& json) {
        const std::string text = gltf(R"([{"mesh":0}])", "[0]", ",\"materials\":[{" + json + R"(}],
            "textures":[{"source":0}],"images":[{"uri":"a.png"}])",
                                      R"(,"NORMAL":1,"TEXCOORD_1":2)");
        Checkpoint checkpoint;
        const io::FileVertices vertices = io::read_gltf(file.folder.write("u.gltf", text), {}, checkpoint).vertices[0];
        return std::pair(vertices.uvs.size(), vertices.second_uvs.size());
    };
    const auto sizes = [](std::size_t first, std::size_t second) { return std::pair(first, second); };
    const std::string base = R"("pbrMetallicRoughness":{"baseColorTexture":)";
    const std::string set1 = info(0, R"("texCoord":1)"), set2 = info(0, R"("texCoord":2)");
    CHECK(uvs(R"("normalTexture":)" + info(0)) == sizes(0, 0));
    CHECK(uvs(R"("normalTexture":)" + set1) == sizes(3, 0));
    CHECK(uvs(base + info(0) + R"(},"normalTexture":)" + set1) == sizes(0, 3));
    CHECK(uvs(base + set1 + R"(},"normalTexture":)" + set2) == sizes(3, 0));
    CHECK(uvs(base + set1 + R"(},"normalTexture":)" + set1) == sizes(3, 0));
    CHECK(uvs(R"("occlusionTexture":)" + set1) == sizes(0, 0));  // it is not looked at
}

TEST_CASE("glTF: what is not modelled is named once") {
    GltfFile file;
    const GltfMaterial m = file.material(R"("occlusionTexture":)" + info(4, R"("strength":0.5,"texCoord":1)") + R"(,
        "normalTexture":)" + info(3) + R"(,"extensions":{"KHR_materials_sheen":{},"KHR_materials_iridescence":{}}},
        {"occlusionTexture":)" + info(4) + R"(,"extensions":{"KHR_materials_sheen":{},"KHR_materials_anisotropy":{},
        "KHR_materials_dispersion":{}})",
                                         R"(,"extensionsUsed":["KHR_materials_sheen","KHR_materials_variants",
        "KHR_materials_variants","KHR_materials_clearcoat","KHR_texture_transform","KHR_lights_punctual",
        "KHR_materials_ior","KHR_mesh_quantization","VENDOR_\nnew line"])");
    check_picture(m.occlusion_texture, 4);
    CHECK(m.occlusion_strength == 0.5f);
    for (const char* name : {"KHR_materials_sheen", "KHR_materials_iridescence", "KHR_materials_anisotropy",
                             "KHR_materials_dispersion", "KHR_materials_variants", "VENDOR_ new line"})
        CHECK(file.warned("the extension " + std::string(name) + " is not modelled"));
    CHECK(file.warned("occlusionTexture is not modelled"));
    CHECK(file.scene.warnings.size() == 7);  // and not one for each material

    const GltfMaterial three =
        file.material(R"("pbrMetallicRoughness":{"baseColorTexture":)" + info(0) + R"(},"normalTexture":)" +
                      info(1, R"("texCoord":1)") + R"(,"emissiveTexture":)" + info(1, R"("texCoord":2)"));
    CHECK(file.warned("a third set of texture coordinates in one material is not modelled"));
    CHECK(file.scene.warnings.size() == 1);
    CHECK(three.normal_texture.uv_set == 1);
    CHECK(three.emissive_texture.uv_set == 0);
    file.material(R"("pbrMetallicRoughness":{"baseColorTexture":)" + info(0) + R"(}},{"normalTexture":)" +
                  info(1, R"("texCoord":1)"));
    CHECK(file.scene.warnings.empty());  // a set for each material
}

TEST_CASE("glTF: numbers that no material can have become the nearest, with one warning") {
    GltfFile file;
    const float largest = std::numeric_limits<float>::max();
    const GltfMaterial m = file.material(
        R"("pbrMetallicRoughness":{"baseColorFactor":[-1,2,1e300,7],"metallicFactor":-0.5,"roughnessFactor":1e300},
           "normalTexture":)" +
        info(0, R"("scale":-1e300)") + R"(,"alphaCutoff":-1,"extensions":{
           "KHR_materials_ior":{"ior":0.5},"KHR_materials_transmission":{"transmissionFactor":2},
           "KHR_materials_volume":{"thicknessFactor":-1,"attenuationDistance":-1,"attenuationColor":[2,-1,1]},
           "KHR_materials_clearcoat":{"clearcoatFactor":-1,"clearcoatRoughnessFactor":2},
           "KHR_materials_specular":{"specularFactor":3,"specularColorFactor":[-1,1e300,1]},
           "KHR_materials_pbrSpecularGlossiness":{"diffuseFactor":[2,-1,1,9],"specularFactor":[2,-1,1],
           "glossinessFactor":-1}})");
    check_vec(m.base_color_factor, 0, 1, 1);
    CHECK(m.alpha == 1.0f);
    CHECK(m.metallic_factor == 0.0f);
    CHECK(m.roughness_factor == 1.0f);
    CHECK(m.normal_scale == -largest);
    CHECK(m.alpha_cutoff == 0.0f);
    CHECK(m.ior == 1.0f);
    CHECK(m.transmission.factor == 1.0f);
    CHECK(m.volume.thickness_factor == 0.0f);
    CHECK(std::isinf(m.volume.attenuation_distance));
    check_vec(m.volume.attenuation_color, 1, 0, 1);
    CHECK(m.clearcoat.factor == 0.0f);
    CHECK(m.clearcoat.roughness_factor == 1.0f);
    CHECK(m.specular.factor == 1.0f);
    CHECK(m.specular.color_factor.x == 0.0f);
    CHECK(m.specular.color_factor.y == largest);
    REQUIRE(m.specular_glossiness);
    check_vec(m.specular_glossiness->diffuse_factor, 1, 0, 1);
    CHECK(m.specular_glossiness->alpha == 1.0f);
    check_vec(m.specular_glossiness->specular_factor, 1, 0, 1);
    CHECK(m.specular_glossiness->glossiness_factor == 0.0f);
    CHECK(file.scene.warnings.size() == 2);
    // 4 + 2 of the base, normal and cutoff, ior and transmission, 3 of the volume, 2 and 3 of the coats, 6.
    CHECK(file.warned("24 numbers of its materials are out of their range; the nearest number in the range is used"));
    CHECK(file.warned("an attenuationDistance must be positive; volumes without one absorb no light"));

    CHECK(file.extended("KHR_materials_volume", R"("attenuationDistance":1e-300)").volume.attenuation_distance > 0);
    CHECK(std::isinf(
        file.extended("KHR_materials_volume", R"("attenuationDistance":1e300)").volume.attenuation_distance));
    CHECK(std::isinf(file.extended("KHR_materials_volume", R"("attenuationDistance":0)").volume.attenuation_distance));
    // Values of a wrong type are ignored; the defaults apply.
    const GltfMaterial odd = file.material(R"("pbrMetallicRoughness":{"metallicFactor":"1","baseColorFactor":5},
        "doubleSided":"yes","alphaCutoff":null,"normalTexture":7,"extensions":[])");
    CHECK(odd.metallic_factor == 1.0f);
    check_vec(odd.base_color_factor, 1, 1, 1);
    CHECK_FALSE(odd.double_sided);
    CHECK(file.material(R"("alphaMode":"GLASS")").alpha_mode == AlphaMode::opaque);
    CHECK(file.warned("an alphaMode must be OPAQUE, MASK or BLEND, not \"GLASS\"; OPAQUE is used"));
}

TEST_CASE("glTF: a texture transform that is no finite number is left out") {
    GltfFile file;
    for (const char* wrong : {R"("scale":[1e300,1])", R"("offset":[0,-1e300])", R"("rotation":1e999)"}) {
        std::string text = info(0, R"("extensions":{"KHR_texture_transform":{)" + std::string(wrong) + "}}");
        const GltfMaterial m = file.material(R"("normalTexture":)" + text);
        CHECK(m.normal_texture.transform == io::TextureTransform());
        CHECK(file.warned("1 texture transforms are not finite; they are left out"));
    }
}

TEST_CASE("glTF: cones of spots") {
    GltfFile file;
    const auto light = [&](const std::string& json) {
        file.read(R"(,"extensions":{"KHR_lights_punctual":{"lights":[{)" + json + "}]}}");
        return file.scene.lights.at(0);
    };
    const io::FileLight plain = light(R"("type":"spot")");
    CHECK(plain.inner_cone_angle == 0.0);
    CHECK(plain.outer_cone_angle == doctest::Approx(M_PI / 4));
    const io::FileLight cone = light(R"("type":"spot","intensity":2,"color":[1,0.5,0.25],
        "spot":{"innerConeAngle":0.3,"outerConeAngle":0.6})");
    CHECK(cone.inner_cone_angle == 0.3);
    CHECK(cone.outer_cone_angle == 0.6);
    CHECK(cone.strength.y == 1.0);
    light(R"("type":"spot","spot":{"outerConeAngle":1.57079637})");  // pi / 2 in float, a little more
    CHECK(file.scene.warnings.empty());
    const io::FileLight wide = light(R"("type":"spot","spot":{"innerConeAngle":-1,"outerConeAngle":1e300})");
    CHECK(wide.inner_cone_angle == 0.0);
    CHECK(wide.outer_cone_angle == doctest::Approx(M_PI / 2));
    CHECK(file.warned("1 spots have invalid angles"));
    const io::FileLight crossed = light(R"("type":"spot","spot":{"innerConeAngle":1,"outerConeAngle":0.5})");
    CHECK(crossed.inner_cone_angle == 0.5);
    CHECK(file.warned("expected 0 <= innerConeAngle < outerConeAngle <= pi / 2"));
}

TEST_CASE("glTF: pictures inside the file are fetched for every texture that counts, and for no other") {
    GltfFile file;
    const std::string data = R"({"uri":"data:image/png;base64,QUJD"})";
    file.read(R"(,"materials":[{"normalTexture":)" + info(0) + R"(,"occlusionTexture":)" + info(1) +
              R"(,"extensions":{"KHR_materials_specular":{"specularColorTexture":)" + info(2) + R"(}}},
              {"normalTexture":)" +
              info(3) + R"(}],"textures":[{"source":0},{"source":1},{"source":2},{"source":3}],
              "images":[)" +
              data + "," + data + "," + data + "," + data + "]");
    CHECK(file.scene.pictures[0].bytes == "ABC");
    CHECK(file.scene.pictures[1].bytes.empty());  // occlusion
    CHECK(file.scene.pictures[2].bytes == "ABC");
    CHECK(file.scene.pictures[3].bytes.empty());  // of a material that no mesh has
}
