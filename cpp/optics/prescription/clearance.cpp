#include "clearance.hpp"

#include <algorithm>
#include <cmath>

#include "../../math/hypotenuse.hpp"

namespace realcam {

namespace {

/// Tolerance relative to the clear semi-diameter: faces that touch by design seem to overlap because printed radii and
/// thicknesses are rounded to four digits or more.
constexpr double kRoundingTolerance = 1e-4;

/// A refracting or reflecting surface in a run of faces. A run consists of the surfaces from one mirror (or the front)
/// to the next one (or the end), which light passes in list order and in one direction. Faces of different runs may
/// overlap, because light may pass the same glass again behind a mirror.
struct Face {
    int index;  ///< index of the surface in the lens
    double vertex;  ///< z, mm
};

/// Returns the deepest overlap of two faces at distances `from` to `to` from the axis, mm; its depth is negative if
/// they are apart. Beyond its rim a face is edged flat, at the sag of the rim. `direction`: 1 if the light travels
/// along +z, else -1.
FaceOverlap deepest_overlap(const LensSystem& lens, const Face& first, const Face& second, double direction,
                            double from, double to) {
    const Surface &a = lens.surfaces[static_cast<std::size_t>(first.index)],
                  &b = lens.surfaces[static_cast<std::size_t>(second.index)];
    const double rim = std::min(a.clear_semi_diameter, b.clear_semi_diameter);
    FaceOverlap result{first.index, second.index, from, -kInfinity};
    const auto compare_at = [&](double radius) {
        const double gap = second.vertex + b.sag(std::min(radius, b.clear_semi_diameter)) - first.vertex -
                           a.sag(std::min(radius, a.clear_semi_diameter));
        if (-direction * gap > result.depth) result.radius = radius, result.depth = -direction * gap;
    };
    // The gap between two spheres is monotonic in r, as its derivative by r^2 has the sign of the difference of the
    // curvatures. Other shapes are sampled in steps.
    const auto is_sphere = [](const Surface& s) { return s.conic == 0 && !s.is_asphere() && s.form.adds_nothing(); };
    const int steps = is_sphere(a) && is_sphere(b) ? 1 : 64;
    const double middle = std::clamp(rim, from, to);
    for (int i = 0; i <= steps; ++i) {
        compare_at(from + (middle - from) * i / steps);
        compare_at(middle + (to - middle) * i / steps);
    }
    return result;
}

/// True if the smaller face of an element is concave: it may be sunk into the glass, which then extends past it to the
/// rim of the larger face, as in the front element of a fisheye. `direction`: see deepest_overlap.
bool is_sunk(const Surface& front, const Surface& back, double direction) {
    const bool is_back = back.clear_semi_diameter < front.clear_semi_diameter;
    const Surface& smaller = is_back ? back : front;
    return direction * smaller.sag(smaller.clear_semi_diameter) * (is_back ? 1 : -1) > 0;
}

/// Appends the overlaps of a run of faces until `overlaps` has `max_count` entries. `in_glass`: for each face, true if
/// glass lies between it and the next one. `direction`: see deepest_overlap.
void append_overlaps(const LensSystem& lens, const std::vector<Face>& run, const std::vector<bool>& in_glass,
                     double direction, std::size_t max_count, std::vector<FaceOverlap>& overlaps) {
    const auto surface = [&](std::size_t i) -> const Surface& {
        return lens.surfaces[static_cast<std::size_t>(run[i].index)];
    };
    for (std::size_t i = 0; i + 1 < run.size(); ++i) {
        // Up to this radius other faces lie between the two. Their own overlaps are found in other pairs.
        double between = 0;
        for (std::size_t j = i + 1; j < run.size(); ++j) {
            const Surface &a = surface(i), &b = surface(j);
            const bool is_element = j == i + 1 && in_glass[i] && !is_sunk(a, b, direction);
            const double from = std::max({between, a.inner_semi_diameter, b.inner_semi_diameter});
            // An element needs glass up to its larger rim; faces with air between them only must not overlap.
            const double to = is_element ? std::max(a.clear_semi_diameter, b.clear_semi_diameter)
                                         : std::min(a.clear_semi_diameter, b.clear_semi_diameter);
            const double tolerance = kRoundingTolerance * std::min(a.clear_semi_diameter, b.clear_semi_diameter);
            if (from < to) {
                const FaceOverlap found = deepest_overlap(lens, run[i], run[j], direction, from, to);
                if (found.depth > tolerance) overlaps.push_back(found);
                if (overlaps.size() >= max_count) return;
            }
            if (b.inner_semi_diameter == 0) between = std::max(between, b.clear_semi_diameter);
            if (between >= a.clear_semi_diameter) break;
        }
    }
}

}  // namespace

std::vector<FaceOverlap> find_overlaps(const LensSystem& lens, std::size_t max_count) {
    const std::vector<double> z = lens.vertices();
    std::vector<FaceOverlap> overlaps;
    std::vector<Face> run;
    std::vector<bool> in_glass;
    double direction = 1;
    bool is_glass = false;  // the medium behind the last surface
    for (std::size_t i = 0; i < lens.surfaces.size() && overlaps.size() < max_count; ++i) {
        const Surface& surface = lens.surfaces[i];
        const bool is_moved = !surface.placement.is_in_place();
        // A surface off the axis, or without rotational symmetry, is not compared with other faces.
        const bool is_excluded = (is_moved && surface.placement.returns) || !surface.form.asymmetry().empty();
        if (is_moved && !surface.placement.returns) {
            append_overlaps(lens, run, in_glass, direction, max_count, overlaps);
            run.clear();
            in_glass.clear();
            // A coordinate break that reverses the z axis also reverses the light's direction along it.
            if (i > 0 && surface.placement.frame().z.z < 0) direction = -direction;
        }
        if (surface.bends_light() && is_excluded) {
            if (surface.type == SurfaceType::mirror) direction = -direction;
            if (surface.type == SurfaceType::refracting) is_glass = !surface.material.is_air();
            if (!in_glass.empty()) in_glass.back() = false;
        }
        if (!surface.bends_light() || is_excluded) continue;
        if (surface.type == SurfaceType::refracting) is_glass = !surface.material.is_air();
        run.push_back({static_cast<int>(i), z[i]});
        in_glass.push_back(is_glass);
        if (surface.type != SurfaceType::mirror) continue;
        append_overlaps(lens, run, in_glass, direction, max_count, overlaps);
        run = {run.back()};
        in_glass = {is_glass};
        direction = -direction;
    }
    if (overlaps.size() < max_count) append_overlaps(lens, run, in_glass, direction, max_count, overlaps);
    return overlaps;
}

std::optional<FaceOverlap> find_overlap(const LensSystem& lens) {
    const std::vector<FaceOverlap> first = find_overlaps(lens, 1);
    return first.empty() ? std::nullopt : std::optional(first.front());
}

bool film_crosses_lens(const LensSystem& lens) {
    if (!lens.is_rotational()) return false;
    for (std::size_t i = lens.surfaces.size(); i-- > 0;) {
        const Surface& last = lens.surfaces[i];
        if (!last.bends_light()) continue;
        const double distance = lens.film_position() - lens.vertices()[i];
        const double corner = 0.5 * hypotenuse(lens.film_width, lens.film_height);
        const double reach = std::min(last.clear_semi_diameter, corner);
        constexpr int kSteps = 64;
        for (int k = 0; k <= kSteps; ++k)
            if (distance - last.sag(reach * k / kSteps) < -kRoundingTolerance * reach) return true;
        return false;
    }
    return false;
}

std::vector<Crossing> crossings_of(const LensSystem& lens) {
    std::vector<Crossing> crossings;
    for (int i = 0; i < static_cast<int>(lens.surfaces.size()); ++i) crossings.push_back({i, true, false});
    return crossings;
}

std::vector<Crossing> crossings_of(const LensSystem& lens, GhostPair pair) {
    std::vector<Crossing> crossings;
    for (int i = 0; i < pair.first; ++i) crossings.push_back({i, true, false});
    crossings.push_back({pair.first, true, !is_film(lens, pair.first)});
    for (int i = pair.first - 1; i > pair.second; --i) crossings.push_back({i, false, false});
    crossings.push_back({pair.second, false, true});
    for (int i = pair.second + 1; i < static_cast<int>(lens.surfaces.size()); ++i)
        crossings.push_back({i, true, false});
    return crossings;
}

std::vector<Crossing> reversed(std::vector<Crossing> crossings) {
    std::reverse(crossings.begin(), crossings.end());
    for (Crossing& crossing : crossings)
        if (!crossing.is_reflected) crossing.in_order = !crossing.in_order;
    return crossings;
}

std::vector<GhostPair> ghost_pairs(const LensSystem& lens, int first_begin, int first_end) {
    std::vector<GhostPair> pairs;
    const auto refracts = [&](int i) {
        return lens.surfaces[static_cast<std::size_t>(i)].type == SurfaceType::refracting;
    };
    for (int first = first_begin; first < first_end; ++first)
        for (int second = 0; second < first; ++second)
            if ((is_film(lens, first) || refracts(first)) && refracts(second)) pairs.push_back({first, second});
    return pairs;
}

std::vector<GhostPair> film_ghost_pairs(const LensSystem& lens) {
    const int film = static_cast<int>(lens.surfaces.size());
    return ghost_pairs(lens, film, film + 1);
}

}  // namespace realcam
