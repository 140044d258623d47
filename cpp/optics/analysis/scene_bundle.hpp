#pragma once
#include <limits>

#include "../pupil/bundle_quadrature.hpp"
#include "../pupil/film_surface.hpp"
#include "../trace/lens_path.hpp"

namespace REALCAM_NAMESPACE {

/// Ray in front of the lens, in mm, relative to the front vertex or in the camera frame (film_path_ends).
struct SceneRay {
    Vec3d origin;
    Vec3d direction;  ///< unit vector, from the lens to the scene
};

/// Frame of a plane perpendicular to a ray. If the ray lies in the y-z plane, its x is the x axis.
struct AcrossRay {
    Vec3d x, y;  ///< unit vectors

    /// `unit`: direction of the ray, a unit vector.
    explicit AcrossRay(Vec3d unit) {
        const Vec3d axis = std::fabs(unit.x) < 0.9 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
        x = normalized(axis - dot(axis, unit) * unit);
        y = cross(x, unit);
    }
    /// Returns the coordinates of a vector in the plane.
    Vec2<double> of(Vec3d v) const { return {dot(v, x), dot(v, y)}; }
    /// Returns the vector with these coordinates in the plane.
    Vec3d at(Vec2<double> v) const { return v.x * x + v.y * y; }
};

/// All light of a scene point that reaches the film (a Bundle of bundle_quadrature.hpp). The entry point of a ray is
/// its intersection with a plane perpendicular to one of the rays. Over this plane the light is uniform, except for the
/// obliquity of the other rays (see `light`).
class SceneBundle {
public:
    using Entry = Vec2<double>;  ///< entry point: mm from the origin of `ray`, in the axes of AcrossRay

    Entry middle, reach;  ///< approximate bounds of the entry points that pass: centre and half-sides
    bool mirrored;  ///< true: symmetric in x

    /// `path`: to the film, ending in the film frame (film_path_ends); it must outlive this object. `ray`: from the
    /// lens to the scene point. `distance`: from the ray's origin to the point, mm; may be infinite. `in`: initial
    /// `middle` and `reach`.
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

    /// Sets passed[i] to true if the ray with entry point i passes the lens.
    template <int N>
    void pass(const Entry (&entries)[N], bool (&passed)[N]) const {
        LensRays<double, N> rays;
        trace(entries, rays);
        for (int i = 0; i < N; ++i) passed[i] = rays.status[i] == 0;
    }

    /// Computes the film points of the rays with these entry points, mm; NaN if the lens blocks the ray.
    template <int N>
    void land(const Entry (&entries)[N], Vec2<double> (&points)[N]) const {
        constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
        LensRays<double, N> rays;
        trace(entries, rays);
        for (int i = 0; i < N; ++i)
            points[i] = rays.status[i] == 0 ? film_.landing(rays.origin[i], rays.direction[i]) : Entry{kNone, kNone};
    }

    /// Returns the density of light at an entry point, per area of the entry plane and relative to that at its centre.
    /// The light of the scene point is uniform in solid angle.
    double light(Entry entry) const {
        return std::pow(1 + (entry.x * entry.x + entry.y * entry.y) * inverse_distance_ * inverse_distance_, -1.5);
    }

private:
    /// Traces the rays with these entry points to the film.
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
