// Scenes from OBJ and PLY, and what no format forgives. The truth is the numbers in the files.

#include <bit>
#include <cmath>
#include <string>
#include <vector>

#include "scene_files.hpp"

namespace {

using namespace scene_files;

std::string ply(const std::string& body, int vertices = 3, int faces = 1) {
    return "ply\nformat ascii 1.0\nelement vertex " + std::to_string(vertices) +
           "\nproperty float x\nproperty float y\nproperty float z\nelement face " + std::to_string(faces) +
           "\nproperty list uchar int vertex_indices\nend_header\n" + body;
}

const std::string cube =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
    "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 3 4 8 7\nf 2 3 7 6\nf 4 1 5 8\n";

}  // namespace

TEST_CASE("OBJ: materials of the MTL as they are written, and the texture beside it") {
    const Folder folder;
    folder.write("a.mtl", "newmtl wood\nKd .1 .2 .3\nKs .4 .5 .6\nNs 50\nKe 3 4 5\nmap_Kd pics\\w.png\n");
    folder.write("w.png", "not decoded here");
    const std::string path = folder.write(
        "a.obj", "mtllib a.mtl\nusemtl wood\nv 1 2 3\nv 2 2 3\nv 1 4 3\nvt 0 0.25\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n");
    Reader reader;
    const Scene scene = *io::read_scene(path, {0.5}, reader.function()).static_geometry;

    REQUIRE(scene.triangles.size() == 1);
    CHECK(corner(scene, 0, 0).z == 1.5);
    CHECK(corner(scene, 0, 2).y == 2.0);
    CHECK(scene.uvs[scene.triangles[0].vertices[0]].y == 0.25f);  // v upwards, in the file and here
    const Material& m = scene.materials[scene.triangles[0].material];
    check_vec(m.diffuse, .1, .2, .3);
    check_vec(m.specular, .4, .5, .6);
    CHECK(m.shininess == 50.0f);
    check_vec(m.emission, 3, 4, 5);
    REQUIRE(m.diffuse_texture.texture == 0);
    CHECK(scene.textures[0].rgba == reader.pixel);
    CHECK(reader.asked == std::vector<std::string>{"w.png"});
    CHECK(scene.warnings.empty());
    CHECK(scene.has_light());
}

TEST_CASE("OBJ without normals: a cube keeps its edges") {
    const Folder folder;
    const Scene box = read(folder.write("cube.obj", cube));
    CHECK(box.triangles.size() == 12);
    CHECK(box.positions_m.size() == 24);
    for (std::size_t t = 0; t < box.triangles.size(); ++t) {
        const Vec3d flat = face_normal(box, t), away = corner(box, t, 0) - Vec3d{.5, .5, .5};
        CHECK(dot(flat, away) > 0);
        for (const std::uint32_t v : box.triangles[t].vertices) {
            CHECK(dot(static_cast<Vec3d>(box.normals[v]), flat) == doctest::Approx(1).epsilon(1e-6));
        }
    }
}

TEST_CASE("normals that a file gives are kept, and welded vertices keep the order of the triangles") {
    const Folder folder;
    const Scene scene = read(folder.write(
        "n.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvn 0 0 2\nvn 0.6 0 0.8\nf 1//1 2//2 3//1\nf 2//2 4//1 3//1\n"));
    CHECK(scene.positions_m.size() == 4);
    check_vec(scene.normals[scene.triangles[0].vertices[0]], 0, 0, 1);
    check_vec(scene.normals[scene.triangles[0].vertices[1]], .6, 0, .8);
    CHECK(scene.triangles[1].vertices[0] == scene.triangles[0].vertices[1]);
    CHECK(corner(scene, 1, 1).x + corner(scene, 1, 1).y == 2);
}

