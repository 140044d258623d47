#include "pupil_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace realcam {

std::optional<DirectionBox> PupilSearch::find(Vec2<double> film, const std::optional<DirectionBox>& expected) const {
    if (expected)
        if (const auto box = find_near(film, *expected)) return box;
    const DirectionBox widest = widest_box(film);
    return find_box(film, widest, widest);
}

std::optional<DirectionBox> PupilSearch::find_near(Vec2<double> film, const DirectionBox& expected) const {
    constexpr double kMargin = 0.4;  // region may move by this fraction of its size
    return find_box(film, enlarged(expected, kMargin), widest_box(film));
}

DirectionBox PupilSearch::enlarged(const DirectionBox& box, double fraction) const {
    const DirectionBox part = gridded_part(box);
    return box.grown_by(fraction * (part.l_max - part.l_min), fraction * (part.m_max - part.m_min));
}

DirectionBox PupilSearch::widest_box(Vec2<double> film) const {
    return enlarged(whole_box(lens_.box_of_last_surface(film, film_map_)), 0.02);
}

PupilSearch::Grid::Grid(FilmMap film_map, const DirectionBox& part)
    : columns(film_map == FilmMap::radial ? 48 : 32),
      rows(film_map == FilmMap::radial ? 24 : 32),
      step_l((part.l_max - part.l_min) / columns),
      step_m((part.m_max - part.m_min) / rows) {
    for (int i = 0; i < columns; ++i) l[i] = part.l_min + (i + 0.5) / columns * (part.l_max - part.l_min);
    for (int i = 0; i < rows; ++i) m[i] = part.m_min + (i + 0.5) / rows * (part.m_max - part.m_min);
}

template <class Trace>
void PupilSearch::trace_grid(Vec2<double> film, const Grid& grid, Trace&& trace) const {
    lens_.for_each((grid.points() + kBlock - 1) / kBlock, [&](int block) {
        PupilRays rays;
        int column = block * kBlock % grid.columns, row = block * kBlock / grid.columns;
        for (int i = 0; i < kBlock; ++i) {
            rays.set(i, film, {grid.l[column], grid.m[row]});
            if (++column < grid.columns) continue;
            column = 0;
            row = std::min(row + 1, grid.rows - 1);
        }
        trace(rays, block * kBlock);
    });
}

PupilSearch::PassingRays PupilSearch::trace_grid_over(Vec2<double> film, const DirectionBox& search) const {
    const Grid grid = grid_over(search);
    bool passes[kMaxGridBlocks * kBlock];
    trace_grid(film, grid, [&](const PupilRays& rays, int first) { lens_.trace(rays, passes + first); });
    PassingRays passing;
    for (int row = 0; row < grid.rows; ++row) {
        const bool *begin = passes + row * grid.columns, *end = begin + grid.columns;
        const bool* const first = std::find(begin, end, true);
        if (first == end) continue;
        int last = grid.columns - 1;
        while (!begin[last]) --last;
        passing.count += static_cast<int>(std::count(begin, end, true));
        const PupilDirection left{grid.l[first - begin], grid.m[row]}, right{grid.l[last], grid.m[row]};
        passing.box = passing.box.extended_to(left).extended_to(right);
        passing.highest = {0.5 * (left.l + right.l), left.m};
    }
    passing.box = whole_box(passing.box);
    return passing;
}

DirectionBox PupilSearch::refined(Vec2<double> film, const DirectionBox& search, const PassingRays& passing) const {
    const Grid grid = grid_over(search);
    const double step_l = grid.step_l, step_m = grid.step_m;
    if (!is_symmetric()) return passing.box.grown_by(step_l, step_m);
    constexpr int kSteps = kBlock / 3;
    PupilRays from;
    for (int i = 0; i < kBlock; ++i) {
        const double step = (i % kSteps + 1.0) / kSteps;
        const DirectionBox& box = passing.box;
        switch (i / kSteps) {
            case 0: from.set(i, film, {box.l_min - step * step_l, 0}); break;
            case 1: from.set(i, film, {box.l_max + step * step_l, 0}); break;
            default: from.set(i, film, {passing.highest.l, box.m_max + step * step_m});
        }
    }
    bool passes[kBlock];
    lens_.trace(from, passes);
    DirectionBox box = passing.box;
    for (int i = 0; i < 3 * kSteps; ++i)
        if (passes[i]) box = box.extended_to({from.l[i], from.m[i]});
    return whole_box(box.grown_by(step_l / kSteps, step_m / kSteps));
}

