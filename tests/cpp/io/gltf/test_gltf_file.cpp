// Scenes from glTF and GLB. The truth is the numbers in the files.

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "gltf_files.hpp"
#include "io/scene/scene_textures.hpp"

using namespace scene_files;

TEST_CASE("glTF: transforms of nested nodes, mirrored ones stay right side out") {
    const Folder folder;
    folder.write("tri.bin", triangle_bytes());
    // 90 degrees about z, then a shift; the child is mirrored in x and twice as high.
    const std::string nodes =
        R"([{"translation":[10,0,0],"rotation":[0,0,0.70710678,0.70710678],"children":[1,2]},
            {"mesh":0,"scale":[-1,2,1]}, {"mesh":0,"matrix":[1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,5,1]}])";
    const Scene scene = read(folder.write("t.gltf", gltf(nodes, "[0]")), 2.0);
    REQUIRE(scene.triangles.size() == 2);
    // (x, y) -> (10 - y, x), times 2.
    const Vec3d first[] = {{20, 0, 0}, {20, -2, 0}, {16, 0, 0}};
    for (const Vec3d& wanted : first) {
        bool found = false;
        for (int i = 0; i < 3; ++i) found |= length(corner(scene, 0, i) - wanted) < 1e-7;
        CHECK(found);
    }
    CHECK(corner(scene, 1, 1).y == doctest::Approx(2));
    CHECK(corner(scene, 1, 0).z == 10);
    for (std::size_t t = 0; t < 2; ++t) {
        CHECK(face_normal(scene, t).z == doctest::Approx(1));
        for (const std::uint32_t v : scene.triangles[t].vertices) check_vec(scene.normals[v], 0, 0, 1);
    }
}

TEST_CASE("glTF: normals turn with the inverse transpose of a stretched node") {
    const Folder folder;
    folder.write("tri.bin", triangle_bytes());
    // Turned by 45 degrees about y, and then stretched by 3 along x: the plane's own normal is the truth.
    const std::string nodes = R"([{"scale":[3,1,1],"children":[1]},{"mesh":0,"rotation":[0,0.38268343,0,0.92387953]}])";
    const Scene scene = read(folder.write("s.gltf", gltf(nodes, "[0]")));
    const Vec3d truth = face_normal(scene, 0);
    CHECK(truth.x == doctest::Approx(1 / std::sqrt(10.0)));
    check_vec(scene.normals[0], truth.x, truth.y, truth.z, 1e-6);
}

TEST_CASE("glTF: a node a million metres away keeps its shape, in double precision") {
    const Folder folder;
    folder.write("tri.bin", triangle_bytes({0, 1, 2}, 0.001f));
    const std::string nodes =
        R"([{"translation":[1000000.1,0,-3e6],"children":[1]},{"mesh":0,"translation":[0.0001,0,0]}])";
    const Scene scene = read(folder.write("far.gltf", gltf(nodes, "[0]")));
    CHECK(corner(scene, 0, 0).x == 1000000.1 + 0.0001);
    CHECK(corner(scene, 0, 1).x - corner(scene, 0, 0).x == doctest::Approx(0.001).epsilon(1e-6));
    CHECK(corner(scene, 0, 0).z == -3e6);
}

