#pragma once
#include "../pupil/pupil_view.hpp"
#include "../trace/lens_path.hpp"

namespace REALCAM_NAMESPACE {

/// The lens with a round stop of the same area: its light is then the same in every direction from the axis.
LensSystem with_round_stop(LensSystem lens);

/// All light that reaches one film point on the +x axis, by the optical direction cosines of its rays at the film: in
/// them it is even (pupil_view.hpp).
class FilmBundle {
public:
    /// x: beside the film point's radius; y: along it.
    using Entry = Vec2<double>;

    bool mirrored = true;  ///< x and -x are alike
    Entry middle, reach;  ///< of a rectangle that holds what passes

    /// `path`: to the scene, of a lens with a round stop; it must outlive this. `film_distance`: from the last vertex.
    FilmBundle(const LensPath<double>& path, double film_distance, const PupilView& pupil, double film_radius);

    /// Whether the lens lets these rays pass.
    template <int N>
    void pass(const Entry (&entries)[N], bool (&passed)[N]) const {
        LensRays<double, N> rays;
        trace(entries, rays);
        for (int i = 0; i < N; ++i) passed[i] = rays.status[i] == 0;
    }

    /// Rays in front of the lens, relative to its front vertex.
    template <int N>
    void trace(const Entry (&entries)[N], LensRays<double, N>& rays) const {
        for (int i = 0; i < N; ++i) {
            const double l = entries[i].y, m = entries[i].x, rest = index_ * index_ - l * l - m * m;
            rays.origin.set(i, origin_);
            rays.direction.set(i, {l, m, -sqrt_or_zero(rest)});
            rays.status[i] = rest > 0 ? 0 : static_cast<int>(RayStatus::missed);
        }
        trace_lens(view_, rays);
    }

private:
    LensView<double> view_;
    double index_;
    Vec3d origin_;
};

}  // namespace REALCAM_NAMESPACE
