#include <unistd.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include "../../cpp/error.hpp"
#include "../../cpp/io/scene_checks.hpp"
#include "../../cpp/io/scene_file.hpp"
#include "../../cpp/io/scene_materials.hpp"
#include "doctest/doctest.h"

namespace {

namespace fs = std::filesystem;
using namespace realcam;
using io::DecodedImage;

// The files of one test; gone with it.
class Folder {
public:
    Folder() : path_(fs::temp_directory_path() / ("realcam-scene-" + std::to_string(getpid()))) {
        fs::remove_all(path_);
        fs::create_directories(path_);
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    ~Folder() { fs::remove_all(path_); }

    std::string write(const std::string& name, const std::string& content) const {
        std::ofstream(path_ / name, std::ios::binary) << content;
        return (path_ / name).string();
    }
    std::string path(const std::string& name) const { return (path_ / name).string(); }

private:
    fs::path path_;
};

// Pictures of one colour: what the reader was asked for stays in `asked`.
struct Reader {
    std::vector<std::uint8_t> pixel = {255, 128, 0, 255};
    std::vector<std::string> asked;
    std::vector<std::uint8_t> bytes;

    io::ImageReader function() {
        return [this](const std::string& path, std::span<const std::uint8_t> encoded) {
            asked.push_back(path.empty() ? "bytes" : fs::path(path).filename().string());
            bytes.assign(encoded.begin(), encoded.end());
            return std::optional(DecodedImage{1, 1, pixel});
        };
    }
};

Scene read(const std::string& path, double scale = 1) {
    Reader reader;
    return io::read_scene(path, {scale}, reader.function());
}

std::string error_of(const std::string& path) {
    try {
        read(path);
    } catch (const SceneFileError& error) {
        CHECK(std::string(error.what()).starts_with(path));
        CHECK(std::string(error.what()).find('\n') == std::string::npos);
        return error.what();
    }
    return "no error";
}

bool has(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

bool warns(const Scene& scene, const std::string& part) {
    for (const std::string& warning : scene.warnings) {
        if (has(warning, part)) return true;
    }
    return false;
}

void check_vec(Vec3f v, double x, double y, double z, double within = 1e-6) {
    CHECK(double(v.x) == doctest::Approx(x).epsilon(within));
    CHECK(double(v.y) == doctest::Approx(y).epsilon(within));
    CHECK(double(v.z) == doctest::Approx(z).epsilon(within));
}

Vec3d corner(const Scene& scene, std::size_t triangle, int i) {
    return scene.positions_m[scene.triangles[triangle].vertices[i]];
}

Vec3d face_normal(const Scene& scene, std::size_t t) {
    return normalized(cross(corner(scene, t, 1) - corner(scene, t, 0), corner(scene, t, 2) - corner(scene, t, 0)));
}

// A triangle (0,0,0), (1,0,0), (0,1,0) that faces +z, with normals and texture coordinates, in a file tri.bin.
std::string triangle_bytes(std::vector<std::uint16_t> indices = {0, 1, 2}, float x1 = 1) {
    const float values[] = {0, 0, 0, x1, 0, 0, 0, 1, 0, /*normals*/ 0, 0, 1, 0, 0, 1, 0, 0, 1, /*uv*/ 0, 1, 1, 1, 0, 0};
    std::string out(reinterpret_cast<const char*>(values), sizeof values);
    out.append(reinterpret_cast<const char*>(indices.data()), 2 * indices.size());
    return out + std::string(2, '\0');
}

std::string gltf(const std::string& nodes, const std::string& roots, const std::string& more = "",
                 const std::string& attributes = R"(,"NORMAL":1,"TEXCOORD_0":2)", std::size_t indices = 3) {
    return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":)" + roots + R"(}],"nodes":)" + nodes +
           R"(,"meshes":[{"name":"tri","primitives":[{"attributes":{"POSITION":0)" + attributes +
           R"(},"indices":3,"material":0}]},
               {"primitives":[{"attributes":{"POSITION":0)" +
           attributes + R"(},"indices":3}]}],
           "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},
             {"bufferView":1,"componentType":5126,"count":3,"type":"VEC3"},
             {"bufferView":2,"componentType":5126,"count":3,"type":"VEC2"},
             {"bufferView":3,"componentType":5123,"count":)" +
           std::to_string(indices) + R"(,"type":"SCALAR"}],
           "bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":36},
             {"buffer":0,"byteOffset":72,"byteLength":24},
             {"buffer":0,"byteOffset":96,"byteLength":)" +
           std::to_string(2 * indices) + R"(}],
           "buffers":[{"byteLength":)" +
           std::to_string(98 + 2 * indices) + R"(,"uri":"tri.bin"}])" +
           (has(more, "\"materials\"") ? "" : R"(,"materials":[{"name":"plain"}])") + more + "}";
}

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
    const Scene scene = io::read_scene(path, {0.5}, reader.function());

    REQUIRE(scene.triangles.size() == 1);
    CHECK(corner(scene, 0, 0).z == 1.5);
    CHECK(corner(scene, 0, 2).y == 2.0);
    CHECK(scene.uvs[scene.triangles[0].vertices[0]].y == 0.25f);  // v upwards, in the file and here
    const Material& m = scene.materials[scene.triangles[0].material];
    check_vec(m.diffuse, .1, .2, .3);
    check_vec(m.specular, .4, .5, .6);
    CHECK(m.shininess == 50.0f);
    check_vec(m.emission, 3, 4, 5);
    REQUIRE(m.diffuse_texture == 0);
    CHECK(scene.textures[0].rgba == reader.pixel);
    CHECK(reader.asked == std::vector<std::string>{"w.png"});
    CHECK(scene.warnings.empty());
    CHECK(scene.has_light());
}

TEST_CASE("OBJ without normals: a cube keeps its edges, a gentle fold becomes smooth") {
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

    // Two squares that meet along x = 0 at 30 degrees, symmetric about x: on the fold the normal points along z.
    const std::string c = std::to_string(std::cos(M_PI / 12)), s = std::to_string(-std::sin(M_PI / 12));
    const Scene fold =
        read(folder.write("fold.obj", "v 0 0 0\nv 0 1 0\nv " + c + " 0 " + s + "\nv " + c + " 1 " + s + "\nv -" + c +
                                          " 0 " + s + "\nv -" + c + " 1 " + s + "\nf 1 3 4 2\nf 5 1 2 6\n"));
    CHECK(fold.positions_m.size() == 6);
    for (std::size_t v = 0; v < fold.positions_m.size(); ++v) {
        if (fold.positions_m[v].x == 0)
            check_vec(fold.normals[v], 0, 0, 1, 1e-5);
        else
            CHECK(std::abs(double(fold.normals[v].x)) == doctest::Approx(std::sin(M_PI / 12)).epsilon(1e-4));
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

TEST_CASE("glTF: metallic-roughness as diffuse and Phong lobes, emission in cd/m^2") {
    const Folder folder;
    folder.write("tri.bin", triangle_bytes());
    // Meshes in another order than the file's: assimp numbers materials by use.
    const std::string more = R"(,"materials":[
        {"name":"same","pbrMetallicRoughness":{"baseColorFactor":[0.5,0.25,0.125,1],"metallicFactor":0,
         "roughnessFactor":0.5},"emissiveFactor":[1,0.5,0],
         "extensions":{"KHR_materials_emissive_strength":{"emissiveStrength":2000}}}])";
    const Scene scene = read(folder.write("m.gltf", gltf(R"([{"mesh":1},{"mesh":0}])", "[0,1]", more)));
    const Material& none = scene.materials[scene.triangles[0].material];
    check_vec(none.diffuse, .5, .5, .5);
    check_vec(none.emission, 0, 0, 0);
    const Material& m = scene.materials[scene.triangles[1].material];
    check_vec(m.diffuse, .48, .24, .12);
    check_vec(m.specular, .04, .04, .04);
    CHECK(m.shininess == doctest::Approx((2 / 0.0625 - 2) / 4));
    check_vec(m.emission, 2000, 1000, 0);

    for (const char* metallic : {"0", "0.3", "1"}) {
        const std::string white = R"(,"materials":[{"pbrMetallicRoughness":{"metallicFactor":)" +
                                  std::string(metallic) + R"(,"baseColorFactor":[1,0.5,1,1]}}])";
        const Scene s = read(folder.write("w.gltf", gltf(R"([{"mesh":0}])", "[0]", white)));
        const Vec3f sum = s.materials[s.triangles[0].material].diffuse + s.materials[s.triangles[0].material].specular;
        CHECK(sum.x <= 1.000001f);
        CHECK(sum.y <= 1.000001f);
    }
    CHECK(io::phong_exponent(1) == 0.0f);
    CHECK(io::phong_exponent(0) == 20000.0f);
    CHECK(io::phong_exponent(0.3f) > io::phong_exponent(0.4f));
}

TEST_CASE("glTF: pictures as files, their transform, and the mean of a metal's map") {
    const Folder folder;
    folder.write("tri.bin", triangle_bytes());
    folder.write("my t.png", "not decoded here");
    const std::string more = R"(,"materials":[{"pbrMetallicRoughness":{"metallicFactor":1,"baseColorTexture":{"index":0,
        "extensions":{"KHR_texture_transform":{"offset":[0,1],"rotation":1.57079632679,"scale":[0.5,0.25]}}}}}],
        "textures":[{"source":0}],"images":[{"uri":"my%20t.png"}])";
    Reader reader;
    const Scene scene =
        io::read_scene(folder.write("u.gltf", gltf(R"([{"mesh":0}])", "[0]", more)), {}, reader.function());
    CHECK(reader.asked.front() == "my t.png");
    CHECK(scene.warnings.empty());
    // The file's (u, v), v downwards: (0, 1), (1, 1), (0, 0). Turned by 90 degrees, (0.5 u, 0.25 v) -> (0.25 v, -0.5
    // u).
    const double truth[][2] = {{0.25, 1}, {0.25, 0.5}, {0, 1}};
    for (int i = 0; i < 3; ++i) {
        const Vec2f uv = scene.uvs[scene.triangles[0].vertices[i]];
        CHECK(double(uv.x) == doctest::Approx(truth[i][0]).epsilon(1e-6));
        CHECK(1 - double(uv.y) == doctest::Approx(truth[i][1]).epsilon(1e-6));
    }
    // sRGB 128 is 0.2158605 in linear light.
    check_vec(scene.materials[scene.triangles[0].material].specular, 1, 0.2158605, 0);
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
    const Scene scene = io::read_scene(folder.write("a.GLB", glb), {}, reader.function());
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
    CHECK(warns(scene, "light 2 is a spot"));
    REQUIRE(scene.suns.size() == 1);
    check_vec(scene.suns[0].illuminance, 1000, 1000, 1000);
    CHECK(double(scene.suns[0].direction.y) == doctest::Approx(-1));
}