TEST_CASE("glTF: metallic-roughness and emission in cd/m^2") {
    const Folder folder;
    folder.write("tri.bin", triangle_bytes());
    // Meshes in another order than the file's: materials keep their numbers.
    const std::string more = R"(,"materials":[
        {"name":"same","pbrMetallicRoughness":{"baseColorFactor":[0.5,0.25,0.125,1],"metallicFactor":0.25,
         "roughnessFactor":0.5},"emissiveFactor":[1,0.5,0],
         "extensions":{"KHR_materials_emissive_strength":{"emissiveStrength":2000},"KHR_materials_ior":{"ior":1.4},
         "KHR_materials_transmission":{"transmissionFactor":0.5},"KHR_materials_clearcoat":{"clearcoatFactor":0.3,
         "clearcoatRoughnessFactor":0.2},"KHR_materials_specular":{"specularFactor":0.8,"specularColorFactor":[1,0.5,0]},
         "KHR_materials_volume":{"thicknessFactor":1,"attenuationDistance":0.5,"attenuationColor":[1,0.5,0.25]}}}])";
    const Scene scene = read(folder.write("m.gltf", gltf(R"([{"mesh":1},{"mesh":0}])", "[0,1]", more)), 2.0);
    const Material& none = scene.materials[scene.triangles[0].material];
    check_vec(none.diffuse, .5, .5, .5);
    check_vec(none.emission, 0, 0, 0);
    const Material& m = scene.materials[scene.triangles[1].material];
    CHECK(m.model == MaterialModel::metallic_roughness);
    check_vec(m.diffuse, .5, .25, .125);
    CHECK(m.metallic == 0.25f);
    CHECK(m.roughness == 0.5f);
    CHECK(m.ior == 1.4f);
    CHECK(m.transmission == 0.5f);
    CHECK(m.is_thin == 0);
    CHECK(m.clearcoat == 0.3f);
    CHECK(m.clearcoat_roughness == 0.2f);
    CHECK(m.specular_weight == 0.8f);
    check_vec(m.specular, 1, 0.5, 0);
    check_vec(m.emission, 2000, 1000, 0);
    // Half a unit of the file is a metre: ln 2 and ln 4 of it are lost there.
    check_vec(m.absorption, 0, std::log(2), std::log(4));
    CHECK(m.scattering == Color{0, 0, 0});
}

TEST_CASE("glTF: pictures as files, and their transform") {
    const Folder folder;
    folder.write("tri.bin", triangle_bytes());
    folder.write("my t.png", "not decoded here");
    const std::string more = R"(,"materials":[{"pbrMetallicRoughness":{"metallicFactor":1,"baseColorTexture":{"index":0,
        "extensions":{"KHR_texture_transform":{"offset":[0,1],"rotation":1.57079632679,"scale":[0.5,0.25]}}}}}],
        "textures":[{"source":0}],"images":[{"uri":"my%20t.png"}])";
    Reader reader;
    const Scene scene =
        *io::read_scene(folder.write("u.gltf", gltf(R"([{"mesh":0}])", "[0]", more)), {}, reader.function())
             .static_geometry;
    CHECK(reader.asked.front() == "my t.png");
    CHECK(scene.warnings.empty());
    // The file's (u, v), v downwards: (0, 1), (1, 1), (0, 0). Turned by 90 degrees, (0.5 u, 0.25 v) -> (0.25 v, -0.5
    // u).
    const double truth[][2] = {{0.25, 1}, {0.25, 0.5}, {0, 1}};
    for (int i = 0; i < 3; ++i) {
        const Vec2f at = scene.uvs[scene.triangles[0].vertices[i]];
        const TextureReference& texture = scene.materials[scene.triangles[0].material].diffuse_texture;
        const Vec2f uv = {dot(texture.to_u, Vec3f{at.x, at.y, 1}), dot(texture.to_v, Vec3f{at.x, at.y, 1})};
        CHECK(double(uv.x) == doctest::Approx(truth[i][0]).epsilon(1e-6));
        CHECK(1 - double(uv.y) == doctest::Approx(truth[i][1]).epsilon(1e-6));
    }
}

TEST_CASE("GLB: the picture inside reaches the reader as bytes, and the geometry is read") {
    const Folder folder;
    const std::string picture = "PICTURE!";
    std::string bytes = triangle_bytes(),
                json = gltf(R"([{"mesh":0}])", "[0]", R"(,"materials":[{"pbrMetallicRoughness":
        {"metallicFactor":0,"baseColorTexture":{"index":0}}}],"textures":[{"source":0}],
        "images":[{"bufferView":4,"mimeType":"image/png"}])");
    json.replace(json.find(R"(}],
           "buffers")"),
                 2, R"(},{"buffer":0,"byteOffset":104,"byteLength":8}])");
    json.replace(json.find(R"("byteLength":104,"uri":"tri.bin")"), 32, R"("byteLength":112)");
    while (json.size() % 4) json += ' ';
    bytes += picture;
    const auto word = [](std::size_t value) {
        const auto v = static_cast<std::uint32_t>(value);
        return std::string(reinterpret_cast<const char*>(&v), 4);
    };
    const std::string glb = "glTF" + word(2) + word(28 + json.size() + bytes.size()) + word(json.size()) + "JSON" +
                            json + word(bytes.size()) + std::string("BIN\0", 4) + bytes;
    Reader reader;
    const Scene scene = *io::read_scene(folder.write("a.GLB", glb), {}, reader.function()).static_geometry;
    CHECK(scene.triangles.size() == 1);
    CHECK(reader.asked == std::vector<std::string>{"bytes"});
    CHECK(std::string(reader.bytes.begin(), reader.bytes.end()) == picture);
    CHECK(has(error_of(folder.write("short.glb", glb.substr(0, glb.size() - 20))), "is cut short"));
    CHECK(has(error_of(folder.write("header.glb", glb.substr(0, 10))), "ends inside the header"));
}

