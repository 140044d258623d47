#pragma once
#include <complex>
#include <optional>

#include "../pupil/bundle_quadrature.hpp"
#include "point_bundle.hpp"

// Light of one object point on the film as a sum of plane waves: the diffraction integral of the PSF.

namespace REALCAM_NAMESPACE {

/// Plane wave: amplitude * exp(i k (path + slope . q)) at a film point q, mm from the chief ray, for the wave number k.
struct PlaneWave {
    Vec2<double> slope;  ///< see WaveRay
    double path;  ///< mm
    double amplitude;
};

/// Light of a bundle as a list of plane waves. The irradiance is |sum of the waves|^2 (k / 2 pi)^2 / `energy`; its
/// integral over the film is 1.
struct PlaneWaves {
    std::vector<PlaneWave> waves;
    double energy;  ///< energy of the rays, in the unit of PointBundle::energy times area
    bool mirrored;  ///< true: half of each wave's amplitude belongs to its mirror image with -slope.x
};

/// Returns mirrored light with its mirror images as waves of their own.
PlaneWaves with_mirror_images(const PlaneWaves& light);

/// Returns the largest phase difference, rad, between the plane waves at the centre and at the edge of the light, over
/// a square window on the film. `centre`: centre of the window, mm from the chief ray; `half_window`: half its side,
/// mm.
double largest_phase(const PointBundle& bundle, Vec2<double> centre, double half_window);

/// Returns a sampling that is sufficient for a largest phase z, rad. On a radial scan line Gauss's rule needs z / 4
/// nodes, and the trapezoid rule over angles needs z scan lines. Errors vanish a few cube roots of z above these
/// numbers, as Bessel functions do whose order exceeds their argument. The minimum of 160 scan lines is for edges with
/// corners, at which the trapezoid rule has an error of second order.
BundleSampling sampling_for(double phase);

/// Plane wave of the light near a point of the entry plane, with its derivatives by that point.
struct LocalWave {
    PointBundle::Entry entry;  ///< the point, mm
    WaveRay wave;
    Vec2<double> by_x, by_y;  ///< derivatives of the slope by the entry, 1/mm
    /// Film point of the ray, mm from the chief ray. It is the negative derivative of the wave's path by its slope.
    Vec2<double> at;

    /// Returns the area of slopes per area of the entry plane, with its sign, 1/mm^2.
    double determinant() const { return by_x.x * by_y.y - by_x.y * by_y.x; }
    /// Returns the entry point of the wave with this slope, by linear extrapolation.
    PointBundle::Entry entry_at(Vec2<double> slope) const;
    /// Returns the path of the wave with this slope, by linear extrapolation, mm.
    double path_at(Vec2<double> slope) const {
        return wave.path - at.x * (slope.x - wave.slope.x) - at.y * (slope.y - wave.slope.y);
    }
};

/// Computes the wave at an entry point by tracing its ray and two close neighbours through the lens without rims.
/// Returns std::nullopt if one of them does not reach the film.
std::optional<LocalWave> local_wave(const PointBundle& bundle, PointBundle::Entry entry);

/// Returns the light of a bundle as plane waves, one for each ray of the quadrature. The amplitude of a wave is the
/// square root of its energy times the area of slopes that it represents. By Parseval's theorem the sum of the waves
/// then has the energy of the rays, and where the wavefront is steep, its irradiance is the density of rays on the
/// film.
PlaneWaves plane_waves(const PointBundle& bundle, BundleSampling sampling, const RayLoop& loop = {});

/// Square grid of film points, row by row: size x size points at `pitch` mm. Point (size / 2, size / 2) lies at
/// `centre`, mm from the chief ray.
struct FilmGrid {
    int size;
    double pitch;
    Vec2<double> centre;

    /// Returns the offset of column or row i from `centre`, mm.
    double offset(int i) const { return (i - size / 2) * pitch; }
};

/// Sum of plane waves on a grid of points, with phases in double.
///
/// On a grid each wave is the product of a function of x and a function of y, so that the sum is a product of matrices.
/// Points at x and -x share the cosine and the sine of x, so that a point takes two multiplications and additions per
/// wave. For mirrored light the sine terms cancel, and a point takes one.
class PlaneWaveSum {
public:
    /// `wave_number`: 1/mm.
    PlaneWaveSum(FilmGrid grid, double wave_number);

    /// Adds plane waves to the sum. For mirrored light, the centre of the grid must have x = 0.
    void add(const PlaneWaves& light, const RayLoop& loop);

    /// Complex amplitude at column x and row y.
    std::complex<double> operator()(int x, int y) const;

private:
    static constexpr std::size_t kMaxWaves = 256;  ///< waves that are added together
    static constexpr std::size_t kVectorWidth = 8;  ///< columns are padded to a multiple of it
    static constexpr std::size_t kUnroll = 4;  ///< waves of one call of add_group
    static constexpr std::size_t kRowsPerRestart = 16;  ///< rows after which phases are computed from scratch

    /// Tabulates the cosine and sine of k slope.x x at x = 0, pitch, 2 pitch, ... for each wave.
    void tabulate(const PlaneWave* waves, std::size_t count);

    /// Adds the waves to rows `first` to `last` - 1.
    void add_to_rows(const PlaneWave* waves, std::size_t count, bool mirrored, std::size_t first, std::size_t last);

    /// Computes real and imaginary part of each wave's amplitude at a row, at the centre column.
    void set_phases(const PlaneWave* waves, std::size_t count, std::size_t row, double* re, double* im) const;

    /// Adds kUnroll waves to the sums of a row: the sum of re[w] * x_factors[w][a] to re_sums[a], and of im likewise.
    void add_group(const double* re, const double* im, const double* x_factors, double* re_sums, double* im_sums) const;

    FilmGrid grid_;
    double wave_number_;
    std::size_t half_;  ///< number of tabulated distances x >= 0 from the centre column
    std::size_t rows_;
    std::vector<double> sums_;  ///< for each row: half_ sums of each of re cos, im cos, re sin, im sin
    std::vector<double> cos_, sin_;  ///< tabulated factors, half_ for each wave
};

}  // namespace REALCAM_NAMESPACE
