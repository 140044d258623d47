#include "subject.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <unordered_map>

namespace realcam {
namespace {

/// Returns x, y and z of a vector as an array, for loops over the axes.
std::array<double, 3> coordinates(Vec3d v) {
    return {v.x, v.y, v.z};
}

/// Connected components of a scene's triangles by their vertices.
struct Components {
    explicit Components(const Scene& scene) {
        std::vector<std::uint32_t> parent(scene.positions_m.size());
        std::iota(parent.begin(), parent.end(), 0u);
        const auto root = [&](std::uint32_t v) {
            while (parent[v] != v) v = parent[v] = parent[parent[v]];
            return v;
        };
        for (const Triangle& t : scene.triangles)
            for (const int k : {1, 2}) parent[root(t.vertices[k])] = root(t.vertices[0]);
        std::unordered_map<std::uint32_t, std::size_t> indices;
        for (const Triangle& t : scene.triangles)
            of_triangle.push_back(indices.try_emplace(root(t.vertices[0]), indices.size()).first->second);
        count = indices.size();
    }

    std::vector<std::size_t> of_triangle;  ///< index of the component of each triangle
    std::size_t count;  ///< number of components
};

/// A triangle, or an instance, which is represented by its bounding box.
struct Facet {
    BoundingBox box;
    Vec3d area_m2 = {0, 0, 0};  ///< geometric normal times the area; 0 for an instance
    bool emits = false;
};

/// Triangles of a scene, including those of its instances unless there are too many to test each (has_exact_boxes).
/// In that case an instance is a single facet.
class Facets {
public:
    explicit Facets(const Assembly& assembly) : assembly_(assembly) {}

    /// Calls visit(part index, facet) for each facet. Parts are the connected components of the static geometry and of
    /// each instance, or whole instances.
    template <class Visit>
    void for_each(Visit&& visit) {
        std::size_t first = for_triangles(*assembly_.static_geometry, {}, 0, visit);
        ObjectBoxes boxes;
        const bool every = has_exact_boxes(assembly_);
        for (const Instance& instance : assembly_.instances) {
            if (every)
                first = for_triangles(*instance.object, instance.scene_from_object, first, visit);
            else
                visit(first++, Facet{boxes.of(instance)});
        }
    }

private:
    /// Visits the triangles of one scene, transformed by `map`. `first`: index of its first part. Returns the index
    /// after its last part.
    template <class Visit>
    std::size_t for_triangles(const Scene& scene, const Affine<double>& map, std::size_t first, Visit& visit) {
        const Components& components = components_.try_emplace(&scene, scene).first->second;
        for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
            const Triangle& t = scene.triangles[i];
            const auto vertex = [&](int k) { return map.point(scene.positions_m[t.vertices[k]]); };
            const Vec3d a = vertex(0), b = vertex(1), c = vertex(2);
            Facet facet{{a, a}, 0.5 * cross(b - a, c - a)};
            facet.box.add(b);
            facet.box.add(c);
            facet.emits = !scene.materials.empty() && scene.materials[t.material].emits();
            visit(first + components.of_triangle[i], facet);
        }
        return first + components.count;
    }

    const Assembly& assembly_;
    std::unordered_map<const Scene*, Components> components_;
};

/// A connected component, or an instance, which is represented by its bounding box.
struct Part {
    static constexpr double kFlat = 0.05;  ///< largest thickness of a flat part, over its size

    BoundingBox box;
    std::size_t facets = 0;  ///< number of facets
    bool emits = false;
    bool is_subject = false;  ///< true if the part belongs to the subject
    bool must_stay_away = false;  ///< used by choose_carried: true if the part must not be near the subject

    double size() const { return box.diagonal(); }

    /// Returns the axis (0, 1 or 2) along which a flat part is thin; 3 if the part is not flat.
    std::size_t thin_axis() const {
        const auto sizes = coordinates(box.size());
        const auto least = std::ranges::min_element(sizes);
        return *least <= kFlat * size() ? static_cast<std::size_t>(least - sizes.begin()) : 3;
    }

