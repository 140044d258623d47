#pragma once
#include <optional>
#include <utility>
#include <vector>

#include "direction_box.hpp"
#include "pupil_lens.hpp"

namespace REALCAM_NAMESPACE {

/// Finds, with real rays, the box of the directions that pass a lens of any kind from any film point.
class DirectionSearch {
public:
    static constexpr int kBlock = PupilTracer::kBlock;

    DirectionSearch(const LensSystem& lens, PupilTracer tracer, const std::vector<double>& wavelengths_nm)
        : lens_(lens, std::move(tracer), wavelengths_nm) {}

    const PupilLens& lens() const { return lens_; }

    /// Nothing where no light arrives. `expected`: where it is looked for first.
    std::optional<DirectionBox> look(Vec2<double> film, const std::optional<DirectionBox>& expected) const;

private:
    static constexpr int kSide = 32, kPoints = kSide * kSide;  ///< of the grid of directions
    static_assert(kPoints % kBlock == 0);

    struct Passing {
        int count = 0;
        DirectionBox box = DirectionBox::none();  ///< whole cells of the grid, and one more to each side
    };

    static PupilDirection grid_direction(const DirectionBox& box, int point);

    /// trace(rays, first point) for each block of a grid over a box.
    template <class Trace>
    void trace_grid(Vec2<double> film, const DirectionBox& box, Trace&& trace) const;

    Passing passing(Vec2<double> film, const DirectionBox& search) const;

    /// A small aperture falls through any grid: where too few rays pass, goes to the ray that comes nearest to the
    /// middle of the stop, in a smaller box.
    std::optional<DirectionBox> find(Vec2<double> film, DirectionBox search, const DirectionBox& widest) const;

    /// The searched box may have held a part of the region only: follows it as far as it goes.
    DirectionBox whole(Vec2<double> film, DirectionBox box, DirectionBox search, const DirectionBox& widest) const;

    std::optional<PupilDirection> nearest_to_stop(Vec2<double> film, const DirectionBox& search) const;

    PupilLens lens_;
};

}  // namespace REALCAM_NAMESPACE
