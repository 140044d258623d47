#pragma once
#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "pupil_lens.hpp"

namespace REALCAM_NAMESPACE {

/// Finds, with real rays, where the directions lie that pass a lens from a film point on the +x axis.
class PupilSearch {
public:
    static constexpr int kBlock = PupilTracer::kBlock;
    /// Of one look: two searches of six levels, 11 blocks each, of 5 more, and of 17 growths.
    static constexpr int kMostBlocks = 2 * (6 * 11 + 5 + 17 * 6);

    PupilSearch(const LensSystem& lens, PupilTracer tracer, const std::vector<double>& wavelengths_nm = {})
        : lens_(lens, std::move(tracer), wavelengths_nm) {}

    const PupilLens& lens() const { return lens_; }

    /// The box at a film radius further out than those on the track; adds it there.
    std::optional<PupilBox> look(double radius, PupilTrack& track) const {
        const PupilBox widest = lens_.box_of_last_surface(radius);
        std::optional<PupilBox> box;
        if (track.last) box = find_box(radius, track.search_at(radius), widest);
        if (!box) box = find_box(radius, widest, widest);
        if (box) track.add(radius, *box);
        return box;
    }

private:
    /// Points of the search grid along l, and along m >= 0.
    static constexpr int kColumns = 48, kRows = kColumns / 2, kPoints = kColumns * kRows;
    static constexpr int kGridBlocks = (kPoints + kBlock - 1) / kBlock;

    /// What passes of a grid.
    struct Passing {
        int count = 0;
        PupilBox box = PupilBox::none();
        PupilDirection highest{0, 0};  ///< the middle of the top row's passing points
    };

    static double grid_l(const PupilBox& box, int column) {
        return box.l_min + (column + 0.5) / kColumns * (box.l_max - box.l_min);
    }
    static double grid_m(const PupilBox& box, int row) { return (row + 0.5) / kRows * box.m_max; }

    /// Traces a grid over a box. `trace`(rays, first point) is called for each block of them, in any order.
    template <class Trace>
    void trace_grid(double radius, const PupilBox& box, Trace&& trace) const {
        double l[kColumns], m[kRows];
        for (int i = 0; i < kColumns; ++i) l[i] = grid_l(box, i);
        for (int i = 0; i < kRows; ++i) m[i] = grid_m(box, i);
        lens_.for_each_block(kGridBlocks, [&](int block) {
            PupilRays rays;
            for (int i = 0; i < kBlock; ++i) {
                const int point = std::min(block * kBlock + i, kPoints - 1);
                rays.set(i, radius, {l[point % kColumns], m[point / kColumns]});
            }
            trace(rays, block * kBlock);
        });
    }

    Passing passing(double radius, const PupilBox& search) const {
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

    /// Bounding box of the passing directions: moves the three edges of the grid's out to where the light ends, which
    /// is less than a cell away from the outermost point that passes. The region is symmetric in m, so it is widest
    /// along l where m is 0.
    PupilBox refined(double radius, const PupilBox& search, const Passing& seen) const {
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

    /// A small aperture falls through any grid: where too few rays pass, goes to the ray that comes nearest to the
    /// middle of the stop, in a smaller box.
    std::optional<PupilBox> find_box(double radius, PupilBox search, const PupilBox& widest) const {
        constexpr int kLevels = 6, kEnough = 48;
        for (int level = 0; level < kLevels; ++level) {
            const Passing seen = passing(radius, search);
            if (seen.count >= kEnough) return whole(radius, refined(radius, search, seen), search, widest);
            const auto nearest = nearest_to_stop(radius, search);
            if (!nearest) return std::nullopt;
            const double w = search.half_width() / 6, h = search.m_max / 6;
            search = seen.count > 0 ? refined(radius, search, seen).grown(0.2)
                                    : PupilBox{nearest->l - w, nearest->l + w, nearest->m + h};
        }
        const Passing few = passing(radius, search);
        if (few.count == 0) return std::nullopt;
        return whole(radius, refined(radius, search, few), search, widest);
    }

    /// The searched box may have held a part of the region only: follows it as far as it goes. A region that has moved
    /// by more than its size begins as a sliver, and one that is found by its nearest ray as its middle.
    PupilBox whole(double radius, PupilBox box, PupilBox search, const PupilBox& widest) const {
        constexpr int kMostGrowths = 16;
        for (int i = 0; i < kMostGrowths && !box.lies_in(search, widest); ++i) {
            search = box.grown(1);
            const Passing more = passing(radius, search);
            if (more.count == 0) break;
            box = refined(radius, search, more);
        }
        return box;
    }

    std::optional<PupilDirection> nearest_to_stop(double radius, const PupilBox& search) const {
        struct Place {
            float squared_distance;
            int point;
        };
        constexpr Place kNone{std::numeric_limits<float>::max(), -1};
        const auto nearer = [](Place a, Place b) { return a.squared_distance < b.squared_distance; };
        Place nearest[kGridBlocks];
        trace_grid(radius, search, [&](const PupilRays& from, int first) {
            PupilTracer::Rays rays;
            lens_.trace_to_stop(from, rays);
            Place best = kNone;
            for (int i = 0; i < std::min(kBlock, kPoints - first); ++i) {
                const float x = rays.origin.x[i], y = rays.origin.y[i];
                const Place place{x * x + y * y, first + i};
                if (rays.status[i] == 0 && nearer(place, best)) best = place;
            }
            nearest[first / kBlock] = best;
        });
        const int point = std::min_element(nearest, nearest + kGridBlocks, nearer)->point;
        if (point < 0) return std::nullopt;
        return PupilDirection{grid_l(search, point % kColumns), grid_m(search, point / kColumns)};
    }

    PupilLens lens_;
};

}  // namespace REALCAM_NAMESPACE
