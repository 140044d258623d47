#include "scene_cleanup.hpp"

#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>

#include "../../error.hpp"
#include "../../scene/scene_checks.hpp"
#include "vertex_welding.hpp"

namespace realcam::io {

void warn_count(Scene& scene, const std::string& path, std::size_t n, const std::string& what) {
    if (n > 0) scene.warnings.push_back(path + ": " + std::to_string(n) + " " + what);
}

void clean_geometry(Scene& scene, Smoothing smoothing, const std::string& path, Checkpoint& checkpoint) {
    if (scene.triangles.empty()) {
        throw SceneFileError(path + ": holds no triangles" +
                             (scene.positions_m.empty() ? "" : ", only points or lines"));
    }
    // Like drop_degenerate_triangles, but keeps the smoothing groups in step.
    std::size_t kept = 0;
    bool any_smooth = false;
    for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
        checkpoint.pass();
        if (is_degenerate(scene, scene.triangles[t])) continue;
        any_smooth |= smoothing.groups[t] != kFlat;
        smoothing.groups[kept] = smoothing.groups[t];
        scene.triangles[kept++] = scene.triangles[t];
    }
    const std::size_t dropped = scene.triangles.size() - kept;
    scene.triangles.resize(kept);
    smoothing.groups.resize(kept);
    if (kept == 0) throw SceneFileError(path + ": all of its triangles are without area");
    warn_count(scene, path, dropped, dropped == 1 ? "triangle without area dropped" : "triangles without area dropped");

    if (any_smooth) smooth_normals(scene, smoothing, checkpoint);
    weld_vertices(scene, checkpoint);
}

namespace {

constexpr double cos_crease = 0.70710678118654752;

// The work grows with the square of the number of faces at a vertex. The hub of such a wide fan is nearly flat and gets
// no normal.
constexpr std::size_t most_faces = 512;

double angle_between(Vec3d a, Vec3d b) {
    return std::atan2(length(cross(a, b)), dot(a, b));
}

/// Computes normals one position at a time: it stores only the faces at the current position, because data of all faces
/// would need more memory than anything else in a scene of ten million.
class Smoother {
public:
    Smoother(Scene& scene, const Smoothing& smoothing, Checkpoint& checkpoint)
        : scene_(scene), smoothing_(smoothing), checkpoint_(checkpoint) {}

    void smooth() {
        if (scene_.normals.empty()) scene_.normals.assign(scene_.positions_m.size(), Vec3f{0, 0, 0});
        sort_corners();
        find_vertices_to_keep();
        for (std::size_t position = 0; position + 1 < begin_.size(); ++position) {
            const std::size_t count = begin_[position + 1] - begin_[position];
            checkpoint_.pass(1 + 8 * count);
            if (count > 0 && count <= most_faces) smooth_position(begin_[position], begin_[position + 1]);
        }
    }

private:
    /// Triangle corner at the current position.
    struct Corner {
        std::uint32_t* vertex;
        Vec3d face_normal;
        double angle;
        std::uint32_t group;
    };
    /// Vertex made for the current position.
    struct Made {
        std::uint32_t source, vertex;
        Vec3f normal;
    };

    /// Sorts corners by position: begin_[p] .. begin_[p + 1] of sorted_ are the corners at the position of vertex p,
    /// the first of the equal ones. The index of a corner is 3 times that of its triangle, plus 0 to 2.
    void sort_corners() {
        if (scene_.triangles.size() > 0xffffffffu / 3) throw InputError("more than 1431655765 triangles");
        const std::vector<std::uint32_t> first = first_at_position();
        begin_.assign(scene_.positions_m.size() + 1, 0);
        for_each_corner([&](std::uint32_t, std::uint32_t vertex) { ++begin_[first[vertex] + 1]; });
        std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
        sorted_.resize(begin_.back());
        // Filling advances each beginning to its end, which is the beginning of the next.
        for_each_corner([&](std::uint32_t corner, std::uint32_t vertex) { sorted_[begin_[first[vertex]]++] = corner; });
        for (std::size_t p = begin_.size() - 1; p > 0; --p) begin_[p] = begin_[p - 1];
        begin_[0] = 0;
    }

