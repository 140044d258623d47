#pragma once
// Small scene files, written and read by the tests.

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "doctest/doctest.h"
#include "error.hpp"
#include "io/scene_file.hpp"

namespace scene_files {

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

// Image reader that returns one pixel of a fixed colour. `asked` records the names of the images requested.
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

inline Assembly read_assembly(const std::string& path, const std::vector<std::string>& objects, double scale = 1) {
    Reader reader;
    return io::read_scene(path, {scale, objects}, reader.function());
}

inline Scene read(const std::string& path, double scale = 1) {
    return *read_assembly(path, {}, scale).static_geometry;
}

inline std::string error_of(const std::string& path) {
    try {
        read(path);
    } catch (const SceneFileError& error) {
        CHECK(std::string(error.what()).starts_with(path));
        CHECK(std::string(error.what()).find('\n') == std::string::npos);
        return error.what();
    }
    return "no error";
}

inline bool has(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

inline bool warns(const Scene& scene, const std::string& part) {
    for (const std::string& warning : scene.warnings) {
        if (has(warning, part)) return true;
    }
    return false;
}

inline void check_vec(Vec3f v, double x, double y, double z, double within = 1e-6);
inline void check_vec(Color c, double r, double g, double b, double within = 1e-6) {
    check_vec(Vec3f{c.r, c.g, c.b}, r, g, b, within);
}
inline void check_vec(Vec3f v, double x, double y, double z, double within) {
    CHECK(double(v.x) == doctest::Approx(x).epsilon(within));
    CHECK(double(v.y) == doctest::Approx(y).epsilon(within));
    CHECK(double(v.z) == doctest::Approx(z).epsilon(within));
}

inline Vec3d corner(const Scene& scene, std::size_t triangle, int i) {
    return scene.positions_m[scene.triangles[triangle].vertices[i]];
}

inline Vec3d face_normal(const Scene& scene, std::size_t t) {
    return normalized(cross(corner(scene, t, 1) - corner(scene, t, 0), corner(scene, t, 2) - corner(scene, t, 0)));
}

}  // namespace scene_files
