#include "ply_file.hpp"

#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <sstream>
#include <string_view>
#include <vector>

#include "../error.hpp"
#include "ply_data.hpp"
#include "scene_cleanup.hpp"

namespace realcam::io {
namespace {

// Where a vertex keeps its numbers.
enum Slot : std::size_t { x, y, z, nx, ny, nz, u, v, slot_count, unread = slot_count };

Slot slot_of(std::string_view name) {
    static constexpr std::string_view names[][slot_count] = {{"x", "y", "z", "nx", "ny", "nz", "s", "t"},
                                                             {"", "", "", "", "", "", "u", "v"},
                                                             {"", "", "", "", "", "", "texture_u", "texture_v"}};
    for (const auto& row : names) {
        for (std::size_t i = 0; i < slot_count; ++i) {
            if (row[i] == name) return static_cast<Slot>(i);
        }
    }
    return unread;
}

class PlyReader {
public:
    PlyReader(Scene& scene, const std::string& path, double scale, const PlyHeader& header, PlyData data)
        : scene_(scene), path_(path), scale_(scale), header_(header), data_(data) {}

    void read() {
        for (const PlyElement& element : header_.elements) {
            if (element.name == "vertex") start_vertices(element);
            for (std::size_t i = 0; i < element.count; ++i) {
                if (element.name == "vertex")
                    read_vertex(element, i);
                else
                    read_face(element, i);
            }
        }
        std::vector<std::uint32_t> smooth;
        if (scene_.normals.empty()) {
            smooth.resize(scene_.triangles.size());
            for (std::size_t t = 0; t < smooth.size(); ++t) smooth[t] = static_cast<std::uint32_t>(t);
        }
        check_indices();
        clean_geometry(scene_, smooth, path_);
        warn_count(scene_, path_, bad_, "normals or texture coordinates are no finite numbers, 0 taken");
    }

private:
    [[noreturn]] void fail(const PlyElement& element, std::size_t i, const std::string& what) const {
        throw SceneFileError(path_ + ": " + element.name + " " + std::to_string(i) + ": " + what);
    }

    double number(const PlyElement& element, std::size_t i, PlyType type) {
        if (const std::optional<double> value = data_.next(type)) return *value;
        if (data_.bytes_left() > 8) fail(element, i, "a number is wanted");
        throw SceneFileError(path_ + ": is cut short: its header promises " + std::to_string(element.count) + " of \"" +
                             element.name + "\", and it ends in number " + std::to_string(i));
    }

    void start_vertices(const PlyElement& element) {
        std::array<bool, slot_count + 1> has{};
        for (const PlyProperty& p : element.properties) has[slot_of(p.name)] = true;
        if (!has[x] || !has[y] || !has[z]) throw SceneFileError(path_ + ": its vertices have no x, y and z");
        if (element.count > std::numeric_limits<std::uint32_t>::max()) {
            throw SceneFileError(path_ + ": more than 4294967295 vertices");
        }
        has_normals_ = has[nx] && has[ny] && has[nz];
        has_uvs_ = has[u] && has[v];
    }

    void read_vertex(const PlyElement& element, std::size_t i) {
        std::array<double, slot_count + 1> value{};
        for (const PlyProperty& p : element.properties) {
            if (p.count_type)
                skip_list(element, i, p);
            else
                value[slot_of(p.name)] = number(element, i, p.type);
        }
        if (!std::isfinite(value[x] + value[y] + value[z])) {
            std::ostringstream text;
            text << '(' << value[x] << ", " << value[y] << ", " << value[z] << ')';
            fail(element, i, "coordinates must be finite numbers, not " + text.str());
        }
        scene_.positions_m.push_back(scale_ * Vec3d{value[x], value[y], value[z]});
        if (has_normals_) scene_.normals.push_back(normal({value[nx], value[ny], value[nz]}));
        if (has_uvs_) {
            const Vec2f uv = {static_cast<float>(value[u]), static_cast<float>(value[v])};
            const bool good = std::isfinite(uv.x) && std::isfinite(uv.y);
            if (!good) ++bad_;
            scene_.uvs.push_back(good ? uv : Vec2f{0, 0});
        }
    }

    Vec3f normal(Vec3d n) {
        const double size = length(n);
        if (!std::isfinite(size)) ++bad_;
        return size > 0 && std::isfinite(size) ? static_cast<Vec3f>((1 / size) * n) : Vec3f{0, 0, 0};
    }

    void skip_list(const PlyElement& element, std::size_t i, const PlyProperty& p) {
        const double count = number(element, i, *p.count_type);
        for (double k = 0; k < count; ++k) number(element, i, p.type);
    }

    // Of a face, or of an element that is not read.
    void read_face(const PlyElement& element, std::size_t i) {
        const bool is_face = element.name == "face";
        for (const PlyProperty& p : element.properties) {
            if (!p.count_type) {
                number(element, i, p.type);
            } else if (is_face && (p.name == "vertex_indices" || p.name == "vertex_index")) {
                read_polygon(element, i, p);
            } else {
                skip_list(element, i, p);
            }
        }
    }

    void read_polygon(const PlyElement& element, std::size_t i, const PlyProperty& p) {
        const double count = number(element, i, *p.count_type);
        std::uint32_t first = 0, before = 0;
        for (double k = 0; k < count; ++k) {
            const double index = number(element, i, p.type);
            if (!(index >= 0 && index < 4294967295.0 && index == std::floor(index))) {
                fail(element, i, "an index is a whole number of at least 0");
            }
            const auto vertex = static_cast<std::uint32_t>(index);
            if (k == 0) first = vertex;
            if (k >= 2) {
                scene_.triangles.push_back({{first, before, vertex}, 0});
                faces_.push_back(i);
            }
            before = vertex;
        }
    }

    // At the end: nothing says that the vertices come first.
    void check_indices() const {
        for (std::size_t t = 0; t < scene_.triangles.size(); ++t) {
            for (const std::uint32_t vertex : scene_.triangles[t].vertices) {
                if (vertex < scene_.positions_m.size()) continue;
                throw SceneFileError(path_ + ": face " + std::to_string(faces_[t]) + ": index " +
                                     std::to_string(vertex) + " is not smaller than the number of vertices, " +
                                     std::to_string(scene_.positions_m.size()));
            }
        }
    }

    Scene& scene_;
    const std::string& path_;
    double scale_;
    const PlyHeader& header_;
    PlyData data_;
    std::vector<std::size_t> faces_;  // of each triangle
    bool has_normals_ = false, has_uvs_ = false;
    std::size_t bad_ = 0;
};

}  // namespace

std::string read_ply(Scene& scene, const std::string& path, double scale) {
    std::ifstream file(path, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    const PlyHeader header = parse_ply_header(text, path);
    PlyReader(scene, path, scale, header, {std::string_view(text).substr(header.size), header.format}).read();
    return header.texture;
}

}  // namespace realcam::io
