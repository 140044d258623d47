// Smoothing groups of OBJ (Alias|Wavefront's "Object Files", 1995): within a group normals are those of a smooth
// surface, whatever the angle; "off" and 0 are faceted.

#include <cmath>
#include <string>

#include "scene_files.hpp"

namespace {

using namespace scene_files;

/// Two squares that meet along x = 0, each turned out of the plane by `degrees`; `s` stands before the faces.
std::string ridge(double degrees, const std::string& first, const std::string& second, bool shares = true,
                  bool has_uvs = false) {
    const std::string z = std::to_string(-std::tan(degrees * M_PI / 180));
    const auto corner = [&](int vertex, int uv) {
        return std::to_string(vertex) + (has_uvs ? '/' + std::to_string(uv) : "") + ' ';
    };
    std::string text = "v -1 -1 " + z + "\nv 0 -1 0\nv 1 -1 " + z + "\nv 1 1 " + z + "\nv 0 1 0\nv -1 1 " + z +
                       "\nv 0 -1 0\nv 0 1 0\nvt 0 0\nvt 1 1\n";
    text += first + "f " + corner(1, 1) + corner(2, 1) + corner(5, 1) + corner(6, 1) + '\n';
    return text + second + "f " + corner(shares ? 2 : 7, 2) + corner(3, 2) + corner(4, 2) + corner(shares ? 5 : 8, 2) +
           '\n';
}

double normal_x(const Scene& scene, double x, bool of_left_face) {
    for (const Triangle& t : scene.triangles) {
        double middle = 0;
        for (const std::uint32_t v : t.vertices) middle += scene.positions_m[v].x;
        for (const std::uint32_t v : t.vertices)
            if (scene.positions_m[v].x == x && (middle < 0) == of_left_face)
                return scene.normals.empty() ? 2 : double(scene.normals[v].x);
    }
    return 3;
}

}  // namespace

TEST_CASE("A smoothing group is smooth at any angle, and off is faceted at any") {
    const Folder folder;
    for (const double degrees : {10.0, 26.5, 60.0, 80.0}) {
        const double face = std::sin(degrees * M_PI / 180);
        for (const bool has_uvs : {false, true}) {
            const auto read_ridge = [&](const std::string& first, const std::string& second) {
                return read(folder.write("r.obj", ridge(degrees, first, second, true, has_uvs)));
            };
            const Scene smooth = read_ridge("s 1\n", "");
            CHECK(normal_x(smooth, 0, true) == doctest::Approx(0).epsilon(1e-6));
            CHECK(normal_x(smooth, -1, true) == doctest::Approx(-face).epsilon(1e-5));
            CHECK(normal_x(read_ridge("s\n", ""), 0, true) == doctest::Approx(0).epsilon(1e-6));
            // Off, 0, before the first line, and between two groups.
            for (const auto& [first, second] :
                 {std::pair{"s off\n", ""}, {"s 0\n", ""}, {"s 1\n", "s 2\n"}, {"", "s 1\n"}}) {
                const Scene faceted = read_ridge(first, second);
                const bool has_normals = !faceted.normals.empty();
                if (has_normals) {
                    CHECK(std::abs(std::abs(normal_x(faceted, 0, true)) - face) * normal_x(faceted, 0, true) ==
                          doctest::Approx(0).epsilon(1e-5));
                    CHECK(std::abs(std::abs(normal_x(faceted, 0, false)) - face) * normal_x(faceted, 0, false) ==
                          doctest::Approx(0).epsilon(1e-5));
                }
            }
        }
    }
}

TEST_CASE("Within a group faces meet at the vertices that they share, not where two lie in the same place") {
    const Folder folder;
    const Scene split = read(folder.write("split.obj", ridge(30, "s 1\n", "", false)));
    CHECK(normal_x(split, 0, true) == doctest::Approx(-0.5).epsilon(1e-5));
    CHECK(normal_x(split, 0, false) == doctest::Approx(0.5).epsilon(1e-5));
}

TEST_CASE("Without any line of smoothing the angle decides: 45 degrees") {
    const Folder folder;
    CHECK(normal_x(read(folder.write("a.obj", ridge(22, "", ""))), 0, true) == doctest::Approx(0).epsilon(1e-6));
    CHECK(normal_x(read(folder.write("b.obj", ridge(23, "", ""))), 0, true) ==
          doctest::Approx(-std::sin(23 * M_PI / 180)).epsilon(1e-5));
}
