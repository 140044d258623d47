// glTF files that are wrong, or strange and right. Each ends in a scene or in one line that names file and element,
// soon, and without memory that the file only promises.

#include <sys/resource.h>

#include <cmath>
#include <fstream>
#include <string>

#include "io/hostile_scenes.hpp"

using namespace scene_files;

namespace {

struct Gltf {
    Folder folder;

    Scene scene(const Tiny& tiny) const { return read(folder.write("t.gltf", tiny.text())); }
    std::string error(const Tiny& tiny) const { return error_of(folder.write("t.gltf", tiny.text())); }
    std::string error(const std::string& text) const { return error_of(folder.write("t.gltf", text)); }
};

std::string chain(int nodes) {
    std::string out = "[";
    for (int i = 1; i < nodes; ++i) out += R"({"translation":[0,0,1],"children":[)" + std::to_string(i) + "]},";
    return out + R"({"mesh":0}])";
}

// One vertex each of two joints and of none, as JOINTS_0 and WEIGHTS_0 of bytes in a data: address.
const std::string kSkinAccessors =
    R"(,{"bufferView":2,"componentType":5121,"count":3,"type":"VEC4"},
        {"bufferView":3,"componentType":5121,"normalized":true,"count":3,"type":"VEC4"})";

std::string with_skin_bytes(std::string text) {
    // Joints 0, 1, 0; weights 1, 1, 0 of the first of four.
    const auto replace = [&](const std::string& from, const std::string& to) {
        text.replace(text.find(from), from.size(), to);
    };
    replace(
        R"("byteOffset":36,"byteLength":6}])",
        R"("byteOffset":36,"byteLength":6},{"buffer":1,"byteLength":12},{"buffer":1,"byteOffset":12,"byteLength":12}])");
    replace(R"(AAABAAIA"}])", R"(AAABAAIA"},{"byteLength":24,"uri":"data:;base64,AAAAAAEAAAAAAAAA/wAAAP8AAAAAAAAA"}])");
    return text;
}

}  // namespace

TEST_CASE("glTF: a skin takes the pose of its joints, without inverse bind matrices too") {
    const Gltf gltf;
    Tiny tiny;
    tiny.primitive = R"("attributes":{"POSITION":0,"JOINTS_0":2,"WEIGHTS_0":3},"indices":1)";
    tiny.more_accessors = kSkinAccessors;
    // The mesh's own node does not move it.
    tiny.nodes = R"([{"mesh":0,"skin":0,"translation":[9,9,9],"scale":[2,2,2]},{"translation":[0,0,5],"children":[2]},
                     {"translation":[1,0,0]}])";
    tiny.roots = "[0,1]";
    tiny.more = R"(,"skins":[{"joints":[1,2]}])";
    const Scene scene = read(gltf.folder.write("s.gltf", with_skin_bytes(tiny.text())));
    REQUIRE(scene.triangles.size() == 1);
    CHECK(length(corner(scene, 0, 0) - Vec3d{-1, -1, 5}) < 1e-12);
    CHECK(length(corner(scene, 0, 1) - Vec3d{2, -1, 5}) < 1e-12);
    CHECK(length(corner(scene, 0, 2) - Vec3d{9, 11, 9}) < 1e-12);  // no joint has it: where its node puts it
    CHECK(scene.warnings.empty());

    tiny.more = R"(,"skins":[{"joints":[1]}])";
    CHECK(has(error_of(gltf.folder.write("s.gltf", with_skin_bytes(tiny.text()))),
              "joint 1 is not smaller than the number of joints, 1"));
    tiny.more = R"(,"skins":[{}])";
    CHECK(has(gltf.error(tiny), "skin 0: has no joints"));
    tiny.more = R"(,"skins":[{"joints":[7]}])";
    CHECK(has(gltf.error(tiny), "skin 0: expected an index of \"nodes\", of which there are 3"));
    tiny.nodes = R"([{"mesh":0,"skin":0,"scale":[0,1,1]},{}, {}])";
    tiny.more = R"(,"skins":[{"joints":[1]}])";
    CHECK(has(gltf.error(tiny), "without area"));
}

