// OBJ, MTL and PLY files that are wrong, or strange and right. Each ends in a scene or in one line that names file and
// line, soon, and without memory that the file only promises.

#include <sys/stat.h>

#include <cmath>
#include <string>

#include "io/hostile_scenes.hpp"

using namespace scene_files;

namespace {

const std::string kThree = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

/// A polygon of n corners about the origin, whose distance is 1 and `inner` in turn.
std::string star(int n, double inner) {
    std::string points, face = "f";
    for (int i = 0; i < n; ++i) {
        const double a = 2 * M_PI * i / n, r = i % 2 ? inner : 1;
        points += "v " + std::to_string(r * std::cos(a)) + ' ' + std::to_string(r * std::sin(a)) + " 0\n";
        face += ' ' + std::to_string(i + 1);
    }
    return points + face + "\n";
}

double area_of(const Scene& scene) {
    double sum = 0;
    for (std::size_t t = 0; t < scene.triangles.size(); ++t)
        sum += length(cross(corner(scene, t, 1) - corner(scene, t, 0), corner(scene, t, 2) - corner(scene, t, 0))) / 2;
    return sum;
}

std::string ply_header(const std::string& elements) {
    return "ply\nformat ascii 1.0\n" + elements + "end_header\n";
}
const std::string kPlyVertices = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
const std::string kPlyFace = "element face 1\nproperty list uchar int vertex_indices\n";

}  // namespace

TEST_CASE("OBJ: concave polygons have their own area, convex and huge ones too") {
    const Folder folder;
    // A polygon of alternating radii 1 and r is n triangles of area r sin(2 pi / n) / 2.
    const Scene small = read(folder.write("star.obj", star(10, 0.3)));
    CHECK(area_of(small) == doctest::Approx(10 * 0.3 * std::sin(2 * M_PI / 10) / 2).epsilon(1e-5));
    for (std::size_t t = 0; t < small.triangles.size(); ++t) CHECK(face_normal(small, t).z > 0.999);
    const std::string arrow = folder.write("arrow.obj", "v 0 0 0\nv 2 1 0\nv 4 0 0\nv 2 4 0\nf 1 2 3 4\n");
    CHECK(area_of(read(arrow)) == doctest::Approx(6));  // the large triangle's 8 less the notch's 2
    const int n = 200000;
    for (const double inner : {1.0, 0.9}) {
        const std::string path = folder.write("huge.obj", star(n, inner));
        Scene scene;
        CHECK(seconds_of([&] { scene = read(path); }) < 10);
        // Coordinates are written with six digits.
        CHECK(area_of(scene) == doctest::Approx(n * inner * std::sin(2 * M_PI / n) / 2).epsilon(1e-3));
    }
}

TEST_CASE("OBJ: a polygon that crosses itself everywhere ends soon") {
    const Folder folder;
    std::string text, face = "f";
    for (std::int64_t i = 0; i < 100000; ++i) {
        text += "v " + std::to_string((i * 7919) % 10007) + ' ' + std::to_string((i * 104729) % 9973) + " 0\n";
        face += ' ' + std::to_string(i + 1);
    }
    const std::string path = folder.write("tangle.obj", text + face + "\n");
    CHECK(seconds_of([&] { CHECK(warns(read(path), "cross themselves")); }) < 10);
}

TEST_CASE("OBJ: line ends, continued lines, a byte-order mark, blanks and comments") {
    const Folder folder;
    for (const std::string end : {"\n", "\r\n", "\r"}) {
        const std::string text = "\xef\xbb\xbf# a comment" + end + "  v 0 0 0  " + end + "v\t1 0 0 # 1" + end + end;
        std::string plain = text.substr(0, text.find(" # 1")) + end + "v 0 \\" + end + "+1 0" + end + "f 1 \\" + end +
                            "  -2 3" + end + "o end";
        const Scene scene = read(folder.write("ends.obj", plain));
        REQUIRE(scene.triangles.size() == 1);
        CHECK(corner(scene, 0, 2).y == 1);
    }
    const Scene scene = read(folder.write("comments.obj",
                                          "v 0 0 0 # a\nv 1 0 0#b\nv 0 1 0 1 #\nvt 0 0 # c\nvn 0 0 1 # d\n"
                                          "o Box #25\nf 1/1/1 2/1/1 3/1/1 # e\nf 1 2 # 3\n"));
    CHECK(scene.triangles.size() == 1);
    CHECK(warns(scene, "1 faces have fewer than three corners"));
    CHECK(has(error_of(folder.write("utf16.obj", std::string("\xff\xfe"
                                                             "v\0 \0",
                                                             6))),
              "line 1: holds a null character"));
}