std::optional<DirectionBox> PupilSearch::find_box(Vec2<double> film, DirectionBox search,
                                                  const DirectionBox& widest) const {
    constexpr int kLevels = 6;  // around the nearest ray, each grid is six times as fine as the previous one
    const int min_passing = is_symmetric() ? 48 : 64;
    std::optional<NearestRay> last;
    for (int level = 0; level < kLevels; ++level) {
        const PassingRays passing = trace_grid_over(film, search);
        if (passing.count >= min_passing)
            return extended_to_region(film, refined(film, search, passing), search, widest);
        const std::optional<NearestRay> nearest = nearest_to_stop(film, search);
        if (!nearest || (passing.count == 0 && is_dark_around(*nearest, last))) return std::nullopt;
        last = nearest;
        search = passing.count > 0 ? enlarged(refined(film, search, passing), 0.2)
                                   : whole_box(DirectionBox::around(nearest->direction, search.half_width() / 6,
                                                                    search.half_height() / 6));
    }
    const PassingRays passing = trace_grid_over(film, search);
    if (passing.count == 0) return std::nullopt;
    return extended_to_region(film, refined(film, search, passing), search, widest);
}

DirectionBox PupilSearch::extended_to_region(Vec2<double> film, DirectionBox box, DirectionBox search,
                                             const DirectionBox& widest) const {
    constexpr int kMaxExtensions = 16;
    const double growth = is_symmetric() ? 1 : 0.5;
    for (int i = 0; i < kMaxExtensions && !box.is_enclosed_by(search, widest); ++i) {
        search = enlarged(box, growth);
        const PassingRays passing = trace_grid_over(film, search);
        if (passing.count == 0) break;
        box = refined(film, search, passing);
    }
    return box;
}

std::optional<PupilSearch::NearestRay> PupilSearch::nearest_to_stop(Vec2<double> film,
                                                                    const DirectionBox& search) const {
    struct StopPoint {
        float squared_distance = std::numeric_limits<float>::max();
        int point = -1;
    };
    const auto nearer = [](StopPoint a, StopPoint b) { return a.squared_distance < b.squared_distance; };
    const double stop = lens_.stop_radius();
    const Grid grid = grid_over(search);
    StopPoint nearest[kMaxGridBlocks];
    bool all_in_stop[kMaxGridBlocks];
    std::fill(std::begin(all_in_stop), std::end(all_in_stop), true);
    trace_grid(film, grid, [&](const PupilRays& from, int first) {
        PupilTracer::Rays rays;
        lens_.trace_to_stop(from, rays);
        StopPoint best;
        bool all_in = true;
        for (int i = 0; i < std::min(kBlock, grid.points() - first); ++i) {
            const float x = rays.origin.x[i], y = rays.origin.y[i];
            const StopPoint point{x * x + y * y, first + i};
            const bool reaches = rays.status[i] == 0;
            if (reaches && nearer(point, best)) best = point;
            all_in &= reaches && static_cast<double>(point.squared_distance) < stop * stop;
        }
        nearest[first / kBlock] = best;
        all_in_stop[first / kBlock] = all_in;
    });
    const StopPoint best = *std::min_element(std::begin(nearest), std::end(nearest), nearer);
    if (best.point < 0) return std::nullopt;
    return NearestRay{grid.direction(best.point), std::sqrt(static_cast<double>(best.squared_distance)) / stop,
                      std::all_of(std::begin(all_in_stop), std::end(all_in_stop), [](bool all_in) { return all_in; })};
}

bool PupilSearch::is_dark_around(const NearestRay& nearest, const std::optional<NearestRay>& last) {
    // A grid six times as fine comes about six times as near, and at least 2% nearer if a stop of a thousandth of the
    // full one lies in a bent part of the pupil.
    constexpr double kMinGain = 0.98;
    const bool comes_nearer = !last || nearest.distance < kMinGain * last->distance;
    return nearest.all_in_stop || !comes_nearer;
}

}  // namespace realcam
