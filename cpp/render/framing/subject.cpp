#include "subject.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <unordered_map>
#include <utility>
#include <vector>

namespace realcam {
namespace {

struct Part {
    BoundingBox box;
    std::size_t triangles = 0;
    bool is_subject = true;
};

/// Connected components of a scene's triangles by their vertices: the part of each triangle, and the number of parts.
struct Components {
    explicit Components(const Scene& scene) : of_triangle(scene.triangles.size()) {
        std::vector<std::uint32_t> parent(scene.positions_m.size());
        std::iota(parent.begin(), parent.end(), 0u);
        const auto root = [&](std::uint32_t v) {
            while (parent[v] != v) v = parent[v] = parent[parent[v]];
            return v;
        };
        for (const Triangle& t : scene.triangles)
            for (const int k : {1, 2}) parent[root(t.vertices[k])] = root(t.vertices[0]);
        std::unordered_map<std::uint32_t, std::uint32_t> numbers;
        for (std::size_t i = 0; i < of_triangle.size(); ++i)
            of_triangle[i] = numbers.try_emplace(root(scene.triangles[i].vertices[0]), numbers.size()).first->second;
        count = numbers.size();
    }

    std::vector<std::uint32_t> of_triangle;
    std::size_t count;
};

struct Facet {
    BoundingBox box;
    Vec3d area_m2;  ///< area vector along the normal; zero for the box of an instance
    bool emits = false;
};

class Parts {
public:
    explicit Parts(const Assembly& assembly) : assembly_(assembly), every_(asks_every_triangle(assembly)) {
        for_facets([&](std::size_t number, const Facet& facet) {
            if (number >= all.size()) all.resize(number + 1);
            all[number].box.add(facet.box);
            all[number].triangles += facet.area_m2 == Vec3d{} ? kLeastSubject : 1;
        });
    }

    /// Calls f(index of the part, facet).
    template <class F>
    void for_facets(F&& f) {
        std::size_t first = for_triangles(*assembly_.static_geometry, 0, [](Vec3d p) { return p; }, f);
        ObjectBoxes boxes;
        for (const Instance& instance : assembly_.instances) {
            if (every_)
                first = for_triangles(
                    *instance.object, first, [&](Vec3d p) { return instance.scene_from_object.point(p); }, f);
            else
                f(first++, Facet{boxes.of(instance), {}});
        }
    }

    static constexpr std::size_t kLeastSubject = 4;  // triangles: a stray triangle in a hollow object is no subject
    std::vector<Part> all;

private:
    template <class Placed, class F>
    std::size_t for_triangles(const Scene& scene, std::size_t first, Placed&& placed, F& f) {
        const Components& components = components_.try_emplace(&scene, scene).first->second;
        for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
            const Triangle& t = scene.triangles[i];
            const Vec3d a = placed(scene.positions_m[t.vertices[0]]), b = placed(scene.positions_m[t.vertices[1]]),
                        c = placed(scene.positions_m[t.vertices[2]]);
            Facet facet{{a, a}, 0.5 * cross(b - a, c - a)};
            facet.box.add(b);
            facet.box.add(c);
            facet.emits = !scene.materials.empty() && scene.materials[t.material].emits();
            f(first + components.of_triangle[i], facet);
        }
        return first + components.count;
    }

