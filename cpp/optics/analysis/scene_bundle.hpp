#pragma once
#include <limits>

#include "../pupil/bundle_quadrature.hpp"
#include "../pupil/film_surface.hpp"
#include "../trace/lens_path.hpp"

namespace REALCAM_NAMESPACE {

/// A ray in front of the lens, relative to its front vertex, or in the frame of the camera (film_path_ends).
struct SceneRay {
    Vec3d origin, direction;
};

/// Unit vectors across a direction: x has nothing of the y axis, if the direction has nothing of the x axis.
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

/// All light of a scene point that reaches the film. It is described by where it crosses a plane perpendicular to one
/// of its rays. There it is even, except for the obliquity of the other rays.
class SceneBundle {
public:
    using Entry = Vec2<double>;  ///< mm from where the ray leaves the lens, in the axes of AcrossRay

    Entry middle, reach;  ///< of a rectangle that holds what passes
    bool mirrored;        ///< x and -x are alike

    /// `path`: to the film and into its frame (film_path_ends); it must outlive this. `ray`: from the lens to the
    /// point, unit direction. `distance`: of the point from the ray's origin, infinity allowed.
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

    /// Whether the lens lets these rays pass.
    template <int N>
    void pass(const Entry (&entries)[N], bool (&passed)[N]) const {
        LensRays<double, N> rays;
        trace(entries, rays);
        for (int i = 0; i < N; ++i) passed[i] = rays.status[i] == 0;
    }

    /// Where the light of entries meets the film, mm; NaN where the lens blocks it.
    template <int N>
    void land(const Entry (&entries)[N], Vec2<double> (&places)[N]) const {
        constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
        LensRays<double, N> rays;
        trace(entries, rays);
        for (int i = 0; i < N; ++i)
            places[i] = rays.status[i] == 0 ? film_.landing(rays.origin[i], rays.direction[i]) : Entry{kNone, kNone};
    }

    /// Light for each area of the entry plane, over that in its middle: even in solid angle.
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
