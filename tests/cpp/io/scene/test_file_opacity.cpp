// Opacity from MTL's d and map_d and from glTF's alpha, and unlit materials.

#include "gltf_files.hpp"

using namespace scene_files;

namespace {

Scene read_with(const std::string& path, std::vector<std::uint8_t> pixel) {
    Reader reader{std::move(pixel), {}, {}};
    return *io::read_scene(path, {}, reader.function()).static_geometry;
}

/// The material of a triangle whose pictures all have this colour, and its scene's warnings.
struct Read {
    Material material;
    Scene scene;
};

Read mtl(const std::string& statements, std::vector<std::uint8_t> pixel = {255, 255, 255, 255}) {
    const Folder folder;
    folder.write("a.mtl", "newmtl m\n" + statements);
    folder.write("p.png", "not decoded here");
    const Scene scene =
        read_with(folder.write("a.obj", "mtllib a.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\n"),
                  std::move(pixel));
    return {scene.materials[scene.triangles[0].material], scene};
}

Read gltf_material(const std::string& json, std::vector<std::uint8_t> pixel = {255, 255, 255, 255}) {
    const Folder folder;
    folder.write("tri.bin", triangle_bytes());
    folder.write("p.png", "not decoded here");
    const Scene scene = read_with(
        folder.write("a.gltf",
                     gltf(R"([{"mesh":0}])", "[0]",
                          R"(,"textures":[{"source":0}],"images":[{"uri":"p.png"}],"materials":[)" + json + "]")),
        std::move(pixel));
    return {scene.materials[scene.triangles[0].material], scene};
}

const std::string kMap =
    R"("pbrMetallicRoughness":{"baseColorFactor":[1,0.5,0.25,0.8],"baseColorTexture":{"index":0}})";

}  // namespace

TEST_CASE("MTL: d and map_d say how much of the surface is there") {
    for (const char* model : {"illum 1\n", "illum 2\n", "illum 3\n", "illum 5\n", "illum 8\n", "Pr 0.5\n"}) {
        CAPTURE(model);
        const Material m = mtl(std::string(model) + "d 0.25\n").material;
        CHECK(m.opacity == 0.25f);
        CHECK(m.transmission == 0.0f);
    }
    const Read grey = mtl("map_d p.png\n", {10, 20, 60, 255});
    REQUIRE(grey.material.opacity_texture.texture == 0);
    CHECK(grey.material.opacity == 1.0f);
    CHECK(grey.scene.textures[0].rgba[3] == 30);  // without an alpha channel: the mean
    const Read alpha = mtl("map_d p.png\n", {10, 20, 60, 77});
    CHECK(alpha.scene.textures[0].rgba[3] == 77);
    CHECK(mtl("map_d p.png\n").material.opacity_texture.texture < 0);  // white: nothing to be asked for at every hit
}

TEST_CASE("MTL: glass, and films with a colour of their own, let light through in their own ways") {
    const Material film = mtl("illum 2\nd 0.25\nTf 1 0.5 0\n").material;
    CHECK((film.opacity == 1.0f && film.transmission == 0.75f && film.is_thin && film.ior == 1.0f));
    CHECK(film.filter.g == 0.5f);
    const Material glass = mtl("illum 7\nd 0.25\nNi 1.4\n").material;
    CHECK((glass.opacity == 1.0f && glass.transmission == 0.75f && !glass.is_thin && glass.ior == 1.4f));
    for (const char* model : {"illum 4\n", "illum 9\n"}) {
        const Material m = mtl(std::string(model) + "d 0.25\n").material;
        CHECK((m.opacity == 1.0f && m.transmission == 0.75f && m.is_thin));
    }
    CHECK(warns(mtl("illum 7\nmap_d p.png\n").scene, "has a map_d"));
}

TEST_CASE("glTF: alpha modes") {
    const std::vector<std::uint8_t> half = {255, 255, 255, 128};
    const Material opaque = gltf_material("{" + kMap + "}", half).material;
    CHECK_FALSE(opaque.has_holes());
    const Material blend = gltf_material("{" + kMap + R"(,"alphaMode":"BLEND"})", half).material;
    CHECK(blend.opacity == 0.8f);
    CHECK(blend.opacity_cutoff == 0.0f);
    CHECK(blend.opacity_texture.texture == blend.diffuse_texture.texture);
    const Material mask = gltf_material("{" + kMap + R"(,"alphaMode":"MASK","alphaCutoff":0.3})", half).material;
    CHECK(mask.opacity == 0.8f);
    CHECK(mask.opacity_cutoff == 0.3f);
    CHECK(mask.opacity_texture.texture == mask.diffuse_texture.texture);
    CHECK(gltf_material("{" + kMap + R"(,"alphaMode":"MASK"})", half).material.opacity_cutoff == 0.5f);
    // Everything reaches a cutoff of 0, and nothing one above 1.
    CHECK_FALSE(gltf_material("{" + kMap + R"(,"alphaMode":"MASK","alphaCutoff":0})", half).material.has_holes());
    const Material gone = gltf_material("{" + kMap + R"(,"alphaMode":"MASK","alphaCutoff":1.5})", half).material;
    CHECK((gone.opacity == 0.0f && gone.opacity_cutoff == 1.0f));
    // Exporters write BLEND for materials whose pictures have no holes.
    const Material whole =
        gltf_material(R"({"alphaMode":"BLEND","pbrMetallicRoughness":{"baseColorTexture":{"index":0}}})").material;
    CHECK_FALSE(whole.has_holes());
}

TEST_CASE("what is not lit shows its colour as a screen does, and says so") {
    const Read unlit = gltf_material("{" + kMap + R"(,"extensions":{"KHR_materials_unlit":{}}})");
    CHECK(unlit.material.emission == Color{100, 50, 25});
    CHECK(unlit.material.emission_texture.texture == 0);
    CHECK(unlit.material.emits_on_both_sides);
    CHECK(is_black(unlit.material.diffuse));
    CHECK(unlit.material.model == MaterialModel::phong);
    CHECK(warns(unlit.scene, "screen of 100 cd/m^2"));
    const Read constant = mtl("illum 0\nKd 0.5 0.25 1\nd 0.5\n");
    CHECK(constant.material.emission == Color{50, 25, 100});
    CHECK(constant.material.opacity == 0.5f);
    CHECK(constant.scene.has_light());
}

TEST_CASE("MTL: illumination model 10 shows shadows alone") {
    const Material m = mtl("illum 10\nKd 1 1 1\n").material;
    CHECK(m.only_shadows);
    CHECK(m.has_holes());
}

TEST_CASE("glTF: a double-sided material emits on both sides") {
    CHECK(gltf_material(R"({"emissiveFactor":[1,1,1],"doubleSided":true})").material.emits_on_both_sides);
    CHECK_FALSE(gltf_material(R"({"emissiveFactor":[1,1,1]})").material.emits_on_both_sides);
}
