#pragma once
#include "../pupil/bundle_quadrature.hpp"
#include "../pupil/film_surface.hpp"
#include "../trace/lens_path.hpp"

namespace REALCAM_NAMESPACE {

/// The lens with a round stop of the same area: its light is then the same in every direction from the axis.
LensSystem with_round_stop(LensSystem lens);

/// All light that reaches one film point, by the optical direction cosines of its rays in the film's tangent plane: in
/// them it is even (pupil_view.hpp).
class FilmBundle {
public:
    using Entry = Vec2<double>;

    Entry middle, reach;  ///< of a rectangle that holds what passes, or nearly
    bool mirrored;        ///< x and -x are alike

    /// `path`: to the scene, from the frame of the film (film_path_ends); it must outlive this.
    FilmBundle(const LensPath<double>& path, FilmSurface<double> film, Vec2<double> at, EntryRectangle in,
               bool mirrored = false)
        : middle(in.middle),
          reach(in.reach),
          mirrored(mirrored),
          view_(path.view()),
          index_(path.entry_index),
          film_(film),
          at_(at) {}

    /// Whether the lens lets these rays pass.
    template <int N>
    void pass(const Entry (&entries)[N], bool (&passed)[N]) const {
        LensRays<double, N> rays;
        trace(entries, rays);
        for (int i = 0; i < N; ++i) passed[i] = rays.status[i] == 0;
    }

    /// Rays in front of the lens.
    template <int N>
    void trace(const Entry (&entries)[N], LensRays<double, N>& rays) const {
        const Vec3d from = film_.place(at_);
        for (int i = 0; i < N; ++i) {
            const auto [l, m] = entries[i];
            const double rest = index_ * index_ - l * l - m * m;
            rays.origin.set(i, from);
            rays.direction.set(i, film_.direction(at_, {l, m, -sqrt_or_zero(rest)}));
            rays.status[i] = rest > 0 ? 0 : static_cast<int>(RayStatus::missed);
        }
        trace_lens(view_, rays);
    }

private:
    LensView<double> view_;
    double index_;
    FilmSurface<double> film_;
    Vec2<double> at_;
};

}  // namespace REALCAM_NAMESPACE