TEST_CASE("what can be put up with is a warning") {
    const Folder folder;
    folder.write("a.mtl", "newmtl wood\nKd 0 0 0\nmap_Kd gone.png\nd 0.5\n");
    const Scene scene = read(folder.write("a.obj",
                                          "mtllib a.mtl\nusemtl wood\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\n"
                                          "f 1/1 2/1 3/1\nf 1/1 1/1 2/1\nf 1/1 2/1 2/1\n"));
    CHECK(warns(scene, "texture gone.png: no such file beside the scene; a checker in magenta and black stands in"));
    CHECK(warns(scene, "2 triangles without area dropped"));
    CHECK(warns(scene, "\"wood\" is transparent"));
    CHECK(scene.triangles.size() == 1);
    const Material& m = scene.materials[scene.triangles[0].material];
    REQUIRE(m.diffuse_texture == 0);
    CHECK(m.diffuse.x == 1.0f);  // black would hide it
    const std::vector<std::uint8_t>& rgba = scene.textures[0].rgba;
    CHECK(std::vector<std::uint8_t>(rgba.begin(), rgba.begin() + 4) == std::vector<std::uint8_t>{255, 0, 255, 255});

    folder.write("gone.png", "no picture");
    const Scene other = io::read_scene(folder.path("a.obj"), {}, [](const std::string&, std::span<const std::uint8_t>) {
        return std::optional<DecodedImage>();
    });
    CHECK(warns(other, "texture gone.png: cannot be read as a picture"));
    CHECK(warns(read(folder.write("b.obj", "mtllib none.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")), "none.mtl"));
}

