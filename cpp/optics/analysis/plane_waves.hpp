#pragma once
#include <complex>
#include <optional>

#include "../pupil/bundle_quadrature.hpp"
#include "point_bundle.hpp"

namespace REALCAM_NAMESPACE {

/// Plane wave amplitude exp(i k (path + slope . q)) at a film point q, mm from the chief ray; k is the wave number.
struct PlaneWave {
    Vec2<double> slope;
    double path, amplitude;
};

/// Light of a bundle as sampled plane waves. |sum of the plane waves|^2 times (k / 2 pi)^2 over `energy` is irradiance:
/// its integral over the film is 1.
struct PlaneWaves {
    std::vector<PlaneWave> waves;
    double energy;
    bool mirrored;  ///< each wave stands half for itself, half for its mirror image with -slope.x
};

PlaneWaves with_mirror_images(const PlaneWaves& light);

/// Largest phase, in radians, by which the plane waves of a bundle differ on a window of the film, measured from the
/// centre of what passes to its edge. `centre` and half the window's side are in mm, from the chief ray.
double largest_phase(const PointBundle& bundle, Vec2<double> centre, double half_window);

/// Returns a sampling sufficient for a phase of z. On a radial scan line Gauss's rule needs z / 4 nodes, and the
/// trapezoid rule needs z scan lines. The errors fall off within some cube roots of z beyond, as Bessel functions of an
/// order beyond their argument do. The minimum serves edges with corners, at which the trapezoid rule has an error of
/// second order.
BundleSampling sampling_for(double phase);

/// Plane wave of the light near a point of the entry plane, and how its slope depends on that point.
struct LocalWave {
    PointBundle::Entry entry;
    WaveRay wave;
    Vec2<double> by_x, by_y;  ///< derivatives of the slope by the entry, 1/mm
    Vec2<double>
        at;  ///< film point of the ray, mm from the chief ray: minus the derivative of the wave's path by its slope

    double determinant() const { return by_x.x * by_y.y - by_x.y * by_y.x; }
    /// Entry point with this slope, by linear extrapolation.
    PointBundle::Entry entry_at(Vec2<double> slope) const;
    double path_at(Vec2<double> slope) const {
        return wave.path - at.x * (slope.x - wave.slope.x) - at.y * (slope.y - wave.slope.y);
    }
};

/// Returns std::nullopt if the ray, or one of its two neighbours, does not reach the film, even without rims.
std::optional<LocalWave> local_wave(const PointBundle& bundle, PointBundle::Entry entry);

/// Returns the bundle's light as plane waves. The amplitude of each is the root of its energy times the range of slopes
/// that it represents. By Parseval's theorem the sum of the waves then has the energy of the rays. Where the wavefront
/// is steep, the irradiance is the rays' density on the film.
PlaneWaves plane_waves(const PointBundle& bundle, BundleSampling sampling, const RayLoop& loop = {});

/// Square grid of film points, row by row: size x size points at `pitch` mm. Point (size / 2, size / 2) lies at
/// `centre`, mm from the chief ray.
struct FilmGrid {
    int size;
    double pitch;
    Vec2<double> centre;

    double offset(int i) const { return (i - size / 2) * pitch; }
};

/// Sum of plane waves on a grid of points, with phases in double.
///
/// On a grid each wave is a product of a function of x and one of y, so the sum is a product of matrices. Points at x
/// and -x share the cosine and the sine of x, so that a point takes two multiplications and additions per wave. Light
/// that is its own mirror image has no sines, and takes one.
class PlaneWaveSum {
public:
    PlaneWaveSum(FilmGrid grid, double wave_number);

    /// Adds plane waves. Mirrored light requires a grid whose centre has x = 0.
    void add(const PlaneWaves& light, const RayLoop& loop);

    /// Complex amplitude at column x and row y.
    std::complex<double> operator()(int x, int y) const;

private:
    static constexpr std::size_t kWaves = 256, kWidth = 8, kAtOnce = 4, kTurns = 16;

    /// Tabulates cos and sin of k slope.x x for x = 0, pitch, 2 pitch ..., for each wave.
    void tabulate(const PlaneWave* waves, std::size_t count);

    void add_to_rows(const PlaneWave* waves, std::size_t count, bool mirrored, std::size_t first, std::size_t last);

    void start(const PlaneWave* waves, std::size_t count, std::size_t row, double* re, double* im) const;

    void add_four(const double* re, const double* im, const double* of_x, double* re_sums, double* im_sums) const;

    FilmGrid grid_;
    double wave_number_;
    std::size_t half_, rows_;
    std::vector<double> sums_, cos_, sin_;
};

}  // namespace REALCAM_NAMESPACE