TEST_CASE("glTF: morph targets by the weights of the mesh or of the node") {
    const Gltf gltf;
    Tiny tiny;
    tiny.primitive += R"(,"targets":[{"POSITION":0},{"POSITION":99}])";
    tiny.nodes = R"([{"mesh":0,"weights":[0.5]}])";
    CHECK(length(corner(gltf.scene(tiny), 0, 0) - Vec3d{-1.5, -1.5, 0}) < 1e-12);
    tiny.nodes = R"([{"mesh":0}])";
    CHECK(length(corner(gltf.scene(tiny), 0, 0) - Vec3d{-1, -1, 0}) < 1e-12);
    tiny.nodes = R"([{"mesh":0,"weights":[0,1]}])";
    CHECK(has(gltf.error(tiny), "mesh 0: target 1"));
}

TEST_CASE("glTF: accessors that promise what is not there") {
    const Gltf gltf;
    const auto error = [&](const std::string& position) {
        Tiny tiny;
        tiny.position = position;
        return gltf.error(tiny);
    };
    const std::string vec3 = R"("componentType":5126,"count":3,"type":"VEC3")";
    CHECK(has(error(vec3 + R"(,"bufferView":9)"), "accessor 0: expected an index of \"bufferViews\""));
    CHECK(has(error(R"("bufferView":0,"componentType":5126,"count":4000000000,"type":"VEC3")"),
              "promises 4000000000 elements of 12 bytes, and its bufferView has 36 bytes"));
    CHECK(has(error(R"("bufferView":0,"componentType":5126,"count":9007199254740992,"type":"VEC3")"), "promises"));
    CHECK(has(error(R"("componentType":5126,"count":4000000000,"type":"VEC3")"), "has no bytes for them"));
    CHECK(has(error(vec3 + R"(,"bufferView":0,"byteOffset":4)"), "has 32 bytes for them"));
    CHECK(has(error(vec3 + R"(,"bufferView":0,"byteOffset":1e15)"), "has 0 bytes for them"));
    CHECK(has(error(R"("bufferView":0,"componentType":5130,"count":3,"type":"VEC3")"), "componentType"));
    CHECK(
        has(error(R"("bufferView":0,"componentType":5126,"count":3,"type":"VEC2")"), "expected elements of type VEC3"));
    for (const char* sparse : {R"({})", R"({"count":1})", R"({"count":1,"indices":{"componentType":5123}})",
                               R"({"count":1,"indices":{"bufferView":1,"componentType":5123},"values":{}})",
                               R"({"count":1,"indices":{"componentType":5123},"values":{"bufferView":0}})"})
        CHECK(has(error(vec3 + R"(,"bufferView":0,"sparse":)" + sparse), "its sparse"));
    CHECK(has(error(vec3 + R"(,"bufferView":0,"sparse":{"count":1,"indices":{"bufferView":1,"byteOffset":4,
              "componentType":5121},"values":{"bufferView":0}})"),
              "without area"));  // the last corner becomes the first
    CHECK(has(error(vec3 + R"(,"bufferView":0,"sparse":{"count":1,"indices":{"bufferView":0,"byteOffset":2,
              "componentType":5121},"values":{"bufferView":0}})"),
              "sparse index 128 is not smaller than the number of elements, 3"));
}

TEST_CASE("glTF: strips, fans and modes of any length") {
    const Gltf gltf;
    const auto count = [&](int mode, int indices) {
        Tiny tiny;
        tiny.primitive += R"(,"mode":)" + std::to_string(mode);
        tiny.indices = R"("bufferView":1,"componentType":5123,"type":"SCALAR","count":)" + std::to_string(indices);
        return gltf.error(tiny);
    };
    for (const int mode : {0, 1, 2, 3, 4, 5, 6})
        for (const int indices : {0, 1, 2}) CHECK(has(count(mode, indices), "holds no triangles"));
    for (const int mode : {4, 5, 6}) CHECK(count(mode, 3) == "no error");
    CHECK(has(count(7, 3), "its mode must be a number from 0 to 6"));
    // The strip 0, 1, 2, 1 of faces that all look the same way.
    Tiny strip;
    strip.primitive += R"(,"mode":5)";
    CHECK(face_normal(gltf.scene(strip), 0).z == doctest::Approx(1));
}