TEST_CASE("OBJ: numbers without a digit before the point") {
    const Folder folder;
    const Scene scene = read(folder.write("dot.obj", "v .5 0 0\nv 1 .25 -.5\nv 0 1 .125\nv 9 9 9\nf 1 2 3\n"));
    CHECK(corner(scene, 0, 0).x == 0.5);
    CHECK(corner(scene, 0, 1).y == 0.25);
    CHECK(corner(scene, 0, 1).z == -0.5);
    CHECK(corner(scene, 0, 2).z == 0.125);
}

TEST_CASE("PLY: ASCII and binary; a mesh without a material has the default one") {
    const Folder folder;
    const Scene ascii = read(folder.write("a.ply", ply("0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n", 4)), 0.001);
    CHECK(ascii.triangles.size() == 2);
    CHECK(corner(ascii, 0, 1).x == 0.001);
    check_vec(ascii.materials[0].diffuse, .5, .5, .5);
    check_vec(ascii.materials[0].specular, 0, 0, 0);

    std::string header = ply("");
    header.replace(header.find("ascii"), 5, "binary_little_endian");
    const float p[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const std::int32_t indices[3] = {0, 1, 2};
    const std::string body = std::string(reinterpret_cast<const char*>(p), 36) + '\3' +
                             std::string(reinterpret_cast<const char*>(indices), 12);
    CHECK(read(folder.write("b.ply", header + body)).triangles.size() == 1);
    CHECK(has(error_of(folder.write("c.ply", header + body.substr(0, 40))), "is cut short"));
}

TEST_CASE("PLY: normals, texture coordinates, a texture's name, doubles, big-endian, and lists that are not read") {
    const Folder folder;
    folder.write("map.png", "not decoded here");
    const std::string header =
        "ply\r\nformat ascii 1.0\r\ncomment TextureFile map.png\r\nelement vertex 3\r\nproperty double x\r\n"
        "property double y\r\nproperty double z\r\nproperty float nx\r\nproperty float ny\r\nproperty float nz\r\n"
        "property float s\r\nproperty float t\r\nelement face 1\r\nproperty list uchar int vertex_index\r\n"
        "property list uchar float other\r\nproperty uchar red\r\nend_header\r\n";
    Reader reader;
    const Scene scene =
        *io::read_scene(folder.write("a.ply", header + "1000000.123 0 0 0 0 2 0.5 0.25\r\n1000001.123 0 0 0 0 1 1 0\r\n"
                                                       "1000000.123 1 0 0 0 1 0 1\r\n3 0 1 2 2 7 7 255\r\n"),
                        {}, reader.function())
             .static_geometry;
    CHECK(corner(scene, 0, 0).x == 1000000.123);
    check_vec(scene.normals[0], 0, 0, 1);
    CHECK(scene.uvs[scene.triangles[0].vertices[0]].y == 0.25f);
    CHECK(reader.asked == std::vector<std::string>{"map.png"});
    CHECK(scene.materials[0].diffuse_texture.texture == 0);

    std::string big = ply("");
    big.replace(big.find("ascii"), 5, "binary_big_endian");
    const auto put = [&](std::uint32_t bits) {
        for (int shift = 24; shift >= 0; shift -= 8) big += static_cast<char>(bits >> shift);
    };
    for (const float value : {0.f, 0.f, 0.f, 2.f, 0.f, 0.f, 0.f, 3.f, 0.f}) put(std::bit_cast<std::uint32_t>(value));
    big += '\3';
    for (const std::uint32_t index : {0u, 1u, 2u}) put(index);
    CHECK(corner(read(folder.write("b.ply", big)), 0, 2).y == 3);
}

TEST_CASE("what can be put up with is a warning") {
    const Folder folder;
    folder.write("a.mtl", "newmtl wood\nKd 0 0 0\nmap_Kd gone.png\nd 0.5\n");
    const Scene scene = read(folder.write("a.obj",
                                          "mtllib a.mtl\nusemtl wood\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\n"
                                          "f 1/1 2/1 3/1\nf 1/1 1/1 2/1\nf 1/1 2/1 2/1\n"));
    CHECK(warns(scene, "texture gone.png: no such file beside the scene; a checker in magenta and black stands in"));
    CHECK(warns(scene, "2 triangles without area dropped"));
    CHECK(scene.triangles.size() == 1);
    const Material& m = scene.materials[scene.triangles[0].material];
    REQUIRE(m.diffuse_texture.texture == 0);
    CHECK(m.diffuse.r == 1.0f);  // black would hide it
    CHECK((m.opacity == 0.5f && m.transmission == 0.0f));
    const std::vector<std::uint8_t>& rgba = scene.textures[0].rgba;
    CHECK(std::vector<std::uint8_t>(rgba.begin(), rgba.begin() + 4) == std::vector<std::uint8_t>{255, 0, 255, 255});

    folder.write("gone.png", "no picture");
    const io::ImageReader reads_nothing = [](const std::string&, std::span<const std::uint8_t>) {
        return std::optional<DecodedImage>();
    };
    const Scene other = *io::read_scene(folder.path("a.obj"), {}, reads_nothing).static_geometry;
    CHECK(warns(other, "texture gone.png: cannot be read as a picture"));
    CHECK(warns(read(folder.write("b.obj", "mtllib none.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")), "none.mtl"));
}

TEST_CASE("bad files: one line that names the file and what is expected") {
    const Folder folder;
    CHECK(has(error_of(folder.path("a.stl")),
              "ends in .glb, .gltf, .obj, .ply, .usd, .usda, .usdc or .usdz, not in .stl"));
    CHECK(has(error_of(folder.path("a")), "ends in .glb, .gltf, .obj, .ply, .usd, .usda, .usdc or .usdz"));
    CHECK(has(error_of(folder.path("none.obj")), "no such file"));
    CHECK(has(error_of(folder.write("empty.ply", "")), "is empty"));
    fs::create_directory(folder.path("folder.obj"));
    CHECK(has(error_of(folder.path("folder.obj")), "is a folder"));
    CHECK(has(error_of(folder.write("tiny.obj", "hello\n")), "holds no triangles"));
    CHECK(has(error_of(folder.write("text.obj", "this is a text, and no scene at all\n")), "holds no triangles"));
    CHECK(has(error_of(folder.write("text.ply", "this is a text, and no scene at all\n")), "line 1: expected \"ply\""));
    CHECK(
        has(error_of(folder.write("text.glb", "this is a text, and no scene at all\n")), "is not valid glTF: line 1"));
    CHECK(has(error_of(folder.write("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n")), "no triangles"));
    CHECK(has(error_of(folder.write("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n")), "without area"));

    const std::string two = "v 0 0 0\nv 1 0 0\n";
    CHECK(has(error_of(folder.write("nan.obj", two + "v nan 1 0\nf 1 2 3\n")), "line 3: coordinates must be finite"));
    CHECK(has(error_of(folder.write("inf.obj", two + "v 0 1e39 0\nf 1 2 3\n")), "line 3: coordinates must be finite"));
    CHECK(has(error_of(folder.write("index.obj", two + "v 0 1 0\nf 1 2 9\n")),
              "line 4: vertex 9 does not exist; there are 3"));
    CHECK(has(error_of(folder.write("nan.ply", ply("0 0 0\n1 0 0\n0 nan 0\n3 0 1 2\n"))),
              "vertex 2: coordinates must be finite numbers, not (0, nan, 0)"));
    CHECK(has(error_of(folder.write("index.ply", ply("0 0 0\n1 0 0\n0 1 0\n3 0 1 8\n"))), "face 0: index 8"));
    CHECK(has(error_of(folder.write("short.ply", ply("0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", 3, 2))),
              "is cut short: its header promises 2 of \"face\", and it ends in number 1"));
    CHECK_THROWS_AS(read(folder.write("ok.ply", ply("0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")), 0), InputError);
    CHECK_THROWS_AS(read(folder.path("ok.ply"), std::nan("")), InputError);
}
