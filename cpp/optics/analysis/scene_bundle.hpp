#pragma once
#include "film_chief_ray.hpp"

namespace REALCAM_NAMESPACE {

/// All light of a scene point in the plane of the axis (x and z) that reaches the film. It is described by where it
/// crosses a plane perpendicular to one of its rays. There it is even, except for the obliquity of the other rays.
class SceneBundle {
public:
    /// x: across the plane of the axis; y: in it. mm from where the ray leaves the lens.
    using Entry = Vec2<double>;

    bool mirrored = true;  ///< x and -x are alike
    Entry middle, reach;   ///< of a rectangle that holds what passes

    /// `path`: to the film, of a lens with a round stop; it must outlive this. `ray`: from the lens to the point, unit
    /// direction. `distance`: of the point from the ray's origin, infinity allowed.
    SceneBundle(const LensPath<double>& path, double film_distance, const SceneRay& ray, double distance, Entry middle,
                Entry reach);

    /// Whether the lens lets these rays pass.
    template <int N>
    void pass(const Entry (&entries)[N], bool (&passed)[N]) const {
        LensRays<double, N> rays;
        trace(entries, rays);
        for (int i = 0; i < N; ++i) passed[i] = rays.status[i] == 0;
    }

    /// How far beside the axis the light of an entry meets the film, mm; NaN where the lens blocks it.
    double film_height(Entry entry) const;

    /// Light for each area of the entry plane, over that in its middle: even in solid angle.
    double light(Entry entry) const {
        return std::pow(1 + (entry.x * entry.x + entry.y * entry.y) * inverse_distance_ * inverse_distance_, -1.5);
    }

private:
    template <int N>
    void trace(const Entry (&entries)[N], LensRays<double, N>& rays) const {
        const Vec3d towards = ray_.direction, across = {-towards.z, 0, towards.x}, beside = {0, 1, 0};
        for (int i = 0; i < N; ++i) {
            const Vec3d offset = entries[i].y * across + entries[i].x * beside;
            rays.origin.set(i, ray_.origin + offset);
            rays.direction.set(i, index_ * normalized(inverse_distance_ * offset - towards));
            rays.status[i] = 0;
        }
        trace_lens(view_, rays);
    }

    LensView<double> view_;
    double index_, film_distance_;
    SceneRay ray_;
    double inverse_distance_;  ///< 1/mm
};

}  // namespace REALCAM_NAMESPACE