TEST_CASE("glTF: nodes are a tree of any depth, and nothing else") {
    const Gltf gltf;
    Tiny tiny;
    tiny.nodes = chain(100000);
    CHECK(seconds_of([&] { CHECK(corner(gltf.scene(tiny), 0, 0).z == 99999); }) < 10);
    tiny.nodes = R"([{"children":[1,1]},{"mesh":0}])";
    CHECK(has(gltf.error(tiny), "node 1: is listed twice as a child; a node has at most one parent"));
    tiny.nodes = R"([{"children":[1]},{"children":[0],"mesh":0}])";
    CHECK(has(gltf.error(tiny), "node 0: a node of a scene must be listed once, and must not have a parent"));
    tiny.nodes = R"([{"children":[0],"mesh":0}])";
    CHECK(has(gltf.error(tiny), "must not have a parent"));
    tiny.nodes = R"([{"mesh":0},{"children":[2]},{"children":[1]}])";
    CHECK(gltf.error(tiny) == "no error");  // a ring that the scene does not reach
    tiny.nodes = R"([{"children":[5]}])";
    CHECK(has(gltf.error(tiny), "node 0: its child: expected an index of \"nodes\", of which there are 1"));
    tiny.nodes = R"([{"mesh":-1}])";
    CHECK(has(gltf.error(tiny), "node 0: its mesh: expected an index of \"meshes\""));
    tiny.nodes = R"([{"mesh":0.5}])";
    CHECK(has(gltf.error(tiny), "node 0: its mesh"));
    tiny = Tiny();
    tiny.roots = "[0,0]";
    CHECK(has(gltf.error(tiny), "node 0: a node of a scene must be listed once"));
    tiny.roots = R"([0],"extras":[)";
    for (int i = 0; i < 100; ++i) tiny.roots += "[";
    CHECK(has(gltf.error(tiny), "is not valid glTF: line"));
}

TEST_CASE("glTF: names that come twice are distinct instances, and one name takes both") {
    const Gltf gltf;
    Tiny tiny;
    tiny.nodes = R"([{"name":"car","mesh":0},{"name":"car.2","mesh":0},{"name":"car","mesh":0,"translation":[9,0,0]},
                     {"mesh":0}])";
    tiny.roots = "[0,1,2,3]";
    const std::string path = gltf.folder.write("cars.gltf", tiny.text());
    const Assembly cars = read_assembly(path, {"car"});
    REQUIRE(cars.instances.size() == 2);
    CHECK(cars.instances[0].name == "car");
    CHECK(cars.instances[1].name == "car.2");
    CHECK(cars.static_geometry->triangles.size() == 2);
    const Assembly all = read_assembly(path, {"car", "car.2"});
    REQUIRE(all.instances.size() == 3);
    CHECK(all.instances[1].name == "car.2");
    CHECK(all.instances[2].name == "car.3");
}

TEST_CASE("glTF: JSON that is deep, long or no JSON") {
    const Gltf gltf;
    CHECK(has(gltf.error(std::string(1000000, '[')), "less nesting"));
    CHECK(has(gltf.error("[" + std::string(1000000, '{')), ": expected "));
    std::string many = "[0";
    for (int i = 0; i < 9000000; ++i) many += ",0";
    CHECK(has(gltf.error(many + "]"), "fewer than 8388608 values"));
    CHECK(has(gltf.error(R"({"asset":{"version":nan}})"), "line 1, column 21: expected a value, found \"n\""));
    CHECK(has(gltf.error(R"({"asset":{"version":"\u12"}})"), "four hexadecimal digits"));
    CHECK(has(gltf.error(R"({"asset":{"version":"\ud800\u0041"}})"), "surrogate"));
    CHECK(has(gltf.error(R"({"asset":{"version":")" + std::string(100000, '9') + R"("}})"),
              "9999...\"; expected glTF 2.0"));
    CHECK(gltf.error(R"({"asset":{"version":")" + std::string(100000, '9') + R"("}})").size() < 300);
    CHECK(gltf.error("\xef\xbb\xbf" + Tiny().text()) == "no error");
    CHECK(has(gltf.error("\xff\xfe{\0"), "is not valid glTF"));
    std::string long_name = R"({"asset":{"version":"2.0"},"extensionsRequired":[")" + std::string(100000, 'x') + "\"]}";
    CHECK(gltf.error(long_name).size() < 300);
}

