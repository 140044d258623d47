#pragma once
#include "../pupil/bundle_quadrature.hpp"
#include "../pupil/film_surface.hpp"
#include "../trace/lens_path.hpp"

namespace REALCAM_NAMESPACE {

/// Returns the lens with a round stop of the same area, so that its light is rotationally symmetric.
LensSystem with_round_stop(LensSystem lens);

/// All light that reaches one film point, parametrised by the optical direction cosines of its rays in the film's
/// tangent plane, in which it is uniform (pupil_view.hpp).
class FilmBundle {
public:
    using Entry = Vec2<double>;

    Entry middle, reach;  ///< approximate bounds of what passes: centre and half sides
    bool mirrored;  ///< true: symmetric in x

    /// `path`: from the film frame to the scene (film_path_ends); it must outlive this object.
    FilmBundle(const LensPath<double>& path, FilmSurface<double> film, Vec2<double> at, EntryRectangle in,
               bool mirrored = false)
        : middle(in.middle),
          reach(in.reach),
          mirrored(mirrored),
          view_(path.view()),
          index_(path.entry_index),
          film_(film),
          at_(at) {}

    /// For each entry: true if its ray passes the lens.
    template <int N>
    void pass(const Entry (&entries)[N], bool (&passed)[N]) const {
        LensRays<double, N> rays;
        trace(entries, rays);
        for (int i = 0; i < N; ++i) passed[i] = rays.status[i] == 0;
    }

    /// Traces rays through the lens to the scene.
    template <int N>
    void trace(const Entry (&entries)[N], LensRays<double, N>& rays) const {
        const Vec3d from = film_.point(at_);
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
