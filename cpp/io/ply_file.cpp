#include "ply_file.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <string_view>
#include <vector>

#include "../error.hpp"
#include "../scene/scene_checks.hpp"
#include "ply_data.hpp"
#include "printable.hpp"
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
    PlyReader(Scene& scene, const std::string& path, double scale, Checkpoint& checkpoint)
        : scene_(scene), path_(path), scale_(scale), checkpoint_(checkpoint), data_(path, checkpoint) {}

    /// Returns the texture's name.
    std::string read() {
        for (const PlyElement& element : data_.header().elements) {
            // One without properties takes no bytes, however many of it there are.
            if (element.properties.empty()) continue;
            check_promise(element);
            if (element.name == "vertex")
                read_vertices(element);
            else
                read_faces(element);
        }
        check_indices();
        clean_geometry(scene_, std::vector<bool>(scene_.triangles.size(), scene_.normals.empty()), path_, checkpoint_);
        warn_count(scene_, path_, bad_, "normals or texture coordinates are no finite numbers, 0 taken");
        return data_.header().texture;
    }

private:
    [[noreturn]] void fail(const PlyElement& element, std::uint64_t i, const std::string& what) const {
        throw SceneFileError(path_ + ": " + printable(element.name).substr(0, 60) + " " + std::to_string(i) + ": " +
                             what);
    }
    [[noreturn]] void fail_short(const PlyElement& element, const std::string& what) const {
        throw SceneFileError(path_ + ": is cut short: its header promises " + std::to_string(element.count) + " of " +
                             in_quotes(element.name) + ", and " + what);
    }

    /// Before any memory is taken for them. The last number of an ASCII file needs no blank behind it.
    void check_promise(const PlyElement& element) const {
        std::uint64_t least = 0;
        for (const PlyProperty& p : element.properties) least += data_.least_bytes(p.count_type.value_or(p.type));
        if (element.count > (data_.bytes_left() + 1) / least)
            fail_short(element, "has " + std::to_string(data_.bytes_left()) + " bytes for them");
    }

    double number(const PlyElement& element, std::uint64_t i, PlyType type) {
        if (const std::optional<double> value = data_.next(type)) return *value;
        if (data_.bytes_left() > 8) fail(element, i, "a number is wanted");
        fail_short(element, "it ends in number " + std::to_string(i));
    }

    /// How many numbers of a list follow.
    std::uint64_t list_size(const PlyElement& element, std::uint64_t i, const PlyProperty& p) {
        const double count = number(element, i, *p.count_type);
        if (!(count >= 0 && count == std::floor(count))) fail(element, i, "the length of a list is a whole number");
        if (count > static_cast<double>(data_.bytes_left() + 1) / static_cast<double>(data_.least_bytes(p.type)))
            fail(element, i,
                 "is cut short: a list is longer than the " + std::to_string(data_.bytes_left()) +
                     " bytes that are left");
        return static_cast<std::uint64_t>(count);
    }

    void start_vertices(const PlyElement& element) {
        std::array<bool, slot_count + 1> has{};
        for (const PlyProperty& p : element.properties) has[slot_of(p.name)] = true;
        if (!has[x] || !has[y] || !has[z]) throw SceneFileError(path_ + ": its vertices have no x, y and z");
        const std::uint64_t count = scene_.positions_m.size() + element.count;
        if (count > std::numeric_limits<std::uint32_t>::max())
            throw SceneFileError(path_ + ": more than 4294967295 vertices");
        scene_.positions_m.reserve(count);
        has_normals_ = has[nx] && has[ny] && has[nz];
        has_uvs_ = has[u] && has[v];
    }

    void read_vertices(const PlyElement& element) {
        start_vertices(element);
        for (std::uint64_t i = 0; i < element.count; ++i) {
            checkpoint_.pass(element.properties.size());
            read_vertex(element, i);
        }
    }

    void read_vertex(const PlyElement& element, std::uint64_t i) {
        std::array<double, slot_count + 1> value{};
        for (const PlyProperty& p : element.properties) {
            if (p.count_type)
                skip_list(element, i, p);
            else
                value[slot_of(p.name)] = number(element, i, p.type);
        }
        const Vec3d p = {value[x], value[y], value[z]};
        if (!in_reach(scale_ * p)) fail(element, i, why_out_of_reach(p));
        scene_.positions_m.push_back(scale_ * p);
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

    void skip_list(const PlyElement& element, std::uint64_t i, const PlyProperty& p) {
        const std::uint64_t count = list_size(element, i, p);
        for (std::uint64_t k = 0; k < count; ++k) {
            checkpoint_.pass();
            number(element, i, p.type);
        }
    }

    void read_faces(const PlyElement& element) {
        const bool is_face = element.name == "face";
        if (is_face) scene_.triangles.reserve(scene_.triangles.size() + element.count);
        for (std::uint64_t i = 0; i < element.count; ++i) {
            checkpoint_.pass(element.properties.size());
            read_face(element, i, is_face);
        }
    }

    // Of a face, or of an element that is not read.
    void read_face(const PlyElement& element, std::uint64_t i, bool is_face) {
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

    void read_polygon(const PlyElement& element, std::uint64_t i, const PlyProperty& p) {
        const std::uint64_t count = list_size(element, i, p);
        std::uint32_t first = 0, before = 0;
        for (std::uint64_t k = 0; k < count; ++k) {
            checkpoint_.pass();
            const double index = number(element, i, p.type);
            if (!(index >= 0 && index < 4294967295.0 && index == std::floor(index)))
                fail(element, i, "an index is a whole number of at least 0");
            const auto vertex = static_cast<std::uint32_t>(index);
            // Nothing says that the vertices come first, so whether it exists is known at the end.
            if (vertex >= farthest_index_) farthest_index_ = vertex, farthest_face_ = i;
            if (k == 0) first = vertex;
            if (k >= 2) scene_.triangles.push_back({{first, before, vertex}, 0});
            before = vertex;
        }
    }

    void check_indices() const {
        if (scene_.triangles.empty() || farthest_index_ < scene_.positions_m.size()) return;
        throw SceneFileError(path_ + ": face " + std::to_string(farthest_face_) + ": index " +
                             std::to_string(farthest_index_) + " is not smaller than the number of vertices, " +
                             std::to_string(scene_.positions_m.size()));
    }

    Scene& scene_;
    const std::string& path_;
    double scale_;
    Checkpoint& checkpoint_;
    PlyData data_;
    std::uint32_t farthest_index_ = 0;
    std::uint64_t farthest_face_ = 0;
    bool has_normals_ = false, has_uvs_ = false;
    std::size_t bad_ = 0;
};

}  // namespace

std::string read_ply(Scene& scene, const std::string& path, double scale, Checkpoint& checkpoint) {
    return PlyReader(scene, path, scale, checkpoint).read();
}

}  // namespace realcam::io