    std::vector<std::uint32_t> first_at_position() {
        const std::vector<std::uint32_t>& position_ids = smoothing_.position_ids;
        if (!position_ids.empty())
            return first_equal(
                position_ids.size(), [&](std::size_t i) { return position_ids[i] * 0x9e3779b97f4a7c15ull >> 20; },
                [&](std::size_t i, std::size_t j) { return position_ids[i] == position_ids[j]; }, checkpoint_);
        return first_equal(
            scene_.positions_m.size(), [&](std::size_t i) { return hash_of(scene_.positions_m[i]); },
            [&](std::size_t i, std::size_t j) { return scene_.positions_m[i] == scene_.positions_m[j]; }, checkpoint_);
    }

    bool is_smooth(std::size_t triangle) const { return smoothing_.groups[triangle] != kFlat; }

    template <class Use>
    void for_each_corner(Use&& use) {
        for (std::uint32_t t = 0; t < scene_.triangles.size(); ++t) {
            checkpoint_.pass();
            if (!is_smooth(t)) continue;
            for (std::uint32_t i = 0; i < 3; ++i) use(3 * t + i, scene_.triangles[t].vertices[i]);
        }
    }

    /// Finds vertices that triangles with flat shading use. Other vertices can take their first normal themselves.
    void find_vertices_to_keep() {
        is_taken_.assign(scene_.positions_m.size(), false);
        for (std::size_t t = 0; t < scene_.triangles.size(); ++t)
            if (!is_smooth(t))
                for (const std::uint32_t v : scene_.triangles[t].vertices) is_taken_[v] = true;
    }

    Corner corner(std::uint32_t number) {
        Triangle& t = scene_.triangles[number / 3];
        const Vec3d p[] = {scene_.positions_m[t.vertices[0]], scene_.positions_m[t.vertices[1]],
                           scene_.positions_m[t.vertices[2]]};
        const std::uint32_t i = number % 3;
        const Vec3d own = p[i], next = p[(i + 1) % 3], before = p[(i + 2) % 3];
        return {&t.vertices[i], normalized(cross(p[1] - p[0], p[2] - p[0])), angle_between(next - own, before - own),
                smoothing_.groups[number / 3]};
    }

    static bool meets_smoothly(const Corner& own, const Corner& other) {
        if (own.group != other.group) return false;
        return own.group != kSmoothByAngle || dot(own.face_normal, other.face_normal) >= cos_crease;
    }

    void smooth_position(std::uint32_t begin, std::uint32_t end) {
        corners_.clear();
        made_.clear();
        for (std::uint32_t k = begin; k < end; ++k) corners_.push_back(corner(sorted_[k]));
        checkpoint_.pass(corners_.size() * corners_.size() / 8);
        for (const Corner& own : corners_) {
            Vec3d sum = {0, 0, 0};
            for (const Corner& other : corners_)
                if (meets_smoothly(own, other)) sum += other.angle * other.face_normal;
            set_normal(*own.vertex, length(sum) > 0 ? static_cast<Vec3f>(normalized(sum)) : Vec3f{0, 0, 0});
        }
    }

    /// Appends a copy of an element, unless the list is empty.
    template <class T>
    static void repeat(std::vector<T>& list, std::uint32_t source) {
        if (list.empty()) return;
        const T element = list[source];
        list.push_back(element);
    }

    void set_normal(std::uint32_t& vertex, Vec3f normal) {
        for (const Made& made : made_) {
            if (made.source != vertex || made.normal != normal) continue;
            vertex = made.vertex;
            return;
        }
        const std::uint32_t source = vertex;
        if (!is_taken_[source]) {
            is_taken_[source] = true;
            scene_.normals[source] = normal;
        } else {
            vertex = static_cast<std::uint32_t>(scene_.positions_m.size());
            const Vec3d position = scene_.positions_m[source];
            scene_.positions_m.push_back(position);
            scene_.normals.push_back(normal);
            repeat(scene_.uvs, source);
            repeat(scene_.second_uvs, source);
            repeat(scene_.colors, source);
        }
        made_.push_back({source, vertex, normal});
    }

    Scene& scene_;
    const Smoothing& smoothing_;
    Checkpoint& checkpoint_;
    std::vector<std::uint32_t> begin_, sorted_;
    std::vector<bool> is_taken_;
    std::vector<Corner> corners_;
    std::vector<Made> made_;
};

}  // namespace

void smooth_normals(Scene& scene, const Smoothing& smoothing, Checkpoint& checkpoint) {
    Smoother(scene, smoothing, checkpoint).smooth();
}

}  // namespace realcam::io