TEST_CASE("glTF: pictures and buffers that cannot be had") {
    const Gltf gltf;
    for (const char* image : {R"({})", R"({"bufferView":77,"mimeType":"png"})", R"({"uri":"data:image"})",
                              R"({"uri":"data:image/png;base64,*"})", R"({"bufferView":0,"mimeType":"noslash"})",
                              R"({"uri":"gone.png"})", R"({"uri":"a\u0000b.png"})", R"(5)"}) {
        Tiny tiny;
        tiny.primitive += R"(,"material":0)";
        tiny.more = R"(,"materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}],
                       "textures":[{"source":0}],"images":[)" +
                    std::string(image) + "]";
        const std::string path = gltf.folder.write("p.gltf", tiny.text());
        const Scene scene = *io::read_scene(path, {}, [](const std::string&, std::span<const std::uint8_t>) {
                                 return std::optional<DecodedImage>();
                             }).static_geometry;
        CHECK(warns(scene, "a checker in magenta and black stands in"));
    }
    const auto error = [&](const std::string& buffer) {
        std::string text = Tiny().text();
        const std::size_t from = text.find("\"buffers\":[{") + 12, to = text.find("}]", from);
        return gltf.error(text.replace(from, to - from, buffer));
    };
    CHECK(has(error(R"("byteLength":42)"), "buffer 0 cannot be read: it has no bytes"));
    CHECK(has(error(R"("byteLength":42,"uri":"/dev/zero")"), "buffer 0 cannot be read"));
    CHECK(has(error(R"("byteLength":42,"uri":"data:;base64,AAAA")"), "is cut short: 3 of 42 bytes"));
    CHECK(has(error(R"("byteLength":1e15,"uri":"data:;base64,AAAA")"), "is cut short"));
    CHECK(has(error(R"("byteLength":42,"uri":"data:;base64,A")"), "its data: address is not valid base64"));
}

TEST_CASE("GLB: chunks without bytes, and of more than there are") {
    const Gltf gltf;
    const auto word = [](std::size_t value) {
        const auto v = static_cast<std::uint32_t>(value);
        return std::string(reinterpret_cast<const char*>(&v), 4);
    };
    const auto error = [&](const std::string& json, std::size_t json_size, std::size_t binary_size) {
        return error_of(gltf.folder.write("t.glb", "glTF" + word(2) + word(28 + json.size()) + word(json_size) +
                                                       "JSON" + json + word(binary_size) + std::string("BIN\0", 4)));
    };
    const std::string inside = Tiny().text();
    CHECK(error(inside, inside.size(), 0) == "no error");
    CHECK(has(error(inside, inside.size(), 1), "is cut short"));
    CHECK(has(error(inside, 4000000000, 0), "is cut short"));
    std::string without = inside;
    const std::size_t from = without.find(",\"uri\""), to = without.find("}]", from);
    without.erase(from, to - from);
    CHECK(has(error(without, without.size(), 0), "buffer 0 cannot be read: it has no bytes"));
}

TEST_CASE("glTF: what is too far away is said to be") {
    const Gltf gltf;
    Tiny tiny;
    tiny.nodes = R"([{"mesh":0,"translation":[0,0,2e12]}])";
    CHECK(has(gltf.error(tiny),
              "mesh 0: vertex 0: coordinates must be finite numbers of at most 1e12 m, not (-1, -1, 2e+12)"));
    tiny.nodes = R"([{"mesh":0,"translation":[0,0,1e999]}])";
    CHECK(has(gltf.error(tiny), "coordinates must be finite numbers"));
    tiny.nodes = R"([{"mesh":0,"rotation":[1e300,1e300,0,0],"scale":[1e300,1e300,1]}])";
    CHECK(has(gltf.error(tiny), "coordinates must be finite numbers"));
}

