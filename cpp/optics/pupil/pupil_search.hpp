#pragma once
#include <algorithm>
#include <optional>
#include <utility>

#include "pupil_lens.hpp"

namespace REALCAM_NAMESPACE {

/// Finds, with real rays, where the directions lie that pass a lens from a film point on the +x axis.
class PupilSearch {
public:
    static constexpr int kBlock = PupilTracer::kBlock;
    /// The most blocks of one look: two searches of six levels, 11 blocks each, of 5 more, and of 17 growths.
    static constexpr int kMostBlocks = 2 * (6 * 11 + 5 + 17 * 6);

    PupilSearch(const LensSystem& lens, PupilTracer tracer, const std::vector<double>& wavelengths_nm = {})
        : lens_(lens, std::move(tracer), wavelengths_nm) {}

    const PupilLens& lens() const { return lens_; }

    /// The box at a film radius further out than those on the track; adds it there.
    std::optional<PupilBox> look(double radius, PupilTrack& track) const;

    /// The same where the track leads to, and nowhere else.
    std::optional<PupilBox> look_near(double radius, PupilTrack& track) const;

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

    /// Bounding box of the passing directions: moves the three edges of the grid's out to where the light ends, which
    /// is less than a cell away from the outermost point that passes. The region is symmetric in m, so it is widest
    /// along l where m is 0.
    PupilBox refined(double radius, const PupilBox& search, const Passing& seen) const;

    /// A small aperture falls through any grid: where too few rays pass, goes to the ray that comes nearest to the
    /// middle of the stop, in a smaller box.
    std::optional<PupilBox> find_box(double radius, PupilBox search, const PupilBox& widest) const;

    /// The searched box may have held a part of the region only: follows it as far as it goes. A region that has moved
    /// by more than its size begins as a sliver, and one that is found by its nearest ray as its middle.
    PupilBox whole(double radius, PupilBox box, PupilBox search, const PupilBox& widest) const;

    /// The ray of a grid that comes nearest to the middle of the stop.
    struct NearestRay {
        PupilDirection at;
        double distance;  ///< from there, as a share of the stop's radius
        bool all_in_stop;  ///< the whole grid goes through the opening of the stop
    };
    std::optional<NearestRay> nearest_to_stop(double radius, const PupilBox& search) const;

    /// Whether a finer grid around it will show no light where this one shows none. Either the stop is open for all of
    /// this one, and a rim blocks it; or a finer grid came no nearer than `last`, the one before, if there was one.
    static bool is_dark_around(const NearestRay& nearest, const std::optional<NearestRay>& last);

    PupilLens lens_;
};

}  // namespace REALCAM_NAMESPACE