TEST_CASE("bad files: one line that names the file and what is wanted") {
    const Folder folder;
    CHECK(has(error_of(folder.path("a.stl")), "ends in .glb, .gltf, .obj or .ply, not in .stl"));
    CHECK(has(error_of(folder.path("a")), "ends in .glb, .gltf, .obj or .ply"));
    CHECK(has(error_of(folder.path("none.obj")), "no such file"));
    CHECK(has(error_of(folder.write("empty.ply", "")), "is empty"));
    fs::create_directory(folder.path("folder.obj"));
    CHECK(has(error_of(folder.path("folder.obj")), "is a folder"));
    CHECK(has(error_of(folder.write("tiny.obj", "hello\n")), "cannot be read"));
    CHECK(has(error_of(folder.write("text.obj", "this is a text, and no scene at all\n")), "holds no triangles"));
    CHECK(has(error_of(folder.write("text.ply", "this is a text, and no scene at all\n")), "cannot be read"));
    CHECK(has(error_of(folder.write("text.glb", "this is a text, and no scene at all\n")), "is no valid glTF: line 1"));
    CHECK(has(error_of(folder.write("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n")), "no triangles"));
    CHECK(has(error_of(folder.write("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n")), "without area"));

    const std::string two = "v 0 0 0\nv 1 0 0\n";
    CHECK(has(error_of(folder.write("nan.obj", two + "v nan 1 0\nf 1 2 3\n")), "line 3: coordinates must be finite"));
    CHECK(has(error_of(folder.write("inf.obj", two + "v 0 1e39 0\nf 1 2 3\n")), "line 3: coordinates must be finite"));
    CHECK(has(error_of(folder.write("index.obj", two + "v 0 1 0\nf 1 2 9\n")), "index out of range"));
    CHECK(has(error_of(folder.write("nan.ply", ply("0 0 0\n1 0 0\n0 nan 0\n3 0 1 2\n"))), "mesh 0: vertex 2: coord"));
    CHECK(has(error_of(folder.write("index.ply", ply("0 0 0\n1 0 0\n0 1 0\n3 0 1 8\n"))), "face 0: index 8"));
    CHECK(has(error_of(folder.write("short.ply", ply("0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", 3, 2))),
              "is cut short: its header promises 2 of \"face\", and it has 1"));
    CHECK_THROWS_AS(read(folder.write("ok.ply", ply("0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")), 0), InputError);
    CHECK_THROWS_AS(read(folder.path("ok.ply"), std::nan("")), InputError);
}