TEST_CASE("OBJ: references that are wrong name their line") {
    const Folder folder;
    const auto error = [&](const std::string& face) { return error_of(folder.write("a.obj", kThree + face)); };
    CHECK(has(error("f 1/1/1/1 2 3\n"), "line 4: a corner is v, v/vt, v//vn or v/vt/vn, not \"1/1/1/1\""));
    CHECK(has(error("f 1 2 x\n"), "line 4: a corner is v, v/vt, v//vn or v/vt/vn, not \"x\""));
    CHECK(has(error("f 1 2 " + std::string(100000, 'x') + "\n"), "xxx...\""));
    CHECK(has(error("f 0 1 2\n"), "line 4: vertex 0 does not exist; numbers begin with 1"));
    CHECK(has(error("f -4 1 2\n"), "line 4: vertex -4 does not exist; there are 3 before this line"));
    CHECK(has(error("f 1 2 99999999999999999999\n"), "line 4: vertex 9223372036854775807 does not exist"));
    CHECK(has(error("f 1 2 4294967296\n"), "line 4: vertex 4294967296 does not exist; there are 3"));
    CHECK(has(error("f 1/7 2/1 3/1\nvt 0 0\n"), "line 4: texture coordinate 7 does not exist; there are 1"));
    CHECK(has(error("f 1//1 2//1 3//1\n"), "line 4: normal 1 does not exist; there are 0"));
    CHECK(has(error("v 1 2\nf 1 2 3\n"), "line 4: expected 3 numbers, not 2"));
    CHECK(has(error("v 1 2,0 3\nf 1 2 3\n"), "line 4: expected a number, not \"2,0\""));
    CHECK(error("f 1/ 2// 3\n") == "no error");
    const Scene later = read(folder.write("later.obj", "f 1 2 3\nf 1 2\np 1\n" + kThree));
    CHECK(later.triangles.size() == 1);
    CHECK(warns(later, "1 faces have fewer than three corners"));
    CHECK(has(error_of(folder.write("far.obj", kThree + "v 0 2e12 0\nf 1 2 4\n")),
              "line 4: coordinates must be finite numbers of at most 1e12 m, not (0, 2e+12, 0)"));
}

TEST_CASE("OBJ: groups are nodes, and some corners have what others lack") {
    const Folder folder;
    const std::string path = folder.write("cars.obj", kThree + "o car\nf 1 2 3\no tree\nf 1 2 3\ng car\nf 3 2 1\n");
    const Assembly scene = read_assembly(path, {"car"});
    REQUIRE(scene.instances.size() == 1);
    CHECK(scene.instances[0].object->triangles.size() == 2);
    CHECK(scene.static_geometry->triangles.size() == 1);
    const Scene mixed = read(folder.write("mixed.obj", kThree + "vt 0.5 1\nvn 1 0 0\nf 1 2 3\nf 1/1/1 2//1 3\n"));
    CHECK(mixed.triangles.size() == 2);
    CHECK(mixed.uvs[mixed.triangles[1].vertices[0]].x == 0.5f);
    check_vec(mixed.normals[mixed.triangles[1].vertices[0]], 1, 0, 0);
    check_vec(mixed.normals[mixed.triangles[0].vertices[0]], 0, 0, 1);
}

