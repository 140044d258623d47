#include "focus_error.hpp"

#include <cmath>
#include <limits>

#include "../../math/hypotenuse.hpp"
#include "../pupil/bundle_quadrature.hpp"
#include "best_focus.hpp"
#include "parabasal.hpp"

namespace realcam {

namespace {

constexpr double kNoFocus = std::numeric_limits<double>::quiet_NaN();

/// Ray bundle of the object point on the chief ray of the film's centre, through a lens of any kind. Rays are
/// parametrised by their intersection with the plane perpendicular to the chief ray at the front surface (their entry),
/// over which the light is uniform. The class has the members that quadrature_rays in bundle_quadrature.hpp requires.
class CentralBundle {
public:
    /// Coordinates in that plane relative to the chief ray, mm.
    using Entry = Vec2<double>;

    bool mirrored = false;  ///< true would state that the bundle is symmetric about x = 0
    Entry middle = {0, 0}, reach;  ///< first-order bounds of the entries of rays that pass: centre and half sides

    /// `inverse_distance`: 1 / distance from the object point to the front surface along the chief ray, 1/mm; 0 for an
    /// object at infinity.
    CentralBundle(const LensSystem& lens, const ParabasalRays& rays, double inverse_distance)
        : path_(lens, LightDirection::to_film, lens.wavelength_nm, film_path_ends(lens, LightDirection::to_film)),
          chief_(rays.chief),
          across_(normalized(cross(Vec3d{0, 1, 0}, chief_.scene_direction))),
          upwards_(cross(chief_.scene_direction, across_)),
          inverse_distance_(inverse_distance) {
        const double n = path_.entry_index, radius = lens.open_stop_radius();
        const Matrix2 entry_by_stop = (rays.stop_by_position + n * inverse_distance * rays.stop_by_direction).inverse();
        reach = {radius * hypotenuse(entry_by_stop.first.x, entry_by_stop.first.y),
                 radius * hypotenuse(entry_by_stop.second.x, entry_by_stop.second.y)};
    }

    /// Traces the rays with these entries to the film frame.
    template <int N>
    void trace(const Entry (&entries)[N], LensRays<double, N>& rays) const {
        for (int i = 0; i < N; ++i) {
            const Vec3d offset = entries[i].x * across_ + entries[i].y * upwards_;
            rays.origin.set(i, chief_.scene + offset);
            rays.direction.set(i, path_.entry_index * normalized(chief_.scene_direction + inverse_distance_ * offset));
            rays.status[i] = 0;
        }
        trace_lens(path_.view(), rays);
    }

    /// Sets `passed` to true for the rays that pass the lens.
    template <int N>
    void pass(const Entry (&entries)[N], bool (&passed)[N]) const {
        LensRays<double, N> rays;
        trace(entries, rays);
        for (int i = 0; i < N; ++i) passed[i] = rays.status[i] == 0;
    }

private:
    LensPath<double> path_;
    ChiefRay chief_;
    Vec3d across_, upwards_;  ///< axes of the entries, perpendicular to the chief ray
    double inverse_distance_;
};

/// Returns z of the plane perpendicular to the z axis in which the rays make the smallest RMS spot, in the film frame,
/// mm; NaN if no ray passes. With x(z) = x0 + z m, where x0 and m are relative to their means, it is -sum(x0 m) /
/// sum(m^2).
double smallest_spot_position(const CentralBundle& bundle) {
    constexpr BundleSampling kSampling = {24, 8};
    constexpr int kBlock = 16;
    const std::vector<QuadratureRay> parts = quadrature_rays(bundle, kSampling);
    // A ray behind the lens: x and y at z = 0, and dx/dz and dy/dz.
    struct Line {
        double weight, position[2], slope[2];
    };
    std::vector<Line> lines;
    Line mean{};
    for (std::size_t first = 0; first < parts.size(); first += kBlock) {
        Vec2<double> entries[kBlock];
        const auto part = [&](int i) { return parts[std::min(first + static_cast<std::size_t>(i), parts.size() - 1)]; };
        for (int i = 0; i < kBlock; ++i) entries[i] = part(i).entry;
        LensRays<double, kBlock> rays;
        bundle.trace(entries, rays);
        for (int i = 0; i < kBlock && first + static_cast<std::size_t>(i) < parts.size(); ++i) {
            if (rays.status[i] != 0) continue;
            const Vec3d o = rays.origin[i], d = rays.direction[i];
            const double mx = d.x / d.z, my = d.y / d.z;
            lines.push_back({part(i).area, {o.x - mx * o.z, o.y - my * o.z}, {mx, my}});
            mean.weight += part(i).area;
            for (int k = 0; k < 2; ++k) {
                mean.position[k] += part(i).area * lines.back().position[k];
                mean.slope[k] += part(i).area * lines.back().slope[k];
            }
        }
    }
    double sum_x0_m = 0, sum_m_squared = 0;
    for (const Line& line : lines)
        for (int k = 0; k < 2; ++k) {
            const double slope = line.slope[k] - mean.slope[k] / mean.weight;
            sum_x0_m += line.weight * (line.position[k] - mean.position[k] / mean.weight) * slope;
            sum_m_squared += line.weight * slope * slope;
        }
    return sum_m_squared > 0 ? -sum_x0_m / sum_m_squared : kNoFocus;
}

}  // namespace

double focus_error(const LensSystem& lens, double focus_distance) {
    if (lens.is_rotational()) {
        const double object = focus_distance - lens.film_position();
        return object < 0 ? kNoFocus : best_focus_distance(lens, lens.wavelength_nm, object) - lens.film_distance;
    }
    LensSystem round = lens;
    round.iris.blades = 0;
    const ParabasalRays rays = parabasal_rays(round, lens.wavelength_nm);
    // z of the object plane in the camera frame.
    const double plane = camera_film_position(lens) - focus_distance;
    const double distance = (rays.chief.scene.z - plane) / rays.chief.scene_direction.z;
    if (!(distance > 0)) return kNoFocus;
    return smallest_spot_position({round, rays, 1 / distance}) - lens.film_distance;
}

}  // namespace realcam
