#include "ply_file.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "../../error.hpp"
#include "../../scene/scene_checks.hpp"
#include "../scene/decoded_image.hpp"
#include "../scene/scene_cleanup.hpp"
#include "../text/printable.hpp"
#include "ply_data.hpp"

namespace realcam::io {
namespace {

using namespace ply_detail;

/// Implementation of read_ply. `element`, `i`: kind and index of the element that is being read.
class PlyReader {
public:
    PlyReader(Scene& scene, const std::string& path, double scale, Checkpoint& checkpoint)
        : scene_(scene), path_(path), scale_(scale), checkpoint_(checkpoint), data_(path, checkpoint) {}

    /// Reads the file and returns the names of its textures.
    std::vector<std::string> read() {
        for (const PlyElement& element : data_.header().elements) {
            // An element without properties occupies no bytes, whatever its count.
            if (element.properties.empty()) continue;
            check_declared_size(element);
            if (element.name == "vertex")
                read_vertices(element);
            else if (element.name == "tristrips")
                read_strips(element);
            else
                read_faces(element);
        }
        check_indices();
        apply_corners(scene_, corners_, checkpoint_);
        const std::string warning = decode_vertex_colours(scene_.colors);
        if (!warning.empty()) scene_.warnings.push_back(path_ + ": " + warning);
        const std::uint32_t group = scene_.normals.empty() ? kSmoothByAngle : kFlat;
        clean_geometry(scene_, {std::vector<std::uint32_t>(scene_.triangles.size(), group), {}}, path_, checkpoint_);
        warn_count(scene_, path_, bad_, "normals or texture coordinates are not finite, and are read as 0");
        warn_count(scene_, path_, bad_texcoords_,
                   "faces have texture coordinates that are not two for each corner, and are read as 0");
        return data_.header().textures;
    }

private:
    [[noreturn]] void fail(const PlyElement& element, std::uint64_t i, const std::string& message) const {
        throw SceneFileError(path_ + ": " + printable(element.name).substr(0, 60) + " " + std::to_string(i) + ": " +
                             message);
    }
    /// Throws for a file that ends too early. `fact`: end of the sentence.
    [[noreturn]] void fail_short(const PlyElement& element, const std::string& fact) const {
        throw SceneFileError(path_ + ": is cut short: its header promises " + std::to_string(element.count) + " of " +
                             in_quotes(element.name) + ", and " + fact);
    }

    /// Throws if the file is too short for the declared number of elements, before memory is allocated for them. The
    /// last number of an ASCII file needs no blank behind it.
    void check_declared_size(const PlyElement& element) const {
        std::uint64_t min_bytes = 0;
        for (const PlyProperty& p : element.properties) min_bytes += data_.min_bytes(p.count_type.value_or(p.type));
        if (element.count > (data_.bytes_left() + 1) / min_bytes)
            fail_short(element, "has " + std::to_string(data_.bytes_left()) + " bytes for them");
    }

    /// Reads the next number.
    double next_number(const PlyElement& element, std::uint64_t i, PlyType type) {
        if (const std::optional<double> value = data_.next(type)) return *value;
        if (data_.bytes_left() > 8) fail(element, i, "expected a number");
        fail_short(element, "it ends in number " + std::to_string(i));
    }

    /// Reads the length of a list.
    std::uint64_t list_size(const PlyElement& element, std::uint64_t i, const PlyProperty& p) {
        const double count = next_number(element, i, *p.count_type);
        if (!(count >= 0 && count == std::floor(count)))
            fail(element, i, "the length of a list must be a whole number");
        if (count > static_cast<double>(data_.bytes_left() + 1) / static_cast<double>(data_.min_bytes(p.type)))
            fail(element, i,
                 "is cut short: a list is longer than the " + std::to_string(data_.bytes_left()) +
                     " bytes that are left");
        return static_cast<std::uint64_t>(count);
    }

    /// Checks the properties of vertices and reserves memory for them.
    void start_vertices(const PlyElement& element) {
        const auto has = slots_of(element);
        if (!has[x] || !has[y] || !has[z]) throw SceneFileError(path_ + ": its vertices have no x, y and z");
        const std::uint64_t count = scene_.positions_m.size() + element.count;
        if (count > std::numeric_limits<std::uint32_t>::max())
            throw SceneFileError(path_ + ": more than 4294967295 vertices");
        scene_.positions_m.reserve(count);
        has_normals_ = has[nx] && has[ny] && has[nz];
        has_uvs_ = has[u] && has[v];
        has_colours_ = has_colour(has);
        has_alpha_ = has[alpha];
        if (has_colours_) scene_.colors.reserve(count);
    }

