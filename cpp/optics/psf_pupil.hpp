#pragma once
#include "psf.hpp"

namespace REALCAM_NAMESPACE {

/// The plane waves of a colour at even steps of their slopes: what a Fourier transform takes. Its size x size sums at
/// pitch_um, |.|^2 times `scale`, are the colour's share of the PSF, with the array's middle at index 0, and periodic.
struct PsfPupil {
    int size;
    std::vector<std::complex<double>> values;  ///< row by row, from slope 0 on: k at index k modulo size
    double scale;
};

namespace psf_pupil_detail {

/// A cell of the grid of slopes.
struct Cell : LocalWave {
    bool passes;
};

/// Newton's method from a cell nearby.
inline std::optional<Cell> cell_with(const PointBundle& bundle, Vec2<double> slope, LocalWave near, double tolerance) {
    for (int i = 0; i < 20; ++i) {
        const std::optional<LocalWave> next = local_wave(bundle, near.entry_at(slope));
        if (!next) return {};
        near = *next;
        if (std::hypot(near.wave.slope.x - slope.x, near.wave.slope.y - slope.y) < tolerance) {
            const PointBundle::Entry entries[1] = {near.entry};
            bool passes[1];
            bundle.pass(entries, passes);
            return Cell{near, passes[0]};
        }
    }
    return {};
}

/// Share of a cell that passes, by rays over it.
inline double share_of(const PointBundle& bundle, const LocalWave& cell, double step) {
    constexpr int kAcross = 16;
    int count = 0;
    for (int row = 0; row < kAcross; ++row) {
        PointBundle::Entry entries[kAcross];
        bool passes[kAcross];
        for (int i = 0; i < kAcross; ++i)
            entries[i] = cell.entry_at({cell.wave.slope.x + step * ((i + 0.5) / kAcross - 0.5),
                                        cell.wave.slope.y + step * ((row + 0.5) / kAcross - 0.5)});
        bundle.pass(entries, passes);
        count += static_cast<int>(std::count(passes, passes + kAcross, true));
    }
    return static_cast<double>(count) / (kAcross * kAcross);
}

/// A power of two that holds the whole spot twice, and a pupil of 256 cells. Throws InputError where that is too many.
inline int transform_size(const psf_detail::Part& part, const Psf& psf) {
    const PointBundle& bundle = part.bundle;
    const double across = std::max(bundle.slope_high.x - bundle.slope_low.x, bundle.slope_high.y - bundle.slope_low.y);
    const double detail = 2e3 * std::numbers::pi / (bundle.wave_number * across);
    const double spot = 1e3 * std::max(bundle.spot.x + std::fabs(part.centre.x), bundle.spot.y + std::fabs(part.centre.y));
    const double wanted = std::max({2.0 * psf.size, 256 * detail / psf.pitch_um, 4 * spot / psf.pitch_um});
    if (!(wanted <= 4096))
        throw InputError("psf: the wavefront is too steep for the method \"fft\": a transform of " +
                         std::to_string(std::lround(wanted)) + " x " + std::to_string(std::lround(wanted)) +
                         " points, more than 4096 x 4096, would have to hold the spot at this pitch; method \"direct\" "
                         "has no such limit");
    int size = 2;
    while (size < wanted) size *= 2;
    return size;
}

}  // namespace psf_pupil_detail

/// Edges of the light cut cells, which then count by the share of them that passes.
inline PsfPupil psf_pupil(const psf_detail::Part& part, const Psf& psf, const RayLoop& loop = {}) {
    using namespace psf_pupil_detail;
    const PointBundle& bundle = part.bundle;
    PsfPupil pupil{transform_size(part, psf), {}, 0};
    const double step = 2e3 * std::numbers::pi / (bundle.wave_number * pupil.size * psf.pitch_um);
    // Beyond the outermost rays that were looked at.
    const double beyond = 0.05 * std::max(bundle.slope_high.x - bundle.slope_low.x, bundle.slope_high.y - bundle.slope_low.y);
    const auto cell_of = [&](double slope) { return static_cast<int>(std::lround(slope / step)); };
    const int left = cell_of(bundle.slope_low.x - beyond), bottom = cell_of(bundle.slope_low.y - beyond);
    const int columns = cell_of(bundle.slope_high.x + beyond) - left + 1;
    const int rows = cell_of(bundle.slope_high.y + beyond) - bottom + 1;
    std::vector<std::optional<Cell>> cells(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
    const auto at = [&](int column, int row) -> std::optional<Cell>& {
        return cells[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column)];
    };
    const std::optional<LocalWave> middle = local_wave(bundle, bundle.middle);
    if (!middle) throw InputError("psf: no ray in the middle of the light reaches the film; use the method \"direct\"");
    loop.for_all(static_cast<std::size_t>(rows), [&](std::size_t first, std::size_t last) {
        for (auto row = static_cast<int>(first); row < static_cast<int>(last); ++row) {
            std::optional<LocalWave> before;
            for (int column = 0; column < columns; ++column) {
                const Vec2<double> slope = {(left + column) * step, (bottom + row) * step};
                std::optional<Cell>& cell = at(column, row);
                if (before) cell = cell_with(bundle, slope, *before, 1e-6 * step);
                if (!cell) cell = cell_with(bundle, slope, *middle, 1e-6 * step);
                before = cell;
            }
        }
    });
    const auto passes = [&](int column, int row) {
        return column >= 0 && row >= 0 && column < columns && row < rows && at(column, row) && at(column, row)->passes;
    };
    pupil.values.assign(static_cast<std::size_t>(pupil.size) * static_cast<std::size_t>(pupil.size), 0);
    std::vector<double> shares(cells.size());
    loop.for_all(cells.size(), [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            const int column = static_cast<int>(i) % columns, row = static_cast<int>(i) / columns;
            int passing = 0;
            for (int k = 0; k < 9; ++k) passing += passes(column + k % 3 - 1, row + k / 3 - 1);
            if (cells[i] && passing > 0) shares[i] = passing == 9 ? 1 : share_of(bundle, *cells[i], step);
        }
    });
    double energy = 0;
    const auto wrapped = [&](int k) { return static_cast<std::size_t>((k % pupil.size + pupil.size) % pupil.size); };
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column) {
            const double share = shares[static_cast<std::size_t>(row * columns + column)];
            if (share == 0) continue;
            const Cell& cell = *at(column, row);
            const double density = bundle.energy(cell.entry) / std::fabs(cell.determinant());
            energy += share * density * step * step;
            const double path =
                cell.wave.path + cell.wave.slope.x * part.centre.x + cell.wave.slope.y * part.centre.y;
            pupil.values[wrapped(bottom + row) * static_cast<std::size_t>(pupil.size) + wrapped(left + column)] +=
                std::polar(share * std::sqrt(density) * step * step, bundle.wave_number * path);
        }
    pupil.scale = 1e-6 * part.weight * std::pow(bundle.wave_number / (2 * std::numbers::pi), 2) / energy;
    return pupil;
}

}  // namespace REALCAM_NAMESPACE
