#pragma once
#include <array>
#include <vector>

#include "../../math/vec3.hpp"
#include "../prescription/lens_system.hpp"
#include "../pupil/bundle_quadrature.hpp"
#include "../pupil/film_surface.hpp"
#include "../trace/lens_path.hpp"
#include "../trace/lens_polynomial_view.hpp"
#include "../trace/ray_loop.hpp"

namespace REALCAM_NAMESPACE {

/// Exit pupil as seen from a film point, in optical direction cosines (index times direction) of light that travels
/// towards the film: x and y components in the tangent plane of the film.
struct FilmPupil {
    /// Irradiance for unit radiance of the whole scene: the area of the pupil. At the centre of a rotationally
    /// symmetric lens it is pi sin^2(theta').
    double irradiance = 0;
    std::vector<std::array<Vec2<double>, 2>> outline;  ///< segments of the pupil's edge, each with its end points
};

/// Computes the exit pupil of a film point (mm) by real rays at one wavelength. Its edges are found on radial scan
/// lines about the chief ray; the diaphragm has its real shape, with blades. Returns an empty outline and an irradiance
/// of 0 if no ray of the film point reaches the centre of the stop.
FilmPupil film_pupil(const LensSystem& lens, double wavelength_nm, Vec2<double> film, const RayLoop& loop = {});

/// Returns the lens with its iris replaced by a circular stop of the same area, so that its light is rotationally
/// symmetric.
LensSystem with_round_stop(LensSystem lens);

/// All light that reaches one film point (a Bundle of bundle_quadrature.hpp). The parameters of a ray, which
/// a Bundle calls its entry point, are its optical direction cosines, towards the scene, in the tangent plane of the
/// film. In these the light is uniform (pupil_view.hpp).
class FilmBundle {
public:
    using Entry = Vec2<double>;

    Entry middle, reach;  ///< approximate bounds of the entry points that pass: centre and half-sides
    bool mirrored;  ///< true: symmetric in x

    /// `path`: from the film frame to the scene (film_path_ends); it must outlive this object. `at`: film point, mm;
    /// `in`: initial `middle` and `reach`; `polynomial`: traces the rays in place of `path`, unless null.
    FilmBundle(const LensPath<double>& path, FilmSurface<double> film, Vec2<double> at, EntryRectangle in,
               bool mirrored = false, const LensPolynomialView* polynomial = nullptr)
        : middle(in.middle),
          reach(in.reach),
          mirrored(mirrored),
          view_(path.view()),
          index_(path.entry_index),
          film_(film),
          at_(at),
          polynomial_(polynomial) {}

    Vec2<double> film_point() const { return at_; }

    /// Sets passed[i] to true if the ray with entry point i passes the lens.
    template <int N>
    void pass(const Entry (&entries)[N], bool (&passed)[N]) const {
        LensRays<double, N> rays;
        trace(entries, rays);
        for (int i = 0; i < N; ++i) passed[i] = rays.status[i] == 0;
    }

    /// Traces the rays with these entry points through the lens to the scene.
    template <int N>
    void trace(const Entry (&entries)[N], LensRays<double, N>& rays) const {
        const Vec3d origin = film_.point(at_);
        for (int i = 0; i < N; ++i) {
            const auto [l, m] = entries[i];
            const double squared_z = index_ * index_ - l * l - m * m;
            rays.origin.set(i, origin);
            rays.direction.set(i, film_.direction(at_, {l, m, -sqrt_or_zero(squared_z)}));
            rays.status[i] = squared_z > 0 ? 0 : static_cast<int>(RayStatus::missed);
        }
        if (polynomial_)
            trace_polynomial(*polynomial_, film_.distance, rays);
        else
            trace_lens(view_, rays);
    }

private:
    LensView<double> view_;
    double index_;
    FilmSurface<double> film_;
    Vec2<double> at_;
    const LensPolynomialView* polynomial_;
};

}  // namespace REALCAM_NAMESPACE