TEST_CASE("bad glTF: the mesh and the vertex are named") {
    const Folder folder;
    const std::string nodes = R"([{"mesh":0}])";
    folder.write("tri.bin", triangle_bytes({0, 1, 7}));
    CHECK(has(error_of(folder.write("a.gltf", gltf(nodes, "[0]"))), "indices smaller than its number of vertices"));
    folder.write("tri.bin", triangle_bytes({0, 1, 2, 0, 1, 3}));
    CHECK(
        has(error_of(folder.write("a.gltf", gltf(nodes, "[0]", "", "", 6))),
            "mesh 0, primitive 0: 1 triangles of 2 have an index that is not smaller than the number of vertices, 3"));
    folder.write("tri.bin", triangle_bytes({0, 1, 2}, std::numeric_limits<float>::infinity()));
    CHECK(has(error_of(folder.write("a.gltf", gltf(nodes, "[0]"))), "mesh 0 \"tri\": vertex 1: coordinates must be"));
    CHECK(has(error_of(folder.write("b.gltf", gltf(R"([{"name":"x"}])", "[0]"))), "holds no triangles"));
    CHECK(has(error_of(folder.write("c.gltf", "{\n\"asset\": {\n")), "line 3"));
    CHECK(has(error_of(folder.write("d.gltf", R"({"asset":{"version":"1.0"}})")), "glTF 2.0 is wanted"));
    CHECK(has(
        error_of(folder.write("e.gltf", gltf(nodes, "[0]", R"(,"extensionsRequired":["KHR_draco_mesh_compression"])"))),
        "needs the glTF extension KHR_draco_mesh_compression"));
    fs::remove(folder.path("tri.bin"));
    CHECK(has(error_of(folder.path("a.gltf")), "cannot be read"));
}

