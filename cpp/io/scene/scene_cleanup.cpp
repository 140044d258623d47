#include "scene_cleanup.hpp"

#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>

#include "../../error.hpp"
#include "../../scene/scene_checks.hpp"
#include "vertex_welding.hpp"

namespace realcam::io {

void warn_count(Scene& scene, const std::string& path, std::size_t count, const std::string& problem) {
    if (count > 0) scene.warnings.push_back(path + ": " + std::to_string(count) + " " + problem);
}

void clean_geometry(Scene& scene, Smoothing smoothing, const std::string& path, Checkpoint& checkpoint) {
    if (scene.triangles.empty()) {
        throw SceneFileError(path + ": holds no triangles" +
                             (scene.positions_m.empty() ? "" : ", only points or lines"));
    }
    // Like drop_degenerate_triangles, but drops the smoothing groups of these triangles, too.
    std::size_t remaining = 0;
    bool any_smooth = false;
    for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
        checkpoint.pass();
        if (is_degenerate(scene, scene.triangles[t])) continue;
        any_smooth |= smoothing.groups[t] != kFlat;
        smoothing.groups[remaining] = smoothing.groups[t];
        scene.triangles[remaining++] = scene.triangles[t];
    }
    const std::size_t dropped = scene.triangles.size() - remaining;
    scene.triangles.resize(remaining);
    smoothing.groups.resize(remaining);
    if (remaining == 0) throw SceneFileError(path + ": all of its triangles are without area");
    warn_count(scene, path, dropped, dropped == 1 ? "triangle without area dropped" : "triangles without area dropped");

    if (any_smooth) smooth_normals(scene, smoothing, checkpoint);
    weld_vertices(scene, checkpoint);
}

namespace {

constexpr double kCosCrease = 0.70710678118654752;  // cosine of 45 degrees

// Largest number of faces at a smooth position, because the work grows with its square. The hub of a wider fan of
// triangles is nearly flat and gets no normal.
constexpr std::size_t kMaxFaces = 512;

double angle_between(Vec3d a, Vec3d b) {
    return std::atan2(length(cross(a, b)), dot(a, b));
}

/// Implementation of smooth_normals. Computes normals one position at a time: it stores only the faces at the current
/// position, because data of all faces would need more memory than anything else in a scene of ten million.
class Smoother {
public:
    Smoother(Scene& scene, const Smoothing& smoothing, Checkpoint& checkpoint)
        : scene_(scene), smoothing_(smoothing), checkpoint_(checkpoint) {}

    void smooth() {
        if (scene_.normals.empty()) scene_.normals.assign(scene_.positions_m.size(), Vec3f{0, 0, 0});
        sort_corners();
        find_flat_vertices();
        for (std::size_t position = 0; position + 1 < begin_.size(); ++position) {
            const std::size_t count = begin_[position + 1] - begin_[position];
            checkpoint_.pass(1 + 8 * count);
            if (count > 0 && count <= kMaxFaces) smooth_position(begin_[position], begin_[position + 1]);
        }
    }

private:
    /// Triangle corner at the current position.
    struct Corner {
        std::uint32_t* vertex;  ///< the triangle's index of its vertex, to be replaced
        Vec3d face_normal;
        double angle;  ///< between the triangle's edges at the corner, in radians
        std::uint32_t group;  ///< see Smoothing
    };
    /// Vertex with a normal at the current position.
    struct SmoothVertex {
        std::uint32_t source;  ///< vertex of the file
        std::uint32_t vertex;  ///< vertex that has the normal: `source` itself or a copy of it
        Vec3f normal;
    };

    /// Sorts the corners of smooth triangles by position: begin_[p] .. begin_[p + 1] of sorted_ are the corners at the
    /// position of vertex p, where p is the first of the vertices at that position. The index of a corner is 3 times
    /// that of its triangle, plus 0 to 2.
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

    /// Returns, for each vertex, the first vertex at the same position.
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