TEST_CASE("glTF: lights in candela and lux, at every node that has them") {
    const Folder folder;
    folder.write("tri.bin", triangle_bytes());
    const std::string more = R"(,"extensions":{"KHR_lights_punctual":{"lights":[
        {"type":"point","color":[1,0.5,0.25],"intensity":40},{"type":"directional","intensity":1000},{"type":"spot"}]}})";
    const auto light = [](int i, const std::string& rest) {
        return R"({"name":"same",)" + rest + R"("extensions":{"KHR_lights_punctual":{"light":)" + std::to_string(i) +
               "}}}";
    };
    const std::string nodes = "[{\"mesh\":0,\"name\":\"same\"}," + light(0, R"("translation":[1,2,3],)") + "," +
                              light(0, R"("translation":[9,9,9],)") + "," +
                              light(1, R"("rotation":[-0.70710678,0,0,0.70710678],)") + "," + light(2, "") + "]";
    const Scene scene = read(folder.write("l.gltf", gltf(nodes, "[0,1,2,3,4]", more)), 0.5);
    REQUIRE(scene.points.size() == 3);
    CHECK(scene.points[0].position_m.y == 1.0);
    CHECK(scene.points[1].position_m.x == 4.5);
    check_vec(scene.points[0].intensity, 40, 20, 10);
    check_vec(scene.points[2].intensity, 1, 1, 1);
    CHECK(length(scene.points[0].axis) == 0);
    check_vec(static_cast<Vec3f>(scene.points[2].axis), 0, 0, -1);
    CHECK(scene.points[2].inner_cone_rad == 0);
    CHECK(scene.points[2].outer_cone_rad == doctest::Approx(0.785398163));
    REQUIRE(scene.suns.size() == 1);
    check_vec(scene.suns[0].illuminance, 1000, 1000, 1000);
    CHECK(double(scene.suns[0].direction.y) == doctest::Approx(-1));
}

TEST_CASE("bad glTF: the mesh and the vertex are named") {
    const Folder folder;
    const std::string nodes = R"([{"mesh":0}])";
    folder.write("tri.bin", triangle_bytes({0, 1, 7}));
    CHECK(has(error_of(folder.write("a.gltf", gltf(nodes, "[0]"))),
              "index 7 is not smaller than the number of vertices, 3"));
    folder.write("tri.bin", triangle_bytes({0, 1, 2, 0, 1, 3}));
    CHECK(has(error_of(folder.write("a.gltf", gltf(nodes, "[0]", "", "", 6))),
              "mesh 0 \"tri\": index 3 is not smaller than the number of vertices, 3"));
    folder.write("tri.bin", triangle_bytes({0, 1, 2}, std::numeric_limits<float>::infinity()));
    CHECK(has(error_of(folder.write("a.gltf", gltf(nodes, "[0]"))), "mesh 0 \"tri\": vertex 1: coordinates must be"));
    CHECK(has(error_of(folder.write("b.gltf", gltf(R"([{"name":"x"}])", "[0]"))), "holds no triangles"));
    CHECK(has(error_of(folder.write("c.gltf", "{\n\"asset\": {\n")), "line 3"));
    CHECK(has(error_of(folder.write("d.gltf", R"({"asset":{"version":"1.0"}})")), "expected glTF 2.0"));
    CHECK(has(error_of(folder.write("e.gltf", gltf(nodes, "[0]", R"(,"extensionsRequired":["KHR_texture_basisu"])"))),
              "needs the glTF extension KHR_texture_basisu"));
    fs::remove(folder.path("tri.bin"));
    CHECK(has(error_of(folder.path("a.gltf")), "cannot be read"));
}
