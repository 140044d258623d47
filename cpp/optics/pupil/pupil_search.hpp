#pragma once
#include <algorithm>
#include <optional>
#include <utility>

#include "pupil_lens.hpp"

namespace REALCAM_NAMESPACE {

/// Finds, by tracing real rays, the bounding box of the directions that pass a lens from a film point on the +x axis.
class PupilSearch {
public:
    static constexpr int kBlock = PupilTracer::kBlock;
    /// Upper bound of the number of ray blocks of one search: two searches of six levels, 11 blocks each, of 5 more,
    /// and of 17 extensions.
    static constexpr int kMostBlocks = 2 * (6 * 11 + 5 + 17 * 6);

    PupilSearch(const LensSystem& lens, PupilTracer tracer, const std::vector<double>& wavelengths_nm = {})
        : lens_(lens, std::move(tracer), wavelengths_nm) {}

    const PupilLens& lens() const { return lens_; }

    /// Finds the box at a film radius further out than those on the track, and adds it to the track. Returns
    /// std::nullopt if no light arrives.
    std::optional<PupilBox> look(double radius, PupilTrack& track) const;

    /// Same as look, but searches only where the track leads.
    std::optional<PupilBox> look_near(double radius, PupilTrack& track) const;

private:
    /// Points of the search grid along l, and along m >= 0.
    static constexpr int kColumns = 48, kRows = kColumns / 2, kPoints = kColumns * kRows;
    static constexpr int kGridBlocks = (kPoints + kBlock - 1) / kBlock;

    /// Passing rays of a grid.
    struct Passing {
        int count = 0;
        PupilBox box = PupilBox::none();
        PupilDirection highest{0, 0};  ///< centre of the top row's passing points
    };

    static double grid_l(const PupilBox& box, int column) {
        return box.l_min + (column + 0.5) / kColumns * (box.l_max - box.l_min);
    }
    static double grid_m(const PupilBox& box, int row) { return (row + 0.5) / kRows * box.m_max; }

    /// Traces a grid over a box. Calls `trace`(rays, index of the first point) for each block, in any order.
    template <class Trace>
    void trace_grid(double radius, const PupilBox& box, Trace&& trace) const {
        double l[kColumns], m[kRows];
        for (int i = 0; i < kColumns; ++i) l[i] = grid_l(box, i);
        for (int i = 0; i < kRows; ++i) m[i] = grid_m(box, i);
        lens_.for_each(kGridBlocks, [&](int block) {
            PupilRays rays;
            for (int i = 0; i < kBlock; ++i) {
                const int point = std::min(block * kBlock + i, kPoints - 1);
                rays.set(i, radius, {l[point % kColumns], m[point / kColumns]});
            }
            trace(rays, block * kBlock);
        });
    }

    Passing passing(double radius, const PupilBox& search) const;

    /// Bounding box of the passing directions: moves three edges of the grid's box outwards to where the light ends,
    /// which is less than a cell away from the outermost point that passes. The region is symmetric in m, so it is
    /// widest along l at m = 0.
    PupilBox refined(double radius, const PupilBox& search, const Passing& seen) const;

    /// A small aperture may fall between the points of any grid: if too few rays pass, searches a smaller box around
    /// those that pass, or around the ray that comes nearest to the centre of the stop.
    std::optional<PupilBox> find_box(double radius, PupilBox search, const PupilBox& widest) const;

    /// Extends a box to the whole region, because the searched box may have contained only a part: a sliver of a region
    /// that has moved by more than its size, or the middle of one that was found by its nearest ray.
    PupilBox whole(double radius, PupilBox box, PupilBox search, const PupilBox& widest) const;

    /// The ray of a grid that comes nearest to the centre of the stop.
    struct NearestRay {
        PupilDirection at;
        double distance;  ///< from the centre of the stop, in units of the stop's radius
        bool all_in_stop;  ///< true if the whole grid passes the opening of the stop
    };
    std::optional<NearestRay> nearest_to_stop(double radius, const PupilBox& search) const;

    /// True if a finer grid around `nearest` will show no light, its own grid being dark: either its whole grid passes
    /// the stop and is blocked by a rim, or its grid came no nearer than `last`, the result of the previous, coarser
    /// grid if there was one.
    static bool is_dark_around(const NearestRay& nearest, const std::optional<NearestRay>& last);

    PupilLens lens_;
};

}  // namespace REALCAM_NAMESPACE
