#include "obj_file.hpp"

#include <algorithm>
#include <bit>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

#include "../../error.hpp"
#include "../files/regular_file.hpp"
#include "../files/uri.hpp"
#include "../scene/decoded_image.hpp"
#include "../scene/scene_cleanup.hpp"
#include "../text/printable.hpp"
#include "../text/text_lines.hpp"
#include "mtl_file.hpp"
#include "obj_data.hpp"
#include "triangulate_polygon.hpp"

namespace realcam::io {
namespace {

/// Assigns indices to the distinct corners of an OBJ: a position may have several normals and texture coordinates.
class CornerTable {
public:
    struct Corner {
        std::uint32_t position, uv, normal;
        bool operator==(const Corner&) const = default;
    };

    /// Returns the index of a corner, adding it on first use.
    std::uint32_t index_of(const Corner& corner) {
        if (2 * corners_.size() >= table_.size()) grow();
        std::uint32_t& slot = table_[slot_of(corner)];
        if (slot == kEmpty) {
            slot = static_cast<std::uint32_t>(corners_.size());
            corners_.push_back(corner);
        }
        return slot;
    }
    const std::vector<Corner>& corners() const { return corners_; }

private:
    static constexpr std::uint32_t kEmpty = 0xffffffffu;

    /// Returns the slot that holds a corner, or the empty slot for it.
    std::size_t slot_of(const Corner& c) const {
        std::uint64_t hash = c.position * 0x9e3779b97f4a7c15ull;
        hash = (hash ^ hash >> 29 ^ c.uv) * 0xbf58476d1ce4e5b9ull;
        hash = (hash ^ hash >> 32 ^ c.normal) * 0x94d049bb133111ebull;
        std::size_t slot = (hash ^ hash >> 31) & (table_.size() - 1);
        while (table_[slot] != kEmpty && corners_[table_[slot]] != c) slot = (slot + 1) & (table_.size() - 1);
        return slot;
    }
    void grow() {
        table_.assign(std::max<std::size_t>(1024, 2 * table_.size()), kEmpty);
        for (std::uint32_t i = 0; i < corners_.size(); ++i) table_[slot_of(corners_[i])] = i;
    }

    std::vector<Corner> corners_;
    std::vector<std::uint32_t> table_;  // hash table of indices in corners_; its size is a power of two
};

/// Implementation of read_obj.
class ObjAssembler {
public:
    ObjAssembler(const std::string& path, ObjData data, Checkpoint& checkpoint)
        : data_(std::move(data)), checkpoint_(checkpoint) {
        scene_.path = path;
        scene_.smooths_by_angle = true;
        scene_.vertices.resize(1);
    }

    FileScene assemble() {
        read_libraries();
        find_materials();
        add_nodes();
        add_triangles();
        add_vertices();
        warn(data_.short_faces, "faces have fewer than three corners; they are left out");
        warn(tangled_, "polygons cross themselves in too many points; they are triangulated as if they were convex");
        return std::move(scene_);
    }

private:
    void warn(std::size_t count, const std::string& problem) {
        if (count > 0) scene_.warnings.push_back(std::to_string(count) + ' ' + problem);
    }

    /// Reads the material libraries. A line may name several files, or one with blanks in its name.
    void read_libraries() {
        std::set<std::string> read;
        for (const std::string& line : data_.libraries) {
            if (find_beside(scene_.path, line)) {
                read_library(line, read);
                continue;
            }
            std::string_view names = line;
            while (!names.empty()) read_library(std::string(consume_word(names)), read);
        }
    }

    /// Reads an MTL file, unless it is in `read`, the set of paths that have been read.
    void read_library(const std::string& name, std::set<std::string>& read) {
        std::optional<std::string> file = find_beside(scene_.path, name);
        if (!file) {
            // A library that was renamed together with its OBJ has the OBJ's name, although the OBJ still refers to the
            // library's old name.
            const std::string renamed = scene_.path.substr(0, scene_.path.rfind('.')) + ".mtl";
            scene_.warnings.push_back("mtllib " + in_quotes(name) + ": no such file beside the scene");
            file = find_beside(renamed, renamed.substr(renamed.rfind('/') + 1));
        }
        if (!file || !read.insert(*file).second) return;
        try {
            read_mtl(scene_, *file, checkpoint_);
        } catch (const FileError& error) {
            scene_.warnings.push_back("mtllib " + in_quotes(name) + ": " + error.reason);
        }
    }

    /// Sets material_indices_, with a warning for names without a material.
    void find_materials() {
        std::map<std::string, std::uint32_t> indices;
        for (std::uint32_t i = 0; i < scene_.materials.size(); ++i) indices.emplace(scene_.materials[i].name, i);
        std::vector<std::string> unknown;
        for (const std::string& name : data_.materials) {
            const auto found = indices.find(name);
            material_indices_.push_back(found == indices.end() ? default_material() : found->second);
            if (found == indices.end()) unknown.push_back(name);
        }
        if (unknown.empty()) return;
        scene_.warnings.push_back(
            "no MTL file has the material " + in_quotes(unknown[0]) +
            (unknown.size() > 1 ? ", nor " + std::to_string(unknown.size() - 1) + " others" : "") +
            "; the default material is used");
    }