TEST_CASE("validate: a scene from arrays") {
    Scene good;
    good.positions_m = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    good.triangles = {{{0, 1, 2}, 0}};
    good.materials = {Material{}};
    CHECK_NOTHROW(io::validate(good));
    CHECK_THROWS_AS(io::validate(Scene{}), SceneFileError);

    const auto message = [&](auto change) {
        Scene scene = good;
        change(scene);
        try {
            io::validate(scene);
        } catch (const InputError& error) {
            return std::string(error.what());
        }
        return std::string("no error");
    };
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    CHECK(has(message([](Scene& s) { s.positions_m[1].y = double(nan); }), "vertex 1: coordinates"));
    CHECK(has(message([](Scene& s) { s.positions_m[2].y = 1e300; }), "vertex 2: coordinates"));
    CHECK(has(message([](Scene& s) { s.triangles[0].vertices[2] = 3; }),
              "triangle 0: vertex 3 does not exist; there are 3"));
    CHECK(has(message([](Scene& s) { s.triangles[0].material = 1; }), "triangle 0: material 1 does not exist"));
    CHECK(has(message([](Scene& s) { s.normals.resize(2); }), "2 normals for 3 vertices"));
    CHECK(has(message([](Scene& s) { s.uvs.resize(4); }), "4 texture coordinates for 3 vertices"));
    CHECK(has(message([](Scene& s) { s.normals.assign(3, {0, nan, 0}); }), "normal 0"));
    CHECK(has(message([](Scene& s) { s.materials[0].diffuse.x = -1; }), "material 0: diffuse"));
    CHECK(has(message([](Scene& s) { s.materials[0].specular.x = nan; }), "material 0: specular"));
    CHECK(has(message([](Scene& s) { s.materials[0].emission.z = -1; }), "material 0: emission"));
    CHECK(has(message([](Scene& s) { s.materials[0].diffuse_texture = 0; }), "texture 0 does not exist"));
    CHECK(has(message([](Scene& s) { s.textures = {{"t", 2, 2, {1, 2, 3}}}; }), "texture 0: width x height"));
    CHECK(has(message([](Scene& s) { s.points = {{{0, 0, 0}, {-1, 0, 0}}}; }), "point light 0"));
    CHECK(has(message([](Scene& s) { s.suns = {{{0, 0, 0}, {1, 1, 1}}}; }), "sun 0: its direction"));
    CHECK(has(message([](Scene& s) { s.environment.constant.y = nan; }), "environment"));
    CHECK(has(message([](Scene& s) { s.environment.pixels.resize(3); }), "environment: width x height"));

    Scene thin = good;
    thin.triangles.push_back({{0, 1, 1}, 0});
    CHECK(io::drop_degenerate_triangles(thin) == 1);
    CHECK(thin.triangles.size() == 1);
}
