// Faces of PLY files: strips, texture coordinates of faces, and textures by index. The truth is the numbers in the
// files.

#include <string>
#include <vector>

#include "scene_files.hpp"

namespace {

using namespace scene_files;

std::string header(const std::string& comments, int vertices, const std::string& faces) {
    return "ply\nformat ascii 1.0\n" + comments + "element vertex " + std::to_string(vertices) +
           "\nproperty float x\nproperty float y\nproperty float z\n" + faces + "end_header\n";
}

const std::string square = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

Vec2f uv_at(const Scene& scene, std::size_t triangle, int corner) {
    return scene.uvs[scene.triangles[triangle].vertices[corner]];
}

}  // namespace

TEST_CASE("PLY: triangle strips, in which -1 begins a new one, face one way") {
    const Folder folder;
    // Two rows of a grid of 3 x 3, the second behind a -1; vertices by rows.
    const std::string body = "0 0 0\n1 0 0\n2 0 0\n0 1 0\n1 1 0\n2 1 0\n0 2 0\n1 2 0\n2 2 0\n";
    const std::string strips = "element tristrips 1\nproperty list int int vertex_indices\n";
    const Scene scene = read(folder.write("s.ply", header("", 9, strips) + body + "13 0 3 1 4 2 5 -1 3 6 4 7 5 8\n"));
    REQUIRE(scene.triangles.size() == 8);
    double area = 0;
    for (std::size_t t = 0; t < 8; ++t) {
        const Vec3d normal =
            cross(corner(scene, t, 1) - corner(scene, t, 0), corner(scene, t, 2) - corner(scene, t, 0));
        CHECK(normal.z < 0);  // as the first, 0 3 1, goes round
        area += 0.5 * length(normal);
    }
    CHECK(area == doctest::Approx(4));
    // Repeated vertices join strips: triangles without area.
    CHECK(read(folder.write("d.ply", header("", 4, strips) + square + "6 0 1 1 3 2 2\n")).triangles.size() == 1);
    for (const std::string wrong : {"3 0 1 4\n", "3 0 1 -2\n", "3 0 1 1.5\n"})
        CHECK(has(error_of(folder.write("w.ply", header("", 4, strips) + square + wrong)), "index"));
    CHECK(has(error_of(folder.write("e.ply", header("", 4, strips) + square + "5 0 1 -1 2 3\n")), "no triangles"));
    // Beside faces, whose colours the strips do not have.
    const Scene both = read(folder.write(
        "b.ply", header("", 4,
                        "element face 1\nproperty list uchar int vertex_indices\nproperty uchar red\nproperty uchar "
                        "green\nproperty uchar blue\n" +
                            strips) +
                     square + "3 0 1 2 255 0 0\n3 0 2 3\n"));
    CHECK(both.colors[both.triangles[0].vertices[0]] == VertexColor{{1, 0, 0}, 1});
    CHECK(both.colors[both.triangles[1].vertices[0]] == VertexColor{});
}

TEST_CASE("PLY: texture coordinates of faces, of polygons too, in any order of the properties") {
    const Folder folder;
    folder.write("a b.png", "not decoded here");
    const std::string faces =
        "element face 2\nproperty list uchar float texcoord\nproperty list uchar int vertex_indices\n";
    const Scene scene =
        read(folder.write("w.ply", header("comment TextureFile a b.png \n", 4, faces) + square +
                                       "8 0 0 1 0 1 1 0 1 4 0 1 2 3\n6 0.5 0.5 0.25 0.5 0.125 1 3 3 2 1\n"));
    REQUIRE(scene.triangles.size() == 3);
    CHECK(scene.warnings.empty());
    CHECK(scene.textures.size() == 1);
    CHECK(scene.materials[scene.triangles[0].material].diffuse_texture.texture == 0);
    CHECK(uv_at(scene, 0, 2).x == 1);
    CHECK(uv_at(scene, 1, 2).y == 1);
    CHECK(uv_at(scene, 1, 2).x == 0);
    CHECK(uv_at(scene, 2, 0).x == 0.5f);
    CHECK(uv_at(scene, 2, 2).x == 0.125f);
    CHECK(uv_at(scene, 2, 2).y == 1);
    const Scene odd = read(folder.write(
        "o.ply", header("comment TextureFile a b.png\n", 4, faces) + square + "2 0 0 4 0 1 2 3\n0 3 3 2 1\n"));
    CHECK(warns(odd, "1 faces have texture coordinates that are not two for each corner"));
    // Named, and nothing to lay it by.
    const Scene none = read(folder.write("n.ply", header("comment TextureFile a b.png\n", 4,
                                                         "element face 1\nproperty list uchar int vertex_indices\n") +
                                                      square + "4 0 1 2 3\n"));
    CHECK(warns(none, "no texture coordinates"));
    CHECK(none.textures.empty());
}

TEST_CASE("PLY: several textures, which the faces name by number") {
    const Folder folder;
    folder.write("a.png", "not decoded here");
    folder.write("b.png", "not decoded here");
    Reader reader;
    const std::string path = folder.write(
        "t.ply", header("comment TextureFile a.png\ncomment TextureFile b.png\n", 4,
                        "element face 3\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\n"
                        "property int texnumber\n") +
                     square + "3 0 1 2 6 0 0 1 0 1 1 1\n3 0 2 3 6 0 0 1 1 0 1 0\n3 3 2 1 6 0 0 1 1 0 1 -1\n");
    const Scene scene = *io::read_scene(path, {1}, reader.function()).static_geometry;
    REQUIRE(scene.triangles.size() == 3);
    const auto texture_of = [&](std::size_t t) {
        const std::int32_t number = scene.materials[scene.triangles[t].material].diffuse_texture.texture;
        return number < 0 ? std::string("none") : scene.textures[static_cast<std::size_t>(number)].name;
    };
    CHECK(texture_of(0) == "b.png");
    CHECK(texture_of(1) == "a.png");
    CHECK(texture_of(2) == "none");
}
