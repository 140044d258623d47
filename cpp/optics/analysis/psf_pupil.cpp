#include "psf_pupil.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "../../math/hypotenuse.hpp"

namespace realcam {

namespace {

/// Cell of the grid of slopes, with the wave at its centre.
struct Cell : LocalWave {
    bool passes;  ///< true if the ray at its centre passes the lens
};

/// Tolerance of the slope of a cell's ray, relative to the cell's size. The error of the path that is extrapolated to
/// the exact slope is the square of that times the change of the wavefront's slope over a cell: a few millionths of a
/// radian.
constexpr double kSlopeTolerance = 1e-3;

/// Finds the ray with this slope by Newton's method, starting at the wave `near`. Returns std::nullopt if the method
/// does not converge to the tolerance.
std::optional<Cell> cell_with(const PointBundle& bundle, Vec2<double> slope, LocalWave near, double tolerance) {
    for (int i = 0; i < 8; ++i) {
        const std::optional<LocalWave> next = local_wave(bundle, near.entry_at(slope));
        if (!next) return {};
        near = *next;
        if (hypotenuse(near.wave.slope.x - slope.x, near.wave.slope.y - slope.y) < tolerance) {
            const PointBundle::Entry entries[1] = {near.entry};
            bool passes[1];
            bundle.pass(entries, passes);
            return Cell{near, passes[0]};
        }
    }
    return {};
}

/// Part of a cell that passes the lens.
struct OpenPart {
    double fraction;  ///< fraction of the cell's area that passes
    Vec2<double> middle;  ///< mean slope of the part
};

/// Samples a cell, a square of side `step` about `slope`, by a grid of rays, whose entry points are extrapolated from
/// the wave `near`.
OpenPart open_part(const PointBundle& bundle, const LocalWave& near, Vec2<double> slope, double step) {
    constexpr int kRaysAcross = 16;
    int count = 0;
    Vec2<double> sum{0, 0};
    for (int row = 0; row < kRaysAcross; ++row) {
        const auto from_middle = [&](int i) { return step * ((i + 0.5) / kRaysAcross - 0.5); };
        PointBundle::Entry entries[kRaysAcross];
        bool passes[kRaysAcross];
        for (int i = 0; i < kRaysAcross; ++i)
            entries[i] = near.entry_at({slope.x + from_middle(i), slope.y + from_middle(row)});
        bundle.pass(entries, passes);
        for (int i = 0; i < kRaysAcross; ++i) {
            if (!passes[i]) continue;
            ++count;
            sum = {sum.x + from_middle(i), sum.y + from_middle(row)};
        }
    }
    if (count == 0) return {0, slope};
    return {static_cast<double>(count) / (kRaysAcross * kRaysAcross),
            {slope.x + sum.x / count, slope.y + sum.y / count}};
}

/// Light of a cell.
struct CellLight {
    double energy, amplitude;
    Vec2<double> middle;  ///< mean slope
    const LocalWave* near = nullptr;  ///< wave from which its path is extrapolated; null if no light passes
};

/// Returns the size of the transform, a power of two, for which the pupil is at least 256 cells wide and the wavefront
/// nearly flat over a cell. The latter is necessary at the edge of the light, where only the open fraction and the mean
/// slope of a cell are known. Throws InputError if the size would exceed 4096.
int transform_size(const psf_detail::ColourPart& part, const Psf& psf) {
    const PointBundle& bundle = part.bundle;
    const double slope_range =
        std::max(bundle.slope_high.x - bundle.slope_low.x, bundle.slope_high.y - bundle.slope_low.y);
    // Wavelength times f-number.
    const double resolution_um = 2e3 * std::numbers::pi / (bundle.wave_number * slope_range);
    const double spot =
        1e3 * std::max(bundle.spot.x + std::fabs(part.centre.x), bundle.spot.y + std::fabs(part.centre.y));
    const auto min_size = [&](double spots) {
        return std::max({2.0 * psf.size, 256 * resolution_um / psf.pitch_um, spots * spot / psf.pitch_um});
    };
    constexpr int kMaxSize = 4096;
    constexpr double kMinSpots = 12, kSpots = 24;  // width of the transform's window in half-sizes of the spot
    if (!(min_size(kMinSpots) <= kMaxSize))
        throw InputError("psf: the wavefront is too steep for the method \"fft\": a transform of " +
                         std::to_string(std::lround(min_size(kMinSpots))) +
                         " points across, more than 4096, would have to follow it at this pitch; the method \"direct\" "
                         "has no such limit");
    int size = 2;
    while (size < std::min(min_size(kSpots), 1.0 * kMaxSize)) size *= 2;
    return size;
}

}  // namespace

PsfPupil psf_pupil(const psf_detail::ColourPart& part, const Psf& psf, const RayLoop& loop) {
    const PointBundle& bundle = part.bundle;
    PsfPupil pupil{transform_size(part, psf), {}, 0};
    const double step = 2e3 * std::numbers::pi / (bundle.wave_number * pupil.size * psf.pitch_um);
    // Margin around the slopes of the probe rays.
    const double margin =
        0.05 * std::max(bundle.slope_high.x - bundle.slope_low.x, bundle.slope_high.y - bundle.slope_low.y);
    // Grid of cells, and the ray at the centre of each.
    const auto cell_of = [&](double slope) { return static_cast<int>(std::lround(slope / step)); };
    const int left = cell_of(bundle.slope_low.x - margin), bottom = cell_of(bundle.slope_low.y - margin);
    const int columns = cell_of(bundle.slope_high.x + margin) - left + 1;
    const int rows = cell_of(bundle.slope_high.y + margin) - bottom + 1;
    std::vector<std::optional<Cell>> cells(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
    const auto at = [&](int column, int row) -> std::optional<Cell>& {
        return cells[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                     static_cast<std::size_t>(column)];
    };
    const std::optional<LocalWave> middle = local_wave(bundle, bundle.middle);
    if (!middle)
        throw InputError("psf: no ray in the middle of the bundle reaches the film; use the method \"direct\"");
    loop.for_all(static_cast<std::size_t>(rows), [&](std::size_t first, std::size_t last) {
        for (auto row = static_cast<int>(first); row < static_cast<int>(last); ++row) {
            // From the middle column outwards, the search in each cell starts at the last cell that passes, because
            // rays beyond the edge of the light may be erratic.
            for (const int side : {1, -1}) {
                std::optional<LocalWave> last_passing;
                for (int column = columns / 2 - (side < 0); column >= 0 && column < columns; column += side) {
                    const Vec2<double> slope = {(left + column) * step, (bottom + row) * step};
                    std::optional<Cell>& cell = at(column, row);
                    cell = cell_with(bundle, slope, last_passing ? *last_passing : *middle, kSlopeTolerance * step);
                    if (cell && cell->passes) last_passing = cell;
                }
            }
        }
    });
    const auto passes = [&](int column, int row) {
        return column >= 0 && row >= 0 && column < columns && row < rows && at(column, row) && at(column, row)->passes;
    };
    // Light of each cell.
    std::vector<CellLight> cell_lights(cells.size());
    loop.for_all(cells.size(), [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            const int column = static_cast<int>(i) % columns, row = static_cast<int>(i) / columns;
            int passing = 0;
            // At the centre of a cell on the edge of the light there may be no ray, or it may hit an asphere beyond its
            // rim, where the surface has another shape. The rays of such a cell are extrapolated from a neighbouring
            // cell.
            const LocalWave* near = passes(column, row) ? &*cells[i] : nullptr;
            for (int k = 0; k < 9; ++k) {
                if (!passes(column + k % 3 - 1, row + k / 3 - 1)) continue;
                ++passing;
                if (!near) near = &*at(column + k % 3 - 1, row + k / 3 - 1);
            }
            if (passing == 0) continue;
            const Vec2<double> slope = {(left + column) * step, (bottom + row) * step};
            const OpenPart open = passing == 9 ? OpenPart{1, slope} : open_part(bundle, *near, slope, step);
            const double density = bundle.energy(near->entry) / std::fabs(near->determinant()) * step * step;
            cell_lights[i] = {open.fraction * density, open.fraction * std::sqrt(density) * step, open.middle, near};
        }
    });
    // Input of the transform.
    pupil.values.assign(static_cast<std::size_t>(pupil.size) * static_cast<std::size_t>(pupil.size), 0);
    double energy = 0;
    const auto add = [&](const CellLight& light, int x, int y, double weight) {
        if (weight == 0) return;
        const auto wrapped = [&](int k) {
            return static_cast<std::size_t>((k % pupil.size + pupil.size) % pupil.size);
        };
        const Vec2<double> slope = {x * step, y * step};
        const double path = light.near->path_at(slope) + slope.x * part.centre.x + slope.y * part.centre.y;
        pupil.values[wrapped(y) * static_cast<std::size_t>(pupil.size) + wrapped(x)] +=
            std::polar(weight * light.amplitude, bundle.wave_number * path);
    };
    for (const CellLight& light : cell_lights) {
        if (!light.near) continue;
        energy += light.energy;
        // The mean slope lies between four grid points. The light is divided among them so that its mean slope is
        // preserved.
        const double x = light.middle.x / step, y = light.middle.y / step;
        const int column = static_cast<int>(std::floor(x + 1e-9)), row = static_cast<int>(std::floor(y + 1e-9));
        const double right = std::max(x - column, 0.0), up = std::max(y - row, 0.0);
        add(light, column, row, (1 - right) * (1 - up));
        add(light, column + 1, row, right * (1 - up));
        add(light, column, row + 1, (1 - right) * up);
        add(light, column + 1, row + 1, right * up);
    }
    pupil.scale = 1e-6 * part.weight * std::pow(bundle.wave_number / (2 * std::numbers::pi), 2) / energy;
    return pupil;
}

}  // namespace realcam
