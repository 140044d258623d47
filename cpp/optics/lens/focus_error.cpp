#include "focus_error.hpp"

#include <cmath>
#include <limits>

#include "../../math/hypotenuse.hpp"
#include "../pupil/bundle_quadrature.hpp"
#include "best_focus.hpp"
#include "parabasal.hpp"

namespace realcam {

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// All light of the object point on the chief ray of the film's centre, through a lens of any kind. Rays are
/// parametrised by their intersection with the plane perpendicular to the chief ray at the front surface, over which
/// the light is uniform.
class CentralBundle {
public:
    using Entry = Vec2<double>;

    bool mirrored = false;
    Entry middle = {0, 0}, reach;  ///< first-order bounds of what passes: centre and half sides

    CentralBundle(const LensSystem& lens, const ParabasalRays& rays, double inverse_distance)
        : path_(lens, LightDirection::to_film, lens.wavelength_nm, film_path_ends(lens, LightDirection::to_film)),
          chief_(rays.chief),
          across_(normalized(cross(Vec3d{0, 1, 0}, chief_.scene_direction))),
          upwards_(cross(chief_.scene_direction, across_)),
          inverse_distance_(inverse_distance) {
        const double n = path_.entry_index, radius = lens.open_stop_radius();
        const Matrix2 entry = (rays.stop_by_position + n * inverse_distance * rays.stop_by_direction).inverse();
        reach = {radius * hypotenuse(entry.first.x, entry.first.y),
                 radius * hypotenuse(entry.second.x, entry.second.y)};
    }

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

    template <int N>
    void pass(const Entry (&entries)[N], bool (&passed)[N]) const {
        LensRays<double, N> rays;
        trace(entries, rays);
        for (int i = 0; i < N; ++i) passed[i] = rays.status[i] == 0;
    }

private:
    LensPath<double> path_;
    ChiefRay chief_;
    Vec3d across_, upwards_;
    double inverse_distance_;
};

/// z of the plane perpendicular to the z axis in which the rays make the smallest RMS spot: with x(z) = x0 + z m, both
/// relative to their means, it is -sum(x0 m) / sum(m^2).
double narrowest(const CentralBundle& bundle) {
    constexpr BundleSampling kSampling = {24, 8};
    constexpr int kBlock = 16;
    const std::vector<EntryPart> parts = entry_parts(bundle, kSampling);
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
    double mixed = 0, square = 0;
    for (const Line& line : lines)
        for (int k = 0; k < 2; ++k) {
            const double slope = line.slope[k] - mean.slope[k] / mean.weight;
            mixed += line.weight * (line.position[k] - mean.position[k] / mean.weight) * slope;
            square += line.weight * slope * slope;
        }
    return square > 0 ? -mixed / square : kNone;
}

}  // namespace

double focus_error(const LensSystem& lens, double focus_distance) {
    if (lens.is_rotational()) {
        const double object = focus_distance - lens.film_position();
        return object < 0 ? kNone : best_focus_distance(lens, lens.wavelength_nm, object) - lens.film_distance;
    }
    LensSystem round = lens;
    round.iris.blades = 0;
    const ParabasalRays rays = parabasal_rays(round, lens.wavelength_nm);
    // z of the object plane in the camera frame.
    const double plane = camera_film_position(lens) - focus_distance;
    const double distance = (rays.chief.scene.z - plane) / rays.chief.scene_direction.z;
    if (!(distance > 0)) return kNone;
    return narrowest({round, rays, 1 / distance}) - lens.film_distance;
}

}  // namespace realcam
