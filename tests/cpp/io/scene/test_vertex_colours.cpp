// Colours of vertices and faces. The truth is the numbers in the files: sRGB codes (IEC 61966-2-1) in OBJ and PLY, and
// linear ones in glTF.

#include <cmath>
#include <string>

#include "gltf_files.hpp"
#include "scene/geometry/opacity.hpp"
#include "scene/geometry/surface_point.hpp"
#include "scene/render_space/render_space_scene.hpp"

namespace {

using namespace scene_files;

double linear(double code) {
    return code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4);
}

VertexColor colour_at(const Scene& scene, std::size_t triangle, int corner) {
    return scene.colors[scene.triangles[triangle].vertices[corner]];
}

void check_colour(const VertexColor& c, double r, double g, double b, double alpha = 1) {
    check_vec(c.color, r, g, b, 1e-5);
    CHECK(double(c.alpha) == doctest::Approx(alpha).epsilon(1e-5));
}

std::string ply(const std::string& vertex_properties, const std::string& face_properties, const std::string& body,
                int vertices = 4, int faces = 2) {
    return "ply\nformat ascii 1.0\nelement vertex " + std::to_string(vertices) +
           "\nproperty float x\nproperty float y\nproperty float z\n" + vertex_properties + "element face " +
           std::to_string(faces) + "\nproperty list uchar int vertex_indices\n" + face_properties + "end_header\n" +
           body;
}

// A glTF triangle with another attribute, whose bytes stand in a file of their own.
std::string gltf_with_colours(const Folder& folder, const std::string& accessor, const std::string& bytes,
                              const std::string& materials = R"([{"name":"plain"}])") {
    folder.write("tri.bin", triangle_bytes());
    folder.write("colours.bin", bytes);
    std::string text =
        gltf(R"([{"mesh":0}])", "[0]", R"(,"materials":)" + materials, R"(,"NORMAL":1,"TEXCOORD_0":2,"COLOR_0":4)");
    const auto insert = [&](const std::string& list, const std::string& item) {
        const std::size_t begin = text.find('"' + list + "\":["), end = text.find(']', begin);
        text.insert(end, "," + item);
    };
    insert("accessors", R"({"bufferView":4,)" + accessor + R"(,"count":3})");
    insert("bufferViews", R"({"buffer":1,"byteLength":)" + std::to_string(bytes.size()) + "}");
    insert("buffers", R"({"byteLength":)" + std::to_string(bytes.size()) + R"(,"uri":"colours.bin"})");
    return folder.write("coloured.gltf", text);
}

template <class T>
std::string bytes_of(std::initializer_list<T> values) {
    return {reinterpret_cast<const char*>(values.begin()), sizeof(T) * values.size()};
}

}  // namespace

TEST_CASE("OBJ: colours behind the coordinates are sRGB codes, of a white surface where it has no material") {
    const Folder folder;
    const std::string faces = "f 1 2 3\n";
    const Scene scene = read(folder.write("a.obj", "v 0 0 0 1 0.5 0\nv 1 0 0 0.25 0 1\nv 0 1 0 0 0 0\n" + faces));
    CHECK(scene.warnings.empty());
    check_colour(colour_at(scene, 0, 0), 1, linear(0.5), 0);
    check_colour(colour_at(scene, 0, 1), linear(0.25), 0, 1);
    check_vec(scene.materials[0].diffuse, 1, 1, 1);

    // Codes up to 255, and alpha; a vertex without a colour is white.
    const Scene codes = read(folder.write("b.obj", "v 0 0 0\nv 1 0 0 255 51 0 0.5\nv 0 1 0 0 0 102\n" + faces));
    check_colour(colour_at(codes, 0, 1), 1, linear(51 / 255.0), 0, 0.5);
    check_colour(colour_at(codes, 0, 2), 0, 0, linear(0.4));
    CHECK(warns(codes, "exceed 1"));
    CHECK(codes.materials[0].has_holes());

    const Scene none = read(folder.write("c.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n" + faces));
    CHECK(none.colors.empty());
    check_vec(none.materials[0].diffuse, .5, .5, .5);
    CHECK(warns(read(folder.write("d.obj", "v 0 0 0 -1 nan 0\nv 1 0 0\nv 0 1 0\n" + faces)), "2 numbers"));
}

