#pragma once
#include <optional>

#include "../pupil/bundle_quadrature.hpp"
#include "point_bundle.hpp"

namespace REALCAM_NAMESPACE {

/// amplitude exp(i k (path + slope . q)) at a place q of the film, mm from the chief ray; k the wave number.
struct PlaneWave {
    Vec2<double> slope;
    double path, amplitude;
};

/// Light of a bundle, sampled. |sum of the plane waves|^2 times (k / 2 pi)^2 over `energy` is irradiance: its integral
/// over the film is 1.
struct PlaneWaves {
    std::vector<PlaneWave> waves;
    double energy;
    bool mirrored;  ///< each wave is half its own and half its mirror image's, of slope.x the other way
};

PlaneWaves with_mirror_images(const PlaneWaves& light);

/// Phase, in radians, by which the plane waves of a bundle differ on a window of the film: from the middle of what
/// passes to its edge, at the place where they differ most. `centre` and half the window's side are in mm, from the
/// chief ray.
double largest_phase(const PointBundle& bundle, Vec2<double> centre, double half_window);

/// Enough rays for a phase of z. On a spoke Gauss's rule needs z / 4 nodes, and the trapezoid rule needs z spokes. The
/// errors fall off within some cube roots of z beyond, as Bessel functions of an order beyond their argument do. The
/// least number is for edges with corners, at which the trapezoid rule has an error of second order.
BundleSampling sampling_for(double phase);

/// The plane wave of the light about a place of the entry plane, and how its slope depends on the place.
struct LocalWave {
    PointBundle::Entry entry;
    WaveRay wave;
    Vec2<double> by_x, by_y;  ///< derivatives of the slope, 1/mm
    Vec2<double>
        at;  ///< where the ray lands, mm from the chief ray: less the derivative of the wave's path by its slope

    double determinant() const { return by_x.x * by_y.y - by_x.y * by_y.x; }
    /// The place that has this slope, as far as the derivatives tell.
    PointBundle::Entry entry_at(Vec2<double> slope) const;
    double path_at(Vec2<double> slope) const {
        return wave.path - at.x * (slope.x - wave.slope.x) - at.y * (slope.y - wave.slope.y);
    }
};

/// Nothing where no ray comes through, even without rims.
std::optional<LocalWave> local_wave(const PointBundle& bundle, PointBundle::Entry entry);

/// The bundle's light as plane waves. The amplitude of each is the root of its energy times the range of slopes that it
/// stands for. By Parseval's theorem the sum of the waves then has the energy of the rays. Where the wavefront is steep
/// it is the rays' density on the film.
PlaneWaves plane_waves(const PointBundle& bundle, BundleSampling sampling, const RayLoop& loop = {});

}  // namespace REALCAM_NAMESPACE