    /// Returns true if the other part lies inside the box of this one or, if this one is flat, inside the box extended
    /// along its thin axis.
    bool spans(const Part& other) const {
        const auto low = coordinates(other.box.low - box.low), high = coordinates(box.high - other.box.high);
        const std::size_t across = thin_axis();
        for (std::size_t axis = 0; axis < 3; ++axis)
            if (axis != across && std::min(low[axis], high[axis]) < -kFlat * size()) return false;
        return true;
    }
};

/// Reduces `chosen`, which is sorted by decreasing size, to the parts that one of its largest parts carries or encloses
/// (first rule of Subject). Returns false if there is no such part. `parts`: all parts, by their indices in `facets`;
/// `up`: unit.
bool choose_carried(std::vector<Part*>& chosen, Facets& facets, const std::vector<Part>& parts, Vec3d up) {
    // Number of large parts that are tested as carriers.
    constexpr std::size_t kMaxCarriers = 64;
    // Least number of facets of the subject, over that of the parts beside the carrier.
    constexpr std::size_t kOutweighs = 4;
    // Least size of the scene and of the carrier, over that of the subject.
    constexpr double kMuchLonger = 3.5, kLonger = 2;
    Part whole;
    for (const Part* part : chosen) whole.box.add(part->box);
    for (std::size_t k = 0; k < std::min(kMaxCarriers, chosen.size()); ++k) {
        const Part& carrier = *chosen[k];
        const std::size_t across = carrier.thin_axis();
        const bool is_ground = across < 3 && std::fabs(coordinates(up)[across]) > 0.9;
        std::vector<Part*> carried;
        Part subject;
        std::size_t facets_beside = 0;
        for (Part* part : chosen) {
            const bool is_sheet = part->thin_axis() < 3 && part->size() >= whole.size() / kLonger;
            const bool is_shell = part->size() >= kLonger * carrier.size() && part->spans(carrier);
            part->must_stay_away = !is_sheet && !part->emits && (is_shell || part == &carrier);
            if (is_sheet || is_shell || part->emits || part == &carrier) continue;
            const double above = dot(part->box.middle() - carrier.box.middle(), up);
            if (!carrier.spans(*part)) {
                facets_beside += part->facets;
            } else if (!is_ground || above >= -1e-6 * carrier.size()) {
                // Parts below the ground, such as the legs of a table, are not carried.
                carried.push_back(part);
                subject.box.add(part->box);
                subject.facets += part->facets;
            }
        }
        if (!(subject.size() > 0) || subject.facets < kOutweighs * facets_beside ||
            carrier.size() < kLonger * subject.size() || whole.size() < kMuchLonger * subject.size())
            continue;
        // Parts with more facets than the subject must not be near it: a statue is not the surroundings of its own
        // small parts. A part with fewer, such as the backdrop of a studio, may be near.
        bool any_is_near = false;
        facets.for_each([&](std::size_t index, const Facet& facet) {
            if (!parts[index].must_stay_away || parts[index].facets <= subject.facets) return;
            const Vec3d near = facet.box.nearest(subject.box.middle());
            any_is_near |= length(subject.box.nearest(near) - near) < subject.size();
        });
        if (any_is_near) continue;
        for (Part* part : chosen) part->must_stay_away = false;
        chosen = carried;
        return true;
    }
    return false;
}

/// Removes small parts that are far from the large ones (second rule of Subject). Returns true if it removes any.
/// `chosen` is sorted by decreasing size.
bool remove_far(std::vector<Part*>& chosen) {
    constexpr double kSmall = 0.1;  // largest size of a small part, over that of the largest part
    constexpr double kFar = 8;  // least distance from the box of the large parts, over its size
    Part large;
    for (const Part* part : chosen)
        if (part->size() >= kSmall * chosen.front()->size()) large.box.add(part->box);
    return std::erase_if(chosen, [&](const Part* part) {
        const Vec3d middle = part->box.middle();
        return length(large.box.nearest(middle) - middle) > kFar * large.size();
    });
}

}  // namespace

Subject::Subject(const Assembly& assembly, Vec3d up) {
    Facets facets(assembly);
    std::vector<Part> parts;
    facets.for_each([&](std::size_t index, const Facet& facet) {
        if (index >= parts.size()) parts.resize(index + 1);
        parts[index].box.add(facet.box);
        parts[index].emits |= facet.emits;
        ++parts[index].facets;
    });
    std::vector<Part*> chosen;
    for (Part& part : parts)
        if (!part.box.empty()) chosen.push_back(&part);
    std::ranges::stable_sort(chosen, std::greater<>(), &Part::size);
    while (choose_carried(chosen, facets, parts, up) || remove_far(chosen)) {
    }
    for (Part* part : chosen) {
        part->is_subject = true;
        part_boxes.push_back(part->box);
        box.add(part->box);
    }
    // Walls: facets that lie in a side of the box. Sides are indexed -x, +x, -y, +y, -z, +z.
    const double thickness = 0.02 * box.diagonal();
    std::array<double, 6> covered_m2{};  // area of the facets in each side
    double inwards_m2 = 0, all_m2 = 0;  // area of the facets that face inwards less those that face outwards; of all
    bool is_lit_within = false;  // true if a light lies in the box and shines inwards
    facets.for_each([&](std::size_t index, const Facet& facet) {
        if (!parts[index].is_subject) return;
        const auto to_low = coordinates(facet.box.high - box.low), to_high = coordinates(box.high - facet.box.low),
                   area = coordinates(facet.area_m2);
        is_lit_within |= facet.emits && dot(box.middle() - facet.box.middle(), facet.area_m2) > 0;
        bool is_in_side = false;
        for (std::size_t side = 0; side < 6; ++side) {
            if ((side % 2 ? to_high : to_low)[side / 2] > thickness) continue;
            is_in_side = true;
            covered_m2[side] += std::fabs(area[side / 2]);
            inwards_m2 += side % 2 ? -area[side / 2] : area[side / 2];
            all_m2 += std::fabs(area[side / 2]);
        }
        if (!is_in_side) content.add(facet.box);
    });
    const Scene& lights = *assembly.static_geometry;
    for (const ScenePointLight& light : lights.points)
        is_lit_within |= length(box.nearest(light.position_m) - light.position_m) == 0;
    const bool is_lit_outside = !lights.suns.empty() || lights.environment.emits();
    if (!(inwards_m2 > 0.5 * all_m2) && !(is_lit_within && !is_lit_outside)) return;
    constexpr std::array<Vec3d, 6> kNormals = {{{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}}};
    const auto size = coordinates(box.size());
    for (std::size_t side = 0; side < 6; ++side) {
        const double whole_m2 = size[(side / 2 + 1) % 3] * size[(side / 2 + 2) % 3];
        if (whole_m2 > 0 && covered_m2[side] >= 0.5 * whole_m2) walls.push_back(kNormals[side]);
    }
}

bool Subject::has_wall(Vec3d direction) const {
    return std::ranges::any_of(walls, [&](Vec3d normal) { return dot(normal, direction) > 0.8; });
}

}  // namespace realcam
