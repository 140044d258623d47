#pragma once
#include <optional>
#include <utility>
#include <vector>

#include "direction_box.hpp"
#include "pupil_lens.hpp"

namespace REALCAM_NAMESPACE {

/// Finds, by tracing real rays, the bounding box of the directions that pass a lens of any kind from any film point.
class DirectionSearch {
public:
    static constexpr int kBlock = PupilTracer::kBlock;

    DirectionSearch(const LensSystem& lens, PupilTracer tracer, const std::vector<double>& wavelengths_nm)
        : lens_(lens, std::move(tracer), wavelengths_nm) {}

    const PupilLens& lens() const { return lens_; }

    /// Returns std::nullopt if no light arrives. `expected`: box near which the search begins.
    std::optional<DirectionBox> look(Vec2<double> film, const std::optional<DirectionBox>& expected) const;

private:
    static constexpr int kSide = 32, kPoints = kSide * kSide;  ///< side and number of points of the search grid
    static_assert(kPoints % kBlock == 0);

    struct Passing {
        int count = 0;
        DirectionBox box = DirectionBox::none();  ///< passing grid points, extended by one cell to each side
    };

    static PupilDirection grid_direction(const DirectionBox& box, int point);

    /// Calls trace(rays, index of the first point) for each block of a grid over a box.
    template <class Trace>
    void trace_grid(Vec2<double> film, const DirectionBox& box, Trace&& trace) const;

    Passing passing(Vec2<double> film, const DirectionBox& search) const;

    /// A small aperture may fall between the points of any grid: if too few rays pass, searches a smaller box around
    /// those that pass, or around the ray that comes nearest to the centre of the stop.
    std::optional<DirectionBox> find(Vec2<double> film, DirectionBox search, const DirectionBox& widest) const;

    /// Extends a box to the whole region, because the searched box may have contained only a part.
    DirectionBox whole(Vec2<double> film, DirectionBox box, DirectionBox search, const DirectionBox& widest) const;

    std::optional<PupilDirection> nearest_to_stop(Vec2<double> film, const DirectionBox& search) const;

    PupilLens lens_;
};

}  // namespace REALCAM_NAMESPACE