TEST_CASE("glTF: copies of a mesh that need more than memory are refused before one is made") {
    const Gltf gltf;
    Tiny tiny;
    // 300 000 triangles of three vertices, on 20 000 nodes: 6e9 triangles, 192 GB in the scene's form alone.
    constexpr int kIndices = 900000, kNodes = 20000;
    gltf.folder.write("i.bin", std::string(kIndices, '\0'));
    tiny.indices = R"("bufferView":2,"componentType":5121,"count":900000,"type":"SCALAR")";
    std::string nodes, roots;
    for (int i = 0; i < kNodes; ++i) {
        nodes += (i > 0 ? ",\n" : "") + std::string(R"({"mesh":0,"weights":[0.5]})");
        roots += (i > 0 ? "," : "") + std::to_string(i);
    }
    tiny.nodes = '[' + nodes + ']';
    tiny.roots = '[' + roots + ']';
    tiny.primitive += R"(,"targets":[{"POSITION":0}])";
    std::string text = tiny.text();
    const auto replace = [&](const std::string& from, const std::string& to) {
        text.replace(text.find(from), from.size(), to);
    };
    replace(R"("byteLength":6}])", R"("byteLength":6},{"buffer":1,"byteLength":900000}])");
    replace(R"(AAABAAIA"}])", R"(AAABAAIA"},{"byteLength":900000,"uri":"i.bin"}])");
    CHECK(has(gltf.error(text), "its meshes, of which nodes with skins or weights have their own, need "));
    for (const char* count : {"-1e999", "1e999"}) {  // no number of anything
        std::string wrong = text;
        wrong.replace(wrong.find("\"count\":900000"), 14, std::string("\"count\":") + count);
        CHECK(has(gltf.error(wrong), "holds no triangles"));
    }
    const auto at = text.find(nodes);
    const auto first_end = nodes.find('\n') - 1;
    text.replace(at, nodes.size(), nodes.substr(0, first_end));
    text.replace(text.find(roots), roots.size(), "0");
    CHECK(has(gltf.error(text), "all of its triangles are without area"));
}

TEST_CASE("glTF: images that share their bytes are decoded once") {
    const Gltf gltf;
    Tiny tiny;
    tiny.primitive += R"(,"material":0)";
    tiny.more = R"(,"materials":[{"pbrMetallicRoughness":{"metallicFactor":0,"baseColorTexture":{"index":0}}},
                    {"pbrMetallicRoughness":{"metallicFactor":0,"baseColorTexture":{"index":1}}}],
                    "textures":[{"source":0},{"source":1}],
                    "images":[{"bufferView":0,"mimeType":"image/png"},{"bufferView":0,"mimeType":"image/png"}])";
    std::string text = tiny.text();
    const std::string one = R"({"primitives":[{"attributes":{"POSITION":0},"indices":1,"material":0}]})";
    text.replace(text.find(one), one.size(),
                 R"({"primitives":[{"attributes":{"POSITION":0},"indices":1,"material":0},
                                   {"attributes":{"POSITION":0},"indices":1,"material":1}]})");
    Reader reader;
    const Assembly scene = io::read_scene(gltf.folder.write("t.gltf", text), {}, reader.function());
    CHECK(reader.asked.size() == 1);
}

#if !defined(__SANITIZE_ADDRESS__)  // which needs all addresses for itself
TEST_CASE("pictures that need more memory together than there is are refused") {
    const Folder folder;
    std::string mtl, obj = "mtllib t.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\n";
    for (const char* name : {"a", "b", "c"}) {
        mtl += std::string("newmtl ") + name + "\nmap_Kd " + folder.write(std::string(name) + ".png", "") + '\n';
        obj += std::string("usemtl ") + name + "\nf 1/1 2/1 3/1\n";
    }
    folder.write("t.mtl", mtl);
    const std::string path = folder.write("t.obj", obj);
    const io::ImageReader large = [](const std::string&, std::span<const std::uint8_t>) {
        return std::optional(DecodedImage{8192, 4096, std::vector<std::uint8_t>(std::size_t{1} << 27)});
    };
    std::size_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    rlimit before{};
    getrlimit(RLIMIT_AS, &before);
    rlimit small = before;
    small.rlim_cur = pages * 4096 + (std::size_t{5} << 27);  // room for the three, and not for a second time
    setrlimit(RLIMIT_AS, &small);
    std::string message = "no error";
    try {
        io::read_scene(path, {}, large);
    } catch (const SceneFileError& error) {
        message = error.what();
    }
    setrlimit(RLIMIT_AS, &before);
    CHECK(has(message, "t.obj: its first 3 textures are in memory, and a render needs as much again, 0.4 GB, and "));
}
#endif