    /// Calls use(corner, vertex) with the indices of all corners of smooth triangles.
    template <class Use>
    void for_each_corner(Use&& use) {
        for (std::uint32_t t = 0; t < scene_.triangles.size(); ++t) {
            checkpoint_.pass();
            if (!is_smooth(t)) continue;
            for (std::uint32_t i = 0; i < 3; ++i) use(3 * t + i, scene_.triangles[t].vertices[i]);
        }
    }

    /// Marks the vertices of flat triangles as taken. Other vertices can get their first normal without a copy.
    void find_flat_vertices() {
        is_taken_.assign(scene_.positions_m.size(), false);
        for (std::size_t t = 0; t < scene_.triangles.size(); ++t)
            if (!is_smooth(t))
                for (const std::uint32_t v : scene_.triangles[t].vertices) is_taken_[v] = true;
    }

    /// Returns the corner of this index.
    Corner corner(std::uint32_t index) {
        Triangle& t = scene_.triangles[index / 3];
        const Vec3d p[] = {scene_.positions_m[t.vertices[0]], scene_.positions_m[t.vertices[1]],
                           scene_.positions_m[t.vertices[2]]};
        const std::uint32_t i = index % 3;
        const Vec3d here = p[i], next = p[(i + 1) % 3], previous = p[(i + 2) % 3];
        return {&t.vertices[i], normalized(cross(p[1] - p[0], p[2] - p[0])),
                angle_between(next - here, previous - here), smoothing_.groups[index / 3]};
    }

    /// True if b's face contributes to the normal at a.
    static bool are_smooth(const Corner& a, const Corner& b) {
        if (a.group != b.group) return false;
        return a.group != kSmoothByAngle || dot(a.face_normal, b.face_normal) >= kCosCrease;
    }

    /// Sets the normals of the corners at one position: a range of sorted_.
    void smooth_position(std::uint32_t begin, std::uint32_t end) {
        corners_.clear();
        smooth_vertices_.clear();
        for (std::uint32_t k = begin; k < end; ++k) corners_.push_back(corner(sorted_[k]));
        checkpoint_.pass(corners_.size() * corners_.size() / 8);
        for (const Corner& corner : corners_) {
            Vec3d sum = {0, 0, 0};
            for (const Corner& other : corners_)
                if (are_smooth(corner, other)) sum += other.angle * other.face_normal;
            set_normal(*corner.vertex, length(sum) > 0 ? static_cast<Vec3f>(normalized(sum)) : Vec3f{0, 0, 0});
        }
    }

    /// Appends a copy of an element, unless the list is empty.
    template <class T>
    static void append_copy(std::vector<T>& list, std::uint32_t source) {
        if (list.empty()) return;
        const T element = list[source];
        list.push_back(element);
    }

    /// Replaces a triangle's vertex by one with this normal, which is added if necessary.
    void set_normal(std::uint32_t& vertex, Vec3f normal) {
        for (const SmoothVertex& known : smooth_vertices_) {
            if (known.source != vertex || known.normal != normal) continue;
            vertex = known.vertex;
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
            append_copy(scene_.uvs, source);
            append_copy(scene_.second_uvs, source);
            append_copy(scene_.colors, source);
        }
        smooth_vertices_.push_back({source, vertex, normal});
    }

    Scene& scene_;
    const Smoothing& smoothing_;
    Checkpoint& checkpoint_;
    std::vector<std::uint32_t> begin_, sorted_;  ///< see sort_corners
    std::vector<bool> is_taken_;  ///< per vertex of the file: it has a normal, or flat triangles use it
    std::vector<Corner> corners_;  ///< at the current position
    std::vector<SmoothVertex> smooth_vertices_;  ///< at the current position
};

}  // namespace

void smooth_normals(Scene& scene, const Smoothing& smoothing, Checkpoint& checkpoint) {
    Smoother(scene, smoothing, checkpoint).smooth();
}

}  // namespace realcam::io
