#include "scene_geometry.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <utility>

#include "../../error.hpp"
#include "../../scene/scene_checks.hpp"
#include "../files/regular_file.hpp"
#include "../text/printable.hpp"
#include "scene_cleanup.hpp"

namespace realcam::io {
namespace {

constexpr std::uint32_t kUnset = 0xffffffffu;

/// False for (0, 0, 0), which stands for a vertex without a normal.
bool has_normal(Vec3f n) {
    return n.x != 0 || n.y != 0 || n.z != 0;
}

/// Implementation of read_geometry.
class Flattener {
public:
    Flattener(Scene& scene, const ScenePart& part, const LeftOutFunction& leaves_out,
              std::vector<VertexSource>* sources)
        : scene_(scene), part_(part), file_(part.file), leaves_out_(leaves_out), sources_(sources) {
        for (const FileMesh& mesh : file_.meshes) {
            any_normals_ |= !vertices_of(mesh).normals.empty();
            any_second_uvs_ |= !vertices_of(mesh).second_uvs.empty();
            any_uvs_ |= any_second_uvs_ || !vertices_of(mesh).uvs.empty();
            any_colours_ |= !vertices_of(mesh).colours.empty();
            any_position_ids_ |= !vertices_of(mesh).position_ids.empty();
        }
    }

    void flatten() {
        reserve_memory();
        for_each_mesh([&](const FileMesh& mesh, const Affine<double>& transform) { add_mesh(mesh, transform); });
        if (!sources_ && (!left_out_ || !scene_.triangles.empty()))
            clean_geometry(scene_, std::move(smoothing_), file_.path, part_.checkpoint);
        warn_count(scene_, file_.path, bad_normals_, "normals are not finite; their faces are flat there");
        warn_count(scene_, file_.path, bad_uvs_, "texture coordinates are not finite, and are read as 0");
        warn_count(scene_, file_.path, without_uvs_, "meshes have a texture, but no texture coordinates for it");
    }

private:
    const FileVertices& vertices_of(const FileMesh& mesh) const { return file_.vertices[mesh.vertices]; }

    /// Calls use(mesh, transform) for the meshes of all nodes that are not left out.
    template <class Use>
    void for_each_mesh(Use&& use) {
        visit_nodes(part_, [&](std::uint32_t index, const Affine<double>& transform) {
            const LeftOut left_out = leaves_out_(index, transform);
            left_out_ |= left_out != LeftOut::nothing;
            const FileNode& node = file_.nodes[index];
            for (std::uint32_t i = 0; left_out == LeftOut::nothing && i < node.mesh_count; ++i)
                use(file_.meshes[node.first_mesh + i], transform);
            return left_out != LeftOut::all;
        });
    }

    /// Reserves memory for all meshes at once: growing step by step would take twice as much. Throws SceneFileError if
    /// there is too little.
    void reserve_memory() {
        std::size_t vertices = 0, triangles = 0;
        for_each_mesh([&](const FileMesh& mesh, const Affine<double>&) {
            triangles += mesh.triangles.size();
            vertices += std::min(vertices_of(mesh).positions.size(), 3 * mesh.triangles.size());
        });
        const std::size_t per_vertex = sizeof(Vec3d) + any_normals_ * sizeof(Vec3f) +
                                       (any_uvs_ + any_second_uvs_) * sizeof(Vec2f) +
                                       any_colours_ * sizeof(VertexColor);
        const std::size_t bytes = vertices * per_vertex + triangles * (sizeof(Triangle) + sizeof(std::uint32_t));
        constexpr std::size_t kUncheckedBytes = 1 << 24;
        const std::string why = bytes > kUncheckedBytes ? too_much_memory(bytes) : std::string();
        if (!why.empty()) throw SceneFileError(file_.path + ": its triangles need " + why);
        if (std::max(vertices, triangles) >= kUnset)
            throw SceneFileError(file_.path + ": more than 4294967294 vertices or triangles");
        scene_.positions_m.reserve(vertices);
        if (any_normals_) scene_.normals.reserve(vertices);
        if (any_uvs_) scene_.uvs.reserve(vertices);
        if (any_second_uvs_) scene_.second_uvs.reserve(vertices);
        if (any_colours_) scene_.colors.reserve(vertices);
        scene_.triangles.reserve(triangles);
        smoothing_.groups.reserve(triangles);
    }

    /// Adds a mesh. `transform`: to scene space, in units of the file.
    void add_mesh(const FileMesh& mesh, const Affine<double>& transform) {
        const FileVertices& vertices = vertices_of(mesh);
        if (new_indices_.size() < vertices.positions.size()) new_indices_.resize(vertices.positions.size(), kUnset);
        const bool is_textured = add_triangles(mesh, transform);
        const bool has_two_sets =
            !mesh.triangles.empty() && file_.materials[mesh.triangles.front().material].uv_sets().size() > 1;
        without_uvs_ += (is_textured && vertices.uvs.empty()) || (has_two_sets && vertices.second_uvs.empty());
    }

