#include "pupil_search.hpp"

#include <cmath>
#include <limits>

namespace realcam {

std::optional<PupilBox> PupilSearch::look(double radius, PupilTrack& track) const {
    if (track.last)
        if (const auto box = look_near(radius, track)) return box;
    const PupilBox widest = lens_.box_of_last_surface(radius);
    const std::optional<PupilBox> box = find_box(radius, widest, widest);
    if (box) track.add(radius, *box);
    return box;
}

std::optional<PupilBox> PupilSearch::look_near(double radius, PupilTrack& track) const {
    const std::optional<PupilBox> box = find_box(radius, track.search_at(radius), lens_.box_of_last_surface(radius));
    if (box) track.add(radius, *box);
    return box;
}

PupilSearch::Passing PupilSearch::passing(double radius, const PupilBox& search) const {
    bool passes[kGridBlocks * kBlock];
    trace_grid(radius, search, [&](const PupilRays& rays, int first) { lens_.trace(rays, passes + first); });
    Passing seen;
    double leftmost = 0;
    for (int row = 0; row < kRows; ++row) {
        const bool *begin = passes + row * kColumns, *end = begin + kColumns;
        const bool* const first = std::find(begin, end, true);
        if (first == end) continue;
        int last = kColumns - 1;
        while (!begin[last]) --last;
        seen.count += static_cast<int>(std::count(begin, end, true));
        const PupilDirection left{grid_l(search, static_cast<int>(first - begin)), grid_m(search, row)},
            right{grid_l(search, last), left.m};
        seen.box = seen.box.with(left).with(right);
        if (left.m > seen.highest.m) leftmost = left.l;
        seen.highest = {0.5 * (leftmost + right.l), left.m};
    }
    return seen;
}

PupilBox PupilSearch::refined(double radius, const PupilBox& search, const Passing& seen) const {
    constexpr int kSteps = kBlock / 3;
    const double cell_l = (search.l_max - search.l_min) / kColumns, cell_m = search.m_max / kRows;
    PupilRays from;
    for (int i = 0; i < kBlock; ++i) {
        const double step = (i % kSteps + 1.0) / kSteps;
        const PupilBox& box = seen.box;
        switch (i / kSteps) {
            case 0: from.set(i, radius, {box.l_min - step * cell_l, 0}); break;
            case 1: from.set(i, radius, {box.l_max + step * cell_l, 0}); break;
            default: from.set(i, radius, {seen.highest.l, box.m_max + step * cell_m});
        }
    }
    bool passes[kBlock];
    lens_.trace(from, passes);
    PupilBox box = seen.box;
    for (int i = 0; i < 3 * kSteps; ++i)
        if (passes[i]) box = box.with({from.l[i], from.m[i]});
    box.l_min -= cell_l / kSteps;
    box.l_max += cell_l / kSteps;
    box.m_max += cell_m / kSteps;
    return box;
}

std::optional<PupilBox> PupilSearch::find_box(double radius, PupilBox search, const PupilBox& widest) const {
    constexpr int kLevels = 6, kEnough = 48;
    std::optional<NearestRay> last;
    for (int level = 0; level < kLevels; ++level) {
        const Passing seen = passing(radius, search);
        if (seen.count >= kEnough) return whole(radius, refined(radius, search, seen), search, widest);
        const std::optional<NearestRay> nearest = nearest_to_stop(radius, search);
        if (!nearest || (seen.count == 0 && is_dark_around(*nearest, last))) return std::nullopt;
        last = nearest;
        const double w = search.half_width() / 6, h = search.m_max / 6;
        search = seen.count > 0 ? refined(radius, search, seen).grown(0.2)
                                : PupilBox{nearest->at.l - w, nearest->at.l + w, nearest->at.m + h};
    }
    const Passing few = passing(radius, search);
    if (few.count == 0) return std::nullopt;
    return whole(radius, refined(radius, search, few), search, widest);
}

PupilBox PupilSearch::whole(double radius, PupilBox box, PupilBox search, const PupilBox& widest) const {
    constexpr int kMostGrowths = 16;
    for (int i = 0; i < kMostGrowths && !box.lies_in(search, widest); ++i) {
        search = box.grown(1);
        const Passing more = passing(radius, search);
        if (more.count == 0) break;
        box = refined(radius, search, more);
    }
    return box;
}

std::optional<PupilSearch::NearestRay> PupilSearch::nearest_to_stop(double radius, const PupilBox& search) const {
    struct Place {
        float squared_distance;
        int point;
    };
    constexpr Place kNone{std::numeric_limits<float>::max(), -1};
    const auto nearer = [](Place a, Place b) { return a.squared_distance < b.squared_distance; };
    const double stop = lens_.stop_radius();
    Place nearest[kGridBlocks];
    bool all_in_stop[kGridBlocks];
    trace_grid(radius, search, [&](const PupilRays& from, int first) {
        PupilTracer::Rays rays;
        lens_.trace_to_stop(from, rays);
        Place best = kNone;
        bool all_in = true;
        for (int i = 0; i < std::min(kBlock, kPoints - first); ++i) {
            const float x = rays.origin.x[i], y = rays.origin.y[i];
            const Place place{x * x + y * y, first + i};
            const bool reaches = rays.status[i] == 0;
            if (reaches && nearer(place, best)) best = place;
            all_in &= reaches && static_cast<double>(place.squared_distance) < stop * stop;
        }
        nearest[first / kBlock] = best;
        all_in_stop[first / kBlock] = all_in;
    });
    const Place best = *std::min_element(nearest, nearest + kGridBlocks, nearer);
    if (best.point < 0) return std::nullopt;
    return NearestRay{{grid_l(search, best.point % kColumns), grid_m(search, best.point / kColumns)},
                      std::sqrt(static_cast<double>(best.squared_distance)) / stop,
                      std::all_of(all_in_stop, all_in_stop + kGridBlocks, [](bool all_in) { return all_in; })};
}

bool PupilSearch::is_dark_around(const NearestRay& nearest, const std::optional<NearestRay>& last) {
    // A grid six times as fine comes about six times as near, and at least 2% nearer if a stop of a thousandth of the
    // full one lies in a bent part of the pupil.
    constexpr double kLeastGain = 0.98;
    const bool comes_nearer = !last || nearest.distance < kLeastGain * last->distance;
    return nearest.all_in_stop || !comes_nearer;
}

}  // namespace realcam