    const Assembly& assembly_;
    bool every_;
    std::unordered_map<const Scene*, Components> components_;
};

bool lies_within(const BoundingBox& inner, const BoundingBox& outer, double leave) {
    const auto low = coordinates(inner.low - outer.low), high = coordinates(outer.high - inner.high);
    const auto is_inside = [&](double distance) { return distance >= -leave; };
    return std::ranges::all_of(low, is_inside) && std::ranges::all_of(high, is_inside);
}

/// Returns true for a part that may surround a subject and touch it: it is flat, like a floor or a wall, or has no more
/// triangles than the subject, like the backdrop of a studio. Any other part must keep its distance, like a sky
/// (stay_away).
bool is_simple(const Part& part, std::size_t subject_triangles) {
    constexpr double kFlat = 0.05;
    const auto size = coordinates(part.box.size());
    return std::ranges::min(size) <= kFlat * part.box.diagonal() || part.triangles <= subject_triangles;
}

/// Returns true if no triangle of these parts is nearer to the subject than the subject is long. `others` has a flag
/// for each part.
bool stay_away(Parts& parts, const std::vector<bool>& others, const BoundingBox& subject) {
    bool any_is_near = false;
    parts.for_facets([&](std::size_t number, const Facet& facet) {
        if (any_is_near || !others[number]) return;
        const Vec3d middle = facet.box.nearest(subject.middle());
        any_is_near = length(subject.nearest(middle) - middle) < subject.diagonal();
    });
    return !any_is_near;
}

/// Removes from `chosen`, which is sorted by length, the surroundings that enclose or carry the remaining parts.
bool take_enclosing(Parts& parts, std::vector<Part*>& chosen) {
    constexpr double kMuchLonger = 4;
    std::vector<BoundingBox> rest(chosen.size() + 1);  // bounds of the parts from an index on
    for (std::size_t k = chosen.size(); k-- > 0;) (rest[k] = rest[k + 1]).add(chosen[k]->box);
    std::vector<BoundingBox> boxes(chosen.size() + 1);  // bounds of the parts before an index
    std::vector<std::size_t> triangles(chosen.size() + 1);
    for (std::size_t k = 0; k < chosen.size(); ++k) {
        (boxes[k + 1] = boxes[k]).add(chosen[k]->box);
        triangles[k + 1] = triangles[k] + chosen[k]->triangles;
    }
    for (std::size_t k = chosen.size() - 1; k > 0; --k) {
        const double own = boxes[k].diagonal();
        if (triangles[k] < Parts::kLeastSubject || !(own > 0) || !(chosen[k]->box.diagonal() >= kMuchLonger * own) ||
            !lies_within(boxes[k], rest[k], own))
            continue;
        std::vector<bool> others(parts.all.size());
        for (std::size_t i = k; i < chosen.size(); ++i)
            if (!is_simple(*chosen[i], triangles[k]))
                others[static_cast<std::size_t>(chosen[i] - parts.all.data())] = true;
        if (std::ranges::find(others, true) != others.end() && !stay_away(parts, others, boxes[k])) continue;
        for (std::size_t i = k; i < chosen.size(); ++i) chosen[i]->is_subject = false;
        chosen.resize(k);
        return true;
    }
    return false;
}

/// Removes small parts that are far from the large ones.
bool take_far(std::vector<Part*>& parts) {
    constexpr double kSmall = 0.1, kFar = 8;
    const double least = kSmall * parts.back()->box.diagonal();
    BoundingBox large;
    for (const Part* part : parts)
        if (part->box.diagonal() >= least) large.add(part->box);
    return std::erase_if(parts, [&](Part* part) {
               const Vec3d middle = part->box.middle();
               part->is_subject = length(large.nearest(middle) - middle) <= kFar * large.diagonal();
               return !part->is_subject;
           }) > 0;
}

void choose_subject(Parts& parts) {
    std::vector<Part*> chosen;
    for (Part& part : parts.all)
        if (part.triangles > 0) chosen.push_back(&part);
    std::ranges::stable_sort(chosen, {}, [](const Part* part) { return part->box.diagonal(); });
    while (!chosen.empty() && (take_enclosing(parts, chosen) || take_far(chosen))) {
    }
}

}  // namespace

Subject::Subject(const Assembly& assembly) {
    Parts parts(assembly);
    choose_subject(parts);
    for (const Part& part : parts.all)
        if (part.is_subject) box.add(part.box);
    const double thickness = 0.02 * box.diagonal();
    const auto low = coordinates(box.low), high = coordinates(box.high), size = coordinates(box.size());
    std::array<double, 6> covered_m2{};
    double inwards_m2 = 0, all_m2 = 0;
    bool is_lit_within = false;
    parts.for_facets([&](std::size_t number, const Facet& facet) {
        if (!parts.all[number].is_subject) return;
        const auto from = coordinates(facet.box.low), to = coordinates(facet.box.high),
                   area = coordinates(facet.area_m2);
        if (facet.emits) is_lit_within |= dot(box.middle() - facet.box.middle(), facet.area_m2) > 0;
        bool is_wall = false;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const bool at_low = to[axis] <= low[axis] + thickness, at_high = from[axis] >= high[axis] - thickness;
            if (!at_low && !at_high) continue;
            is_wall = true;
            covered_m2[2 * axis + (at_high ? 1 : 0)] += std::fabs(area[axis]);
            inwards_m2 += at_high ? -area[axis] : area[axis];
            all_m2 += std::fabs(area[axis]);
        }
        if (!is_wall) content.add(facet.box);
    });
    const Scene& lights = *assembly.static_geometry;
    for (const ScenePointLight& light : lights.points)
        is_lit_within |= length(box.nearest(light.position_m) - light.position_m) == 0;
    const bool is_lit_outside = !lights.suns.empty() || lights.environment.emits();
    if (!(inwards_m2 > 0.5 * all_m2) && !(is_lit_within && !is_lit_outside)) return;
    for (std::size_t side = 0; side < 6; ++side) {
        const double whole_m2 = size[(side / 2 + 1) % 3] * size[(side / 2 + 2) % 3];
        has_wall[side] = whole_m2 > 0 && covered_m2[side] >= 0.5 * whole_m2;
    }
}

int Subject::count_walls() const {
    return static_cast<int>(std::ranges::count(has_wall, true));
}

}  // namespace realcam
