#include "best_focus.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "../trace/lens_path.hpp"
#include "paraxial.hpp"

namespace realcam {

namespace best_focus_detail {

namespace {

/// Meridional rays from one axial object point, parametrised by their paraxial height at the stop, which is finite
/// wherever the pupil lies.
class AxialRays {
public:
    /// `object_distance`: from the object point to the front vertex, mm.
    AxialRays(const LensSystem& lens, double wavelength_nm, double object_distance)
        : path_(lens, LightDirection::to_film, wavelength_nm) {
        const int behind_stop = lens.stop_index() + 1;
        const ParaxialRay level = trace_paraxial(lens, wavelength_nm, {1, 0}, 0, behind_stop),
                          inclined = trace_paraxial(lens, wavelength_nm, {0, 1}, 0, behind_stop);
        // The height at the stop is level.height y + inclined.height u for a ray of height y = u s and slope u at the
        // front vertex, written in a form that holds for any object distance s.
        const double s = object_distance;
        if (std::fabs(level.height * s) > std::fabs(inclined.height)) {
            height_ = 1 / (level.height + inclined.height / s);
            slope_ = height_ / s;
        } else {
            slope_ = 1 / (level.height * s + inclined.height);
            height_ = slope_ * s;
        }
    }

    /// Traces the rays with these paraxial heights at the stop, mm, to the last surface.
    template <int N>
    void trace(const double (&at_stop)[N], LensRays<double, N>& rays) const {
        for (int i = 0; i < N; ++i) {
            // Rays start at the front vertex: from an object kilometres away the intersections would lose all their
            // digits.
            rays.origin.set(i, {height_ * at_stop[i], 0, 0});
            rays.direction.set(i, path_.entry_index * normalized(Vec3d{slope_ * at_stop[i], 0, 1}));
            rays.status[i] = 0;
        }
        PathRecord<double, N> record{};
        trace_lens(path_.view(), rays, record);
    }

private:
    LensPath<double> path_;
    double height_ = 0,
           slope_ = 0;  ///< height and slope at the front vertex of the paraxial ray of height 1 at the stop
};

/// Edge of the light between two squared heights at the stop, mm^2: rays pass at `open`, and are blocked at `shut`.
struct Edge {
    double open, shut;
    double middle() const { return 0.5 * (open + shut); }
};

constexpr int kEdgesAtOnce = 8;  // lanes of a bisection

/// Bisects up to kEdgesAtOnce edges to the last digit: a focus that jumps as single rays appear and vanish cannot be
/// searched for.
void bisect(const AxialRays& rays, std::span<Edge> edges) {
    // With few edges, spare lanes evaluate the midpoints that the next bisections may need. Each edge has a binary tree
    // of midpoints, whose children are the midpoints of the two halves. The half that follows if the midpoint passes is
    // the first child.
    constexpr int kHalvings = 44;
    const int count = static_cast<int>(edges.size());
    const int depth = count == 1 ? 3 : count == 2 ? 2 : 1, nodes = (1 << depth) - 1;
    for (int k = 0; k < kHalvings; k += depth) {
        Edge tree[kEdgesAtOnce] = {};
        double heights[kEdgesAtOnce] = {};
        for (int e = 0; e < count; ++e)
            for (int n = 0; n < nodes; ++n) {
                const Edge& above = tree[e * nodes + (n - 1) / 2];
                Edge& node = tree[e * nodes + n];
                node = n == 0       ? edges[static_cast<std::size_t>(e)]
                       : n % 2 == 1 ? Edge{above.middle(), above.shut}
                                    : Edge{above.open, above.middle()};
                heights[e * nodes + n] = std::sqrt(node.middle());
            }
        LensRays<double, kEdgesAtOnce> fine;
        rays.trace(heights, fine);
        for (int e = 0; e < count; ++e)
            for (int n = 0, level = 0; level < std::min(depth, kHalvings - k); ++level) {
                const bool passes = fine.status[e * nodes + n] == 0;
                Edge& edge = edges[static_cast<std::size_t>(e)];
                (passes ? edge.open : edge.shut) = tree[e * nodes + n].middle();
                n = 2 * n + (passes ? 1 : 2);
            }
    }
}

/// Returns the intervals of the squared height at the stop, mm^2, in which rays pass, in ascending order up to the
/// height `max_height`, mm.
std::vector<std::pair<double, double>> passing_intervals(const AxialRays& rays, double max_height) {
    constexpr int kRays = 256;
    const double cell = max_height * max_height / kRays;
    LensRays<double, kRays> coarse;
    double height[kRays];
    for (int i = 0; i < kRays; ++i) height[i] = std::sqrt((i + 0.5) * cell);
    rays.trace(height, coarse);
    std::vector<Edge> edges;
    for (int i = 1; i < kRays; ++i) {
        const bool previous_passes = coarse.status[i - 1] == 0, passes = coarse.status[i] == 0;
        if (previous_passes != passes)
            edges.push_back({(i + (passes ? 0.5 : -0.5)) * cell, (i + (passes ? -0.5 : 0.5)) * cell});
    }
    for (std::size_t first = 0; first < edges.size(); first += kEdgesAtOnce)
        bisect(rays, std::span(edges).subspan(first, std::min<std::size_t>(kEdgesAtOnce, edges.size() - first)));
    std::vector<std::pair<double, double>> intervals;
    bool inside = coarse.status[0] == 0;
    if (inside) intervals.emplace_back(0.0, 0.0);
    for (const Edge& edge : edges) {
        inside = !inside;
        if (inside)
            intervals.emplace_back(edge.open, 0.0);
        else
            intervals.back().second = edge.open;
    }
    if (inside) intervals.back().second = max_height * max_height;
    return intervals;
}

}  // namespace

}  // namespace best_focus_detail

double best_focus_distance(LensSystem lens, double wavelength_nm, double object_distance) {
    using namespace best_focus_detail;
    constexpr int kRays = 32;  // exact for aberrations up to the power 126 of the height
    static const GaussRule<kRays> rule;
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    if (std::isinf(object_distance) && first_order(lens, wavelength_nm).is_afocal()) return kNone;
    lens.iris.blades = 0;
    const AxialRays axial(lens, wavelength_nm, object_distance);
    // Larger than the stop, because the real pupil can be larger than the paraxial one.
    const double max_height = 1.5 * lens.open_stop_radius();
    double sum_x0_m = 0, sum_m_squared = 0;
    for (const auto& [from, to] : passing_intervals(axial, max_height)) {
        double height[kRays];
        for (int i = 0; i < kRays; ++i) height[i] = std::sqrt(from + (to - from) * rule.node[i]);
        LensRays<double, kRays> rays;
        axial.trace(height, rays);
        for (int i = 0; i < kRays; ++i) {
            if (rays.status[i] != 0) continue;
            const double weight = (to - from) * rule.weight[i], slope = rays.direction.x[i] / rays.direction.z[i];
            sum_x0_m += weight * (rays.origin.x[i] - slope * rays.origin.z[i]) * slope;
            sum_m_squared += weight * slope * slope;
        }
    }
    return sum_m_squared > 0 ? -sum_x0_m / sum_m_squared : kNone;
}

}  // namespace realcam