    /// Adds the triangles of a mesh. Returns true if any of them has a texture.
    bool add_triangles(const FileMesh& mesh, const Affine<double>& transform) {
        const bool mirrored = transform.determinant() < 0;
        bool is_textured = false;
        for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
            const Triangle& from = mesh.triangles[i];
            part_.checkpoint.pass();
            Triangle t{{0, 0, 0}, from.material};
            for (int corner = 0; corner < 3; ++corner)
                t.vertices[corner] = vertex(mesh, from.vertices[corner], transform);
            const bool has_normals = any_normals_ && (has_normal(scene_.normals[t.vertices[0]]) ||
                                                      has_normal(scene_.normals[t.vertices[1]]) ||
                                                      has_normal(scene_.normals[t.vertices[2]]));
            if (mirrored) std::swap(t.vertices[1], t.vertices[2]);
            scene_.triangles.push_back(t);
            const std::uint32_t group = !mesh.smoothing.empty()  ? mesh.smoothing[i]
                                        : file_.smooths_by_angle ? kSmoothByAngle
                                                                 : kFlat;
            smoothing_.groups.push_back(has_normals ? kFlat : group);
            is_textured |= bool(file_.materials[from.material].colour_texture());
        }
        // The next use of these vertices has another transform.
        for (const Triangle& t : mesh.triangles)
            for (const std::uint32_t v : t.vertices) new_indices_[v] = kUnset;
        return is_textured;
    }

    /// Returns the index in scene_ of a vertex of the current mesh, adding it on first use. Throws SceneFileError if it
    /// is too far away (in_reach).
    std::uint32_t vertex(const FileMesh& mesh, std::uint32_t index, const Affine<double>& transform) {
        std::uint32_t& known = new_indices_[index];
        if (known != kUnset) return known;
        const FileVertices& from = vertices_of(mesh);
        const Vec3d p = part_.scale * transform.point(from.positions[index]);
        if (!in_reach(p))
            throw SceneFileError(file_.path + ": " + mesh.label + ": vertex " + std::to_string(index) + ": " +
                                 coordinates_error(p));
        known = static_cast<std::uint32_t>(scene_.positions_m.size());
        scene_.positions_m.push_back(p);
        if (sources_) sources_->push_back({mesh.vertices, index});
        if (any_normals_)
            scene_.normals.push_back(from.normals.empty() ? Vec3f{0, 0, 0} : normal(from.normals[index], transform));
        if (any_uvs_) scene_.uvs.push_back(from.uvs.empty() ? Vec2f{0, 0} : uv(from.uvs[index]));
        if (any_second_uvs_)
            scene_.second_uvs.push_back(from.second_uvs.empty() ? Vec2f{0, 0} : uv(from.second_uvs[index]));
        if (any_colours_) scene_.colors.push_back(from.colours.empty() ? VertexColor{} : from.colours[index]);
        if (any_position_ids_)
            smoothing_.position_ids.push_back(from.position_ids.empty() ? index : from.position_ids[index]);
        return known;
    }

    /// Returns a transformed normal, unit; (0, 0, 0), with a warning, if it is not finite.
    Vec3f normal(Vec3f from, const Affine<double>& transform) {
        if (!std::isfinite(from.x + from.y + from.z)) {
            ++bad_normals_;
            return {0, 0, 0};
        }
        const Vec3d n = transform.normal(static_cast<Vec3d>(from));
        const double size = length(n);
        return size > 0 && std::isfinite(size) ? static_cast<Vec3f>((1 / size) * n) : Vec3f{0, 0, 0};
    }

    /// Returns texture coordinates; (0, 0), with a warning, if they are not finite.
    Vec2f uv(Vec2f from) {
        if (std::isfinite(from.x) && std::isfinite(from.y)) return from;
        ++bad_uvs_;
        return {0, 0};
    }

    Scene& scene_;
    const ScenePart& part_;
    const FileScene& file_;
    const LeftOutFunction& leaves_out_;
    std::vector<VertexSource>* sources_;
    bool left_out_ = false;  // anything was left out
    bool any_normals_ = false, any_uvs_ = false, any_second_uvs_ = false, any_colours_ = false,
         any_position_ids_ = false;
    Smoothing smoothing_;
    std::vector<std::uint32_t> new_indices_;  // index in scene_ of each vertex of the current mesh
    std::size_t bad_normals_ = 0, bad_uvs_ = 0, without_uvs_ = 0;
};

}  // namespace

void read_geometry(Scene& scene, const ScenePart& part, const LeftOutFunction& leaves_out,
                   std::vector<VertexSource>* sources) {
    Flattener(scene, part, leaves_out, sources).flatten();
}

namespace {

Color color_of(Vec3d v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

/// Adds a light of KHR_lights_punctual, or a warning, which begins with `label`, if its type is unknown. A light emits
/// from its node's origin along -z. The extension's `range` is not physical and is ignored. `scale`: metres per unit.
void add_light(Scene& scene, const FileLight& light, const Affine<double>& transform, const std::string& label,
               double scale) {
    if (light.type == "directional") {
        const Vec3d d = -transform.z;
        if (length(d) > 0) scene.suns.push_back({static_cast<Vec3f>(normalized(d)), color_of(light.strength)});
        return;
    }
    if (light.type == "point") {
        scene.points.push_back({scale * transform.origin, color_of(light.strength)});
    } else if (light.type == "spot") {
        const Vec3d axis = -transform.z;
        if (length(axis) > 0)
            scene.points.push_back({scale * transform.origin, color_of(light.strength), normalized(axis),
                                    light.inner_cone_angle, light.outer_cone_angle});
    } else {
        scene.warnings.push_back(label + ": expected point, directional or spot, not " + in_quotes(light.type));
    }
}

}  // namespace

void read_lights(Scene& scene, const ScenePart& part, const LeftOutFunction& leaves_out) {
    const FileScene& file = part.file;
    if (file.lights.empty()) return;
    visit_nodes(part, [&](std::uint32_t index, const Affine<double>& transform) {
        if (leaves_out(index, transform) == LeftOut::all) return false;
        const std::int32_t light = file.nodes[index].light;
        if (light >= 0)
            add_light(scene, file.lights[static_cast<std::size_t>(light)], transform,
                      file.path + ": light " + std::to_string(light), part.scale);
        return true;
    });
}

}  // namespace realcam::io
