#pragma once
#include <limits>

#include "../pupil/bundle_quadrature.hpp"
#include "../pupil/film_surface.hpp"
#include "../trace/lens_path.hpp"

namespace REALCAM_NAMESPACE {

/// A ray in front of the lens, relative to its front vertex, or in the camera frame (film_path_ends).
struct SceneRay {
    Vec3d origin, direction;
};

/// Unit vectors perpendicular to a direction; x is the x axis if the direction lies in the y-z plane.
struct AcrossRay {
    Vec3d x, y;

    explicit AcrossRay(Vec3d unit) {
        const Vec3d axis = std::fabs(unit.x) < 0.9 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
        x = normalized(axis - dot(axis, unit) * unit);
        y = cross(x, unit);
    }
    Vec2<double> of(Vec3d v) const { return {dot(v, x), dot(v, y)}; }
    Vec3d at(Vec2<double> v) const { return v.x * x + v.y * y; }
};

/// All light of a scene point that reaches the film, parametrised by its intersection with a plane perpendicular to one
/// of its rays. Over it the light is uniform, except for the obliquity of the other rays.
class SceneBundle {
public:
    using Entry = Vec2<double>;  ///< mm from the origin of `ray`, in the axes of AcrossRay

    Entry middle, reach;  ///< bounds of what passes: centre and half sides
    bool mirrored;  ///< true: symmetric in x

    /// `path`: to the film, ending in the film frame (film_path_ends); it must outlive this object. `ray`: from the
    /// lens to the point, unit direction. `distance`: from the ray's origin to the point, infinity allowed.
    SceneBundle(const LensPath<double>& path, FilmSurface<double> film, const SceneRay& ray, double distance,
                EntryRectangle in, bool mirrored)
        : middle(in.middle),
          reach(in.reach),
          mirrored(mirrored),
          view_(path.view()),
          index_(path.entry_index),
          film_(film),
          ray_(ray),
          across_(ray.direction),
          inverse_distance_(1 / distance) {}

    /// For each entry: true if its ray passes the lens.
    template <int N>
    void pass(const Entry (&entries)[N], bool (&passed)[N]) const {
        LensRays<double, N> rays;
        trace(entries, rays);
        for (int i = 0; i < N; ++i) passed[i] = rays.status[i] == 0;
    }

    /// Film points of the entries' rays, mm; NaN if the lens blocks the ray.
    template <int N>
    void land(const Entry (&entries)[N], Vec2<double> (&points)[N]) const {
        constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
        LensRays<double, N> rays;
        trace(entries, rays);
        for (int i = 0; i < N; ++i)
            points[i] = rays.status[i] == 0 ? film_.landing(rays.origin[i], rays.direction[i]) : Entry{kNone, kNone};
    }

    /// Light per area of the entry plane, relative to its centre: uniform in solid angle.
    double light(Entry entry) const {
        return std::pow(1 + (entry.x * entry.x + entry.y * entry.y) * inverse_distance_ * inverse_distance_, -1.5);
    }

private:
    template <int N>
    void trace(const Entry (&entries)[N], LensRays<double, N>& rays) const {
        for (int i = 0; i < N; ++i) {
            const Vec3d offset = across_.at(entries[i]);
            rays.origin.set(i, ray_.origin + offset);
            rays.direction.set(i, index_ * normalized(inverse_distance_ * offset - ray_.direction));
            rays.status[i] = 0;
        }
        trace_lens(view_, rays);
    }

    LensView<double> view_;
    double index_;
    FilmSurface<double> film_;
    SceneRay ray_;
    AcrossRay across_;
    double inverse_distance_;  ///< 1/mm
};

}  // namespace REALCAM_NAMESPACE
