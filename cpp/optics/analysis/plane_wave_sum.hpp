#pragma once
#include <complex>

#include "plane_waves.hpp"

namespace REALCAM_NAMESPACE {

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