    void read_vertices(const PlyElement& element) {
        start_vertices(element);
        for (std::uint64_t i = 0; i < element.count; ++i) {
            checkpoint_.pass(element.properties.size());
            read_vertex(element, i);
        }
    }

    void read_vertex(const PlyElement& element, std::uint64_t i) {
        PlyNumbers value{};
        for (const PlyProperty& p : element.properties) {
            if (p.count_type)
                skip_list(element, i, p);
            else
                read_number(element, i, p, value);
        }
        const Vec3d p = {value[x], value[y], value[z]};
        if (!in_reach(scale_ * p)) fail(element, i, coordinates_error(p));
        scene_.positions_m.push_back(scale_ * p);
        if (has_normals_) scene_.normals.push_back(normal({value[nx], value[ny], value[nz]}));
        if (has_uvs_) scene_.uvs.push_back(uv(value[u], value[v]));
        if (has_colours_) scene_.colors.push_back(colour_of(value, has_alpha_));
    }

    /// Reads a property into its slot.
    void read_number(const PlyElement& element, std::uint64_t i, const PlyProperty& p, PlyNumbers& value) {
        const PlySlot slot = slot_of(p.name);
        value[slot] = value_of(slot, p.type, next_number(element, i, p.type));
    }

    /// Returns texture coordinates; (0, 0), with a warning, if they are not finite.
    Vec2f uv(double u, double v) {
        const Vec2f out = {static_cast<float>(u), static_cast<float>(v)};
        if (std::isfinite(out.x) && std::isfinite(out.y)) return out;
        ++bad_;
        return {0, 0};
    }

    /// Returns a normal, unit; (0, 0, 0), with a warning, if it is not finite.
    Vec3f normal(Vec3d n) {
        const double size = length(n);
        if (!std::isfinite(size)) ++bad_;
        return size > 0 && std::isfinite(size) ? static_cast<Vec3f>((1 / size) * n) : Vec3f{0, 0, 0};
    }

    void skip_list(const PlyElement& element, std::uint64_t i, const PlyProperty& p) {
        const std::uint64_t count = list_size(element, i, p);
        for (std::uint64_t k = 0; k < count; ++k) {
            checkpoint_.pass();
            next_number(element, i, p.type);
        }
    }

    /// Reads faces, or skips other elements.
    void read_faces(const PlyElement& element) {
        const bool is_face = element.name == "face";
        if (is_face) start_faces(element);
        for (std::uint64_t i = 0; i < element.count; ++i) {
            checkpoint_.pass(element.properties.size());
            if (is_face)
                read_face(element, i);
            else
                skip(element, i);
        }
    }

    /// Finds the properties of faces and reserves memory for their triangles.
    void start_faces(const PlyElement& element) {
        scene_.triangles.reserve(scene_.triangles.size() + element.count);
        const auto has = slots_of(element);
        faces_have_colours_ = has_colour(has);
        faces_have_alpha_ = has[alpha];
        faces_have_uvs_ = std::any_of(element.properties.begin(), element.properties.end(),
                                      [](const PlyProperty& p) { return p.count_type && p.name == "texcoord"; });
    }

    void skip(const PlyElement& element, std::uint64_t i) {
        for (const PlyProperty& p : element.properties) {
            if (p.count_type)
                skip_list(element, i, p);
            else
                next_number(element, i, p.type);
        }
    }

    /// True for the list of a face's vertex indices.
    static bool has_indices(const PlyProperty& p) {
        return p.count_type && (p.name == "vertex_indices" || p.name == "vertex_index");
    }

    void read_face(const PlyElement& element, std::uint64_t i) {
        indices_.clear();
        texcoords_.clear();
        PlyNumbers value{};
        double texture = 0;  // without texnumber, all faces have the first texture
        for (const PlyProperty& p : element.properties) {
            if (has_indices(p))
                read_indices(element, i, p, 0);
            else if (p.count_type && p.name == "texcoord")
                read_texcoords(element, i, p);
            else if (p.count_type)
                skip_list(element, i, p);
            else if (p.name == "texnumber")
                texture = next_number(element, i, p.type);
            else
                read_number(element, i, p, value);
        }
        add_polygon(material_of(texture), colour_of(value, faces_have_alpha_));
    }

    /// Returns the material index of a texture's index (read_ply).
    std::uint32_t material_of(double texture) const {
        const std::size_t count = data_.header().textures.size();
        const bool exists = texture >= 0 && texture < static_cast<double>(count);
        return static_cast<std::uint32_t>(exists ? static_cast<std::size_t>(texture) : count);
    }