TEST_CASE("MTL: what is wrong is a counted warning, or an error that names its own line") {
    const Folder folder;
    const std::string obj = folder.write("a.obj", "mtllib a.mtl\nusemtl m\n" + kThree + "f 1 2 3\n");
    const auto warnings = [&](const std::string& mtl) {
        folder.write("a.mtl", mtl);
        return read(obj);
    };
    for (const char* key : {"map_Kd x.png", "map_Ke x.png", "bump x.png", "norm x.png", "disp x.png", "Kd 1 1 1"}) {
        const Scene scene = warnings(std::string(key) + "\nnewmtl m\nKd .1 .2 .3\n");
        check_vec(scene.materials[scene.triangles[0].material].diffuse, .1, .2, .3);
    }
    CHECK(warns(warnings("Kd 1 1 1\nnewmtl m\n"), "a.mtl: 1 lines precede the first \"newmtl\""));
    CHECK(warns(warnings("newmtl m\nKd 1 x 1\nNs\n"), "a.mtl: line 2 cannot be read, nor 1 others"));
    CHECK(warns(warnings("newmtl other\n"), "no MTL file has the material \"m\""));
    check_vec(warnings("\xef\xbb\xbfnewmtl m\r\nKd 0.25\r\n").materials[0].diffuse, .25, .25, .25);
    folder.write("my wood.png", "not decoded here");
    CHECK(warnings("newmtl m\nmap_Kd -s 2 2 2 -clamp on -bm 0.5 my wood.png\n").warnings.back().find("no such file") ==
          std::string::npos);

    const auto error = [&](const std::string& mtl) {
        const std::string path = folder.write("a.mtl", mtl);
        try {
            read(obj);
        } catch (const SceneFileError& e) {
            CHECK(std::string(e.what()).starts_with(path));
            return std::string(e.what());
        }
        return std::string("no error");
    };
    CHECK(has(error("newmtl m\nKd 1 -1 1\n"), "a.mtl: line 2: Kd must be finite and not negative"));
    CHECK(has(error("newmtl m\nNs nan\n"), "a.mtl: line 2: Ns must be finite and not negative"));
    CHECK(has(error("newmtl m\nKe inf 0 0\n"), "a.mtl: line 2: Ke must be finite"));
}

TEST_CASE("PLY: elements that promise what is not there") {
    const Folder folder;
    const std::string good = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    const auto error = [&](const std::string& elements) {
        std::string out;
        CHECK(seconds_of([&] { out = error_of(folder.write("a.ply", ply_header(elements) + good)); }) < 10);
        return out;
    };
    CHECK(error("element foo 1000000000000\n" + kPlyVertices + kPlyFace) == "no error");
    CHECK(has(error(kPlyVertices + "element face 1000000000000\n"), "holds no triangles"));
    CHECK(has(error(kPlyVertices + "element face -1\nproperty uchar a\n"),
              "line 7: expected \"element\", a name and a number"));
    CHECK(has(error(kPlyVertices + "element face 1000000000\nproperty list uchar int vertex_indices\n"),
              "its header promises 1000000000 of \"face\", and has"));
    CHECK(has(error("element vertex 4000000000\nproperty float x\nproperty float y\nproperty float z\n" + kPlyFace),
              "its header promises 4000000000 of \"vertex\""));
    CHECK(has(error("element vertex 99999999999999999999\nproperty float x\n" + kPlyFace),
              "promises 9223372036854775807"));
    CHECK(has(error(kPlyVertices + "element face 1\nproperty list float int vertex_indices\n"), "no error"));
    const auto body = [&](const std::string& face) {
        return error_of(folder.write("a.ply", ply_header(kPlyVertices + kPlyFace) + "0 0 0\n1 0 0\n0 1 0\n" + face));
    };
    CHECK(has(body("-3 0 1 2\n"), "face 0: the length of a list must be a whole number"));
    CHECK(has(body("1e9 0 1 2\n"), "face 0: is cut short: a list is longer than the 7 bytes that are left"));
    CHECK(has(body("3 0 1 -2\n"), "face 0: an index must be a whole number of at least 0"));
    CHECK(
        has(error_of(folder.write("a.ply", ply_header(kPlyVertices + kPlyFace) + "0 0 2e12\n1 0 0\n0 1 0\n3 0 1 2\n")),
            "vertex 0: coordinates must be finite numbers of at most 1e12 m, not (0, 0, 2e+12)"));
}