TEST_CASE("PLY: colours of vertices in any type") {
    const Folder folder;
    const std::string names = "red green blue alpha";
    const auto of = [&](const std::string& type, const std::string& first) {
        std::string properties;
        for (const char* name : {"red", "green", "blue", "alpha"}) properties += "property " + type + ' ' + name + '\n';
        return read(folder.write("v.ply", ply(properties, "",
                                              "0 0 0 " + first +
                                                  "\n1 0 0 0 0 0 0\n1 1 0 0 0 0 0\n0 1 0 0 0 0 0\n3 0 "
                                                  "1 2\n3 0 2 3\n")));
    };
    check_colour(colour_at(of("uchar", "255 51 0 102"), 0, 0), 1, linear(0.2), 0, 0.4);
    check_colour(colour_at(of("ushort", "65535 13107 0 26214"), 0, 0), 1, linear(0.2), 0, 0.4);
    check_colour(colour_at(of("float", "1 0.2 0 0.4"), 0, 0), 1, linear(0.2), 0, 0.4);
    check_vec(of("uchar", "9 9 9 9").materials[0].diffuse, 1, 1, 1);
}

TEST_CASE("PLY: colours of faces stay within their faces") {
    const Folder folder;
    const Scene scene =
        read(folder.write("f.ply", ply("", "property uchar red\nproperty uchar green\nproperty uchar blue\n",
                                       "0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2 255 0 0\n3 0 2 3 0 255 51\n")));
    REQUIRE(scene.triangles.size() == 2);
    for (int i = 0; i < 3; ++i) {
        check_colour(colour_at(scene, 0, i), 1, 0, 0);
        check_colour(colour_at(scene, 1, i), 0, 1, linear(0.2));
    }
    CHECK(corner(scene, 1, 2).y == 1);
    CHECK(scene.positions_m.size() == 6);
}

TEST_CASE("glTF: COLOR_0 is linear, of any type, and its alpha counts where the material has some") {
    const Folder folder;
    const Scene floats = read(gltf_with_colours(folder, R"("componentType":5126,"type":"VEC3")",
                                                bytes_of<float>({1, 0, 0.25f, 0, 1, 0, 0.5f, 2, -1})));
    CHECK(floats.warnings.empty());
    check_colour(colour_at(floats, 0, 0), 1, 0, 0.25);
    check_colour(colour_at(floats, 0, 2), 0.5, 1, 0);  // the specification: clamped to 0..1
    const std::string codes = bytes_of<std::uint8_t>({255, 0, 51, 102, 0, 255, 0, 255, 0, 0, 255, 0});
    const std::string accessor = R"("componentType":5121,"normalized":true,"type":"VEC4")";
    const Scene opaque = read(gltf_with_colours(folder, accessor, codes));
    check_colour(colour_at(opaque, 0, 0), 1, 0, 0.2, 0.4);
    CHECK_FALSE(opaque.materials[0].has_holes());
    const Scene blended = read(gltf_with_colours(folder, accessor, codes, R"([{"alphaMode":"BLEND"}])"));
    CHECK(blended.materials[0].has_holes());
    CHECK(blended.materials[0].vertex_opacity);
    const Scene shorts = read(gltf_with_colours(folder, R"("componentType":5123,"normalized":true,"type":"VEC3")",
                                                bytes_of<std::uint16_t>({65535, 0, 13107, 0, 0, 0, 0, 0, 0})));
    check_colour(colour_at(shorts, 0, 0), 1, 0, 0.2);
    const Scene unlit =
        read(gltf_with_colours(folder, accessor, codes, R"([{"extensions":{"KHR_materials_unlit":{}}}])"));
    CHECK(unlit.materials[0].vertex_emission);
    CHECK(has(error_of(gltf_with_colours(folder, R"("componentType":5126,"type":"VEC2")", bytes_of<float>({1, 1}))),
              "COLOR_0"));
}

TEST_CASE("At a hit colours are interpolated, multiply the diffuse colour, and alpha opacity") {
    Scene scene;
    scene.positions_m = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    scene.colors = {{{1, 0, 0}, 1}, {{0, 1, 0}, 0.5f}, {{0, 0, 1}, 0}};
    scene.materials.resize(1);
    scene.materials[0].diffuse = {0.5f, 0.25f, 1};
    scene.materials[0].vertex_opacity = 1;
    scene.materials[0].emission = {8, 8, 8};
    scene.materials[0].vertex_emission = 1;
    scene.triangles = {{{0, 1, 2}, 0}};
    const RenderSpaceScene render(scene, {0, 0, 0});
    const SceneView view = render.view();
    CHECK(view.kind == SceneKind::any);
    const Hit hit{1, 0, 0.25f, 0.5f};
    const SurfacePoint point = surface_point<SceneKind::any>(view, hit, {0.25f, 0.5f, 1}, {0, 0, -1}, 0);
    check_vec(point.diffuse, 0.125, 0.0625, 0.5);
    check_vec(point.emission, 2, 2, 4);
    CHECK(double(opacity_at(view, view.triangles[0], hit)) == doctest::Approx(0.25 + 0.125));

    scene.materials[0] = {};
    CHECK(RenderSpaceScene(scene, {0, 0, 0}).view().kind == SceneKind::opaque);
    scene.colors.clear();
    CHECK(RenderSpaceScene(scene, {0, 0, 0}).view().kind == SceneKind::plain);
}