    /// Reads a list of vertex indices, each at least `min_index`, into indices_; -1 becomes kNoVertex.
    void read_indices(const PlyElement& element, std::uint64_t i, const PlyProperty& p, double min_index) {
        const std::uint64_t count = list_size(element, i, p);
        for (std::uint64_t k = 0; k < count; ++k) {
            checkpoint_.pass();
            const double index = next_number(element, i, p.type);
            if (!(index >= min_index && index < 4294967295.0 && index == std::floor(index)))
                fail(element, i,
                     "an index must be a whole number of at least " + std::to_string(static_cast<int>(min_index)));
            // The vertices may follow in the file: check_indices compares their number with the largest index.
            if (index >= static_cast<double>(largest_index_))
                largest_index_ = static_cast<std::uint32_t>(index), largest_index_face_ = i;
            indices_.push_back(index < 0 ? kNoVertex : static_cast<std::uint32_t>(index));
        }
    }

    void read_texcoords(const PlyElement& element, std::uint64_t i, const PlyProperty& p) {
        const std::uint64_t count = list_size(element, i, p);
        for (std::uint64_t k = 0; k < count; ++k) {
            checkpoint_.pass();
            texcoords_.push_back(next_number(element, i, p.type));
        }
    }

    /// Adds the polygon of indices_ and texcoords_ as a fan of triangles.
    void add_polygon(std::uint32_t material, const VertexColor& colour) {
        const bool has_uvs = texcoords_.size() == 2 * indices_.size();
        if (faces_have_uvs_ && !has_uvs && !texcoords_.empty()) ++bad_texcoords_;
        for (std::size_t k = 2; k < indices_.size(); ++k) {
            scene_.triangles.push_back({{indices_[0], indices_[k - 1], indices_[k]}, material});
            if (faces_have_colours_) corners_.colours.push_back(colour);
            if (!faces_have_uvs_) continue;
            for (const std::size_t corner : {std::size_t{0}, k - 1, k})
                corners_.uvs.push_back(has_uvs ? uv(texcoords_[2 * corner], texcoords_[2 * corner + 1]) : Vec2f{0, 0});
        }
    }

    /// Reads triangle strips. Each vertex from the third on makes a triangle with the two before it, with alternating
    /// orientation; -1 begins a new strip.
    void read_strips(const PlyElement& element) {
        for (std::uint64_t i = 0; i < element.count; ++i) {
            checkpoint_.pass(element.properties.size());
            indices_.clear();
            for (const PlyProperty& p : element.properties) {
                if (has_indices(p))
                    read_indices(element, i, p, -1);
                else if (p.count_type)
                    skip_list(element, i, p);
                else
                    next_number(element, i, p.type);
            }
            add_strips();
        }
    }

    /// Adds the triangles of the strips in indices_.
    void add_strips() {
        std::size_t first = 0;
        for (std::size_t k = 0; k < indices_.size(); ++k) {
            if (indices_[k] == kNoVertex) {
                first = k + 1;
            } else if (k >= first + 2) {
                const bool is_reversed = (k - first) % 2 == 1;
                const std::uint32_t a = indices_[is_reversed ? k - 1 : k - 2],
                                    b = indices_[is_reversed ? k - 2 : k - 1];
                scene_.triangles.push_back({{a, b, indices_[k]}, material_of(0)});
                if (!corners_.colours.empty()) corners_.colours.emplace_back();
                if (!corners_.uvs.empty()) corners_.uvs.resize(corners_.uvs.size() + 3, Vec2f{0, 0});
            }
        }
    }

    /// Throws if a face refers to a vertex that does not exist.
    void check_indices() const {
        if (scene_.triangles.empty() || largest_index_ < scene_.positions_m.size()) return;
        throw SceneFileError(path_ + ": face " + std::to_string(largest_index_face_) + ": index " +
                             std::to_string(largest_index_) + " is not smaller than the number of vertices, " +
                             std::to_string(scene_.positions_m.size()));
    }

    Scene& scene_;
    const std::string& path_;
    double scale_;
    Checkpoint& checkpoint_;
    PlyData data_;
    static constexpr std::uint32_t kNoVertex = 0xffffffffu;

    std::uint32_t largest_index_ = 0;
    std::uint64_t largest_index_face_ = 0;  // face with that index
    bool has_normals_ = false, has_uvs_ = false, has_colours_ = false, has_alpha_ = false;
    bool faces_have_colours_ = false, faces_have_alpha_ = false, faces_have_uvs_ = false;
    std::vector<std::uint32_t> indices_;  // of the current face or strip
    std::vector<double> texcoords_;  // of the current face, two for each corner
    PlyCorners corners_;
    std::size_t bad_ = 0, bad_texcoords_ = 0;  // counts for warnings
};

}  // namespace

std::vector<std::string> read_ply(Scene& scene, const std::string& path, double scale, Checkpoint& checkpoint) {
    return PlyReader(scene, path, scale, checkpoint).read();
}

}  // namespace realcam::io
