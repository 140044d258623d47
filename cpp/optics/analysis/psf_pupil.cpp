#include "psf_pupil.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "../../math/hypotenuse.hpp"

namespace realcam {

namespace {

/// A cell of the grid of slopes.
struct Cell : LocalWave {
    bool passes;
};

/// Tolerance of the slope of a cell's ray, relative to the cell. The extrapolated path at the exact slope is then right
/// to the square of that, in units of the wavefront's bending over a cell: to a few millionths of a radian.
constexpr double kClose = 1e-3;

/// Finds the ray of a slope by Newton's method, starting with a nearby wave. Returns std::nullopt if it does not
/// converge.
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

/// Part of a cell that passes.
struct Piece {
    double share;
    Vec2<double> middle;  ///< its mean slope
};

/// Samples the cell of this slope by rays, whose entries are extrapolated from a nearby wave.
Piece piece_of(const PointBundle& bundle, const LocalWave& near, Vec2<double> slope, double step) {
    constexpr int kAcross = 16;
    int count = 0;
    Vec2<double> sum{0, 0};
    for (int row = 0; row < kAcross; ++row) {
        const auto from_middle = [&](int i) { return step * ((i + 0.5) / kAcross - 0.5); };
        PointBundle::Entry entries[kAcross];
        bool passes[kAcross];
        for (int i = 0; i < kAcross; ++i)
            entries[i] = near.entry_at({slope.x + from_middle(i), slope.y + from_middle(row)});
        bundle.pass(entries, passes);
        for (int i = 0; i < kAcross; ++i) {
            if (!passes[i]) continue;
            ++count;
            sum = {sum.x + from_middle(i), sum.y + from_middle(row)};
        }
    }
    if (count == 0) return {0, slope};
    return {static_cast<double>(count) / (kAcross * kAcross), {slope.x + sum.x / count, slope.y + sum.y / count}};
}

struct Light {
    double energy, amplitude;
    Vec2<double> middle;  ///< mean slope
    const LocalWave* near = nullptr;
};

/// Returns the transform's size, a power of two, for a pupil of at least 256 cells. The wavefront must be nearly flat
/// over a partial cell at the edge of the light, because only the cell's open fraction and mean slope are known. Throws
/// InputError if that takes too many points.
int transform_size(const psf_detail::Part& part, const Psf& psf) {
    const PointBundle& bundle = part.bundle;
    const double across = std::max(bundle.slope_high.x - bundle.slope_low.x, bundle.slope_high.y - bundle.slope_low.y);
    const double detail = 2e3 * std::numbers::pi / (bundle.wave_number * across);
    const double spot =
        1e3 * std::max(bundle.spot.x + std::fabs(part.centre.x), bundle.spot.y + std::fabs(part.centre.y));
    const auto wanted = [&](double spots) {
        return std::max({2.0 * psf.size, 256 * detail / psf.pitch_um, spots * spot / psf.pitch_um});
    };
    constexpr int kMost = 4096;
    if (!(wanted(12) <= kMost))
        throw InputError("psf: the wavefront is too steep for the method \"fft\": a transform of " +
                         std::to_string(std::lround(wanted(12))) +
                         " points across, more than 4096, would have to follow it at this pitch; the method \"direct\" "
                         "has no such limit");
    int size = 2;
    while (size < std::min(wanted(24), 1.0 * kMost)) size *= 2;
    return size;
}

}  // namespace

PsfPupil psf_pupil(const psf_detail::Part& part, const Psf& psf, const RayLoop& loop) {
    const PointBundle& bundle = part.bundle;
    PsfPupil pupil{transform_size(part, psf), {}, 0};
    const double step = 2e3 * std::numbers::pi / (bundle.wave_number * pupil.size * psf.pitch_um);
    // Margin beyond the outermost probe rays.
    const double beyond =
        0.05 * std::max(bundle.slope_high.x - bundle.slope_low.x, bundle.slope_high.y - bundle.slope_low.y);
    const auto cell_of = [&](double slope) { return static_cast<int>(std::lround(slope / step)); };
    const int left = cell_of(bundle.slope_low.x - beyond), bottom = cell_of(bundle.slope_low.y - beyond);
    const int columns = cell_of(bundle.slope_high.x + beyond) - left + 1;
    const int rows = cell_of(bundle.slope_high.y + beyond) - bottom + 1;
    std::vector<std::optional<Cell>> cells(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
    const auto at = [&](int column, int row) -> std::optional<Cell>& {
        return cells[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                     static_cast<std::size_t>(column)];
    };
    const std::optional<LocalWave> middle = local_wave(bundle, bundle.middle);
    if (!middle) throw InputError("psf: no ray in the middle of the light reaches the film; use the method \"direct\"");
    loop.for_all(static_cast<std::size_t>(rows), [&](std::size_t first, std::size_t last) {
        for (auto row = static_cast<int>(first); row < static_cast<int>(last); ++row) {
            // From the middle column outwards, each cell starts with the last one that passes: rays beyond the edge of
            // the light may be erratic.
            for (const int side : {1, -1}) {
                std::optional<LocalWave> before;
                for (int column = columns / 2 - (side < 0); column >= 0 && column < columns; column += side) {
                    const Vec2<double> slope = {(left + column) * step, (bottom + row) * step};
                    std::optional<Cell>& cell = at(column, row);
                    cell = cell_with(bundle, slope, before ? *before : *middle, kClose * step);
                    if (cell && cell->passes) before = cell;
                }
            }
        }
    });
    const auto passes = [&](int column, int row) {
        return column >= 0 && row >= 0 && column < columns && row < rows && at(column, row) && at(column, row)->passes;
    };
    std::vector<Light> lights(cells.size());
    loop.for_all(cells.size(), [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            const int column = static_cast<int>(i) % columns, row = static_cast<int>(i) / columns;
            int passing = 0;
            // The centre of a cell on the edge of the light may have no ray, or may lie beyond the rim of an asphere,
            // where the surface has another shape. A neighbouring cell then locates its rays.
            const LocalWave* near = passes(column, row) ? &*cells[i] : nullptr;
            for (int k = 0; k < 9; ++k) {
                if (!passes(column + k % 3 - 1, row + k / 3 - 1)) continue;
                ++passing;
                if (!near) near = &*at(column + k % 3 - 1, row + k / 3 - 1);
            }
            if (passing == 0) continue;
            const Vec2<double> slope = {(left + column) * step, (bottom + row) * step};
            const Piece piece = passing == 9 ? Piece{1, slope} : piece_of(bundle, *near, slope, step);
            const double density = bundle.energy(near->entry) / std::fabs(near->determinant()) * step * step;
            lights[i] = {piece.share * density, piece.share * std::sqrt(density) * step, piece.middle, near};
        }
    });
    pupil.values.assign(static_cast<std::size_t>(pupil.size) * static_cast<std::size_t>(pupil.size), 0);
    double energy = 0;
    const auto add = [&](const Light& light, int x, int y, double weight) {
        if (weight == 0) return;
        const auto wrapped = [&](int k) {
            return static_cast<std::size_t>((k % pupil.size + pupil.size) % pupil.size);
        };
        const Vec2<double> slope = {x * step, y * step};
        const double path = light.near->path_at(slope) + slope.x * part.centre.x + slope.y * part.centre.y;
        pupil.values[wrapped(y) * static_cast<std::size_t>(pupil.size) + wrapped(x)] +=
            std::polar(weight * light.amplitude, bundle.wave_number * path);
    };
    for (const Light& light : lights) {
        if (!light.near) continue;
        energy += light.energy;
        // The mean slope lies between four grid points, which share the light so that its mean is preserved.
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