    /// Returns the index of the material for faces without one, adding it on first use.
    std::uint32_t default_material() {
        if (!default_material_) {
            default_material_ = static_cast<std::uint32_t>(scene_.materials.size());
            scene_.materials.emplace_back();
            scene_.materials.back().is_white = !data_.colours.empty();
        }
        return *default_material_;
    }

    /// Adds one node and one mesh for each group, in the order of the file.
    void add_nodes() {
        const auto count = static_cast<std::uint32_t>(data_.groups.size());
        scene_.meshes.resize(count);
        for (std::uint32_t g = 0; g < count; ++g) {
            scene_.meshes[g].label = "group " + in_quotes(data_.groups[g]);
            scene_.nodes.push_back({data_.groups[g], {}, kNoParent, g + 1, g, 1});
        }
    }

    void add_triangles() {
        const bool has_plain_corners = data_.corner_uvs.empty() && data_.corner_normals.empty();
        std::uint32_t corner = 0;
        for (std::size_t r = 0; r < data_.runs.size(); ++r) {
            const ObjData::Run& run = data_.runs[r];
            const std::size_t end = r + 1 < data_.runs.size() ? data_.runs[r + 1].first_face : data_.face_ends.size();
            const std::uint32_t material =
                run.material == ObjData::kNone ? default_material() : material_indices_[run.material];
            FileMesh& mesh = scene_.meshes[run.group];
            std::vector<Triangle>& triangles = mesh.triangles;
            if (data_.runs.size() == 1) triangles.reserve(data_.face_ends.size());
            for (std::size_t f = run.first_face; f < end; ++f) {
                add_face(triangles, corner, data_.face_ends[f], material, has_plain_corners);
                corner = data_.face_ends[f];
                checkpoint_.pass();
            }
            if (data_.has_smoothing) mesh.smoothing.resize(triangles.size(), run.smoothing);
        }
    }

    /// Triangulates a face: corners `first` to `end` - 1 of data_. `has_plain_corners`: corners have only positions.
    void add_face(std::vector<Triangle>& triangles, std::uint32_t first, std::uint32_t end, std::uint32_t material,
                  bool has_plain_corners) {
        const std::uint32_t* positions = data_.corner_positions.data() + first;
        vertices_.assign(positions, positions + (end - first));
        pieces_.clear();
        if (end - first == 3) {
            pieces_.push_back({0, 1, 2});
        } else {
            polygon_.clear();
            for (const std::uint32_t p : vertices_) polygon_.push_back(data_.positions[p]);
            if (!triangulate_polygon(polygon_, pieces_, checkpoint_)) ++tangled_;
        }
        if (!has_plain_corners)
            for (std::uint32_t c = first; c < end; ++c) vertices_[c - first] = corners_.index_of(corner(c));
        for (const PolygonTriangle& piece : pieces_)
            triangles.push_back({{vertices_[piece[0]], vertices_[piece[1]], vertices_[piece[2]]}, material});
    }

    CornerTable::Corner corner(std::uint32_t c) const {
        return {data_.corner_positions[c], data_.corner_uvs.empty() ? ObjData::kNone : data_.corner_uvs[c],
                data_.corner_normals.empty() ? ObjData::kNone : data_.corner_normals[c]};
    }

    void add_vertices() {
        FileVertices& out = scene_.vertices[0];
        if (const std::string warning = decode_vertex_colours(data_.colours); !warning.empty())
            scene_.warnings.push_back(warning);
        // If corners have only positions, their indices are those of the positions.
        if (corners_.corners().empty()) {
            out.positions = std::move(data_.positions);
            out.colours = std::move(data_.colours);
            if (data_.has_smoothing) {
                out.position_ids.resize(out.positions.size());
                std::iota(out.position_ids.begin(), out.position_ids.end(), 0u);
            }
            return;
        }
        const bool has_uvs = !data_.corner_uvs.empty(), has_normals = !data_.corner_normals.empty();
        data_.corner_positions = data_.corner_uvs = data_.corner_normals = {};
        for (const CornerTable::Corner& c : corners_.corners()) {
            checkpoint_.pass();
            out.positions.push_back(data_.positions[c.position]);
            if (!data_.colours.empty()) out.colours.push_back(data_.colours[c.position]);
            if (data_.has_smoothing) out.position_ids.push_back(c.position);
            if (has_uvs) out.uvs.push_back(c.uv == ObjData::kNone ? Vec2f{0, 0} : data_.uvs[c.uv]);
            if (has_normals)
                out.normals.push_back(c.normal == ObjData::kNone ? Vec3f{0, 0, 0} : data_.normals[c.normal]);
        }
    }

    ObjData data_;
    Checkpoint& checkpoint_;
    FileScene scene_;
    CornerTable corners_;
    std::vector<std::uint32_t> material_indices_;  // index in scene_.materials of each of data_.materials
    std::optional<std::uint32_t> default_material_;
    std::size_t tangled_ = 0;
    // Scratch memory for the current face.
    std::vector<std::uint32_t> vertices_;  // indices of its corners' vertices in the scene
    std::vector<PolygonTriangle> pieces_;  // its triangles
    std::vector<Vec3d> polygon_;  // its corners
};

}  // namespace

FileScene read_obj(const std::string& path, double scale, Checkpoint& checkpoint) {
    return ObjAssembler(path, read_obj_data(path, scale, checkpoint), checkpoint).assemble();
}

}  // namespace realcam::io