TEST_CASE("only ordinary files are read") {
    const Folder folder;
    for (const char* suffix : {".obj", ".ply", ".gltf", ".glb"}) {
        const std::string pipe = folder.path(std::string("pipe") + suffix);
        REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
        CHECK(has(error_of(pipe), "is a pipe or a device; expected an ordinary file"));
        fs::create_symlink("/dev/zero", folder.path(std::string("zero") + suffix));
        CHECK(has(error_of(folder.path(std::string("zero") + suffix)), "expected an ordinary file"));
    }
    REQUIRE(mkfifo(folder.path("pipe.mtl").c_str(), 0600) == 0);
    REQUIRE(mkfifo(folder.path("pipe.png").c_str(), 0600) == 0);
    CHECK(warns(read(folder.write("m.obj", "mtllib pipe.mtl\n" + kThree + "f 1 2 3\n")),
                "mtllib \"pipe.mtl\": no such file"));
    folder.write("p.mtl", "newmtl m\nmap_Kd pipe.png\n");
    CHECK(warns(read(folder.write("p.obj", "mtllib p.mtl\nusemtl m\n" + kThree + "f 1 2 3\n")), "texture pipe.png"));
}

TEST_CASE("a file that is larger than memory is refused at once") {
    const Folder folder;
    for (const char* name : {"huge.gltf", "huge.ply", "huge.obj"}) {
        const std::string path = folder.write(name, "ply\n");
        fs::resize_file(path, std::uintmax_t{1} << 42);  // a hole: it takes no place on the disk
        CHECK(seconds_of([&] { CHECK(has(error_of(path), "of memory are free")); }) < 10);
    }
}

TEST_CASE("a line without an end, and a path that no system knows") {
    const Folder folder;
    const std::string path = folder.write("line.obj", std::string(300000000, ' '));
    CHECK(has(error_of(path), "line 1: is longer than 268435456 bytes"));
    fs::remove(path);
    try {
        read(std::string(100000, 'x') + ".obj");
        CHECK(false);
    } catch (const SceneFileError& error) {
        CHECK(std::string(error.what()).size() < 200);
    }
}

TEST_CASE("names that are no UTF-8, and a thousand warnings") {
    const Folder folder;
    folder.write("l.mtl", "newmtl gr\xfcn\nd 0.5\nmap_Kd gr\xfcn.png\n");
    const Scene scene = read(folder.write("l.obj", "mtllib l.mtl\nusemtl gr\xfcn\n" + kThree + "f 1 2 3\n"));
    CHECK(scene.material_names[0] == "gr\xef\xbf\xbdn");
    CHECK(warns(scene, "texture gr\xef\xbf\xbdn.png: no such file"));
    const Assembly named = read_assembly(folder.write("n.obj", kThree + "o \xff\nf 1 2 3\n"), {"\xef\xbf\xbd"});
    REQUIRE(named.instances.size() == 1);
    CHECK(named.instances[0].name == "\xef\xbf\xbd");

    std::string libraries;
    for (int i = 0; i < 1000; ++i) libraries += "mtllib gone" + std::to_string(i) + ".mtl\n";
    const Scene warned = read(folder.write("w.obj", libraries + kThree + "f 1 2 3\n"));
    CHECK(warned.warnings.size() == 50);
    CHECK(has(warned.warnings.back(), "951 warnings more"));
}

TEST_CASE("reading hears its caller: often, and stops") {
    const Folder folder;
    std::string text;
    for (int i = 0; i < 300000; ++i) text += "v " + std::to_string(i % 977) + ' ' + std::to_string(i % 331) + " 0\n";
    for (int i = 1; i + 2 <= 300000; ++i)
        text += "f " + std::to_string(i) + ' ' + std::to_string(i + 1) + ' ' + std::to_string(i + 2) + '\n';
    const std::string path = folder.write("long.obj", text);
    int asked = 0;
    double longest = 0;
    auto last = std::chrono::steady_clock::now();
    const double seconds = seconds_of([&] {
        io::read_scene(path,
                       {1,
                        {},
                        [&] {
                            const auto now = std::chrono::steady_clock::now();
                            longest = std::max(longest, std::chrono::duration<double>(now - last).count());
                            last = now;
                            ++asked;
                            return true;
                        }},
                       {});
    });
    CHECK(asked > seconds / 0.2);
    CHECK(longest < 0.5);  // 0.02 s where nothing else keeps the machine busy
    for (const int until : {1, 2}) {
        int left = until;
        CHECK_THROWS_AS(io::read_scene(path, {1, {}, [&] { return --left > 0; }}, {}), Cancelled);
    }
}
