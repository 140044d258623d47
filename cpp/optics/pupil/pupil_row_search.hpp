#pragma once
#include <optional>
#include <vector>

#include "pupil_track.hpp"

namespace REALCAM_NAMESPACE {

/// Box of each row of a pupil's table, from the axis outwards; std::nullopt if the row is dark.
using PupilRowBoxes = std::vector<std::optional<DirectionBox>>;

/// Searches the boxes at the rows of a pupil's table, whose spacing decreases towards the edge of the image.
class PupilRowSearch {
public:
    static constexpr int kRows = 48;  ///< rows in addition to the one on the axis

    /// `image_radius`: film radius of the last row, mm.
    PupilRowSearch(const PupilSearch& search, double image_radius) : search_(search), image_radius_(image_radius) {}

    /// Film radius of a row, or of a fractional position between rows.
    double radius_at(double position) const;

    /// Lit film radii with their boxes, in ascending order, and the dark radii beyond them, in descending order.
    struct RowSearch {
        std::vector<PupilTrack::Seen> lit;
        std::vector<double> dark;
    };

    /// Searches every eighth row from the axis, and all rows before and beyond a dark one: the light may end there or
    /// begin again.
    RowSearch look_from_axis() const;

    /// Adds the outermost lit radius, and the innermost dark one at most `width` of it further out; leaves no dark
    /// radius if light reaches the outermost. In the first `far_rounds` rounds light is searched everywhere, not only
    /// where the lit boxes lead.
    void find_edge_of_image(RowSearch& search, double width = 1e-5, int far_rounds = 2) const;

    /// Finds the edge, to 1e-4, of an image that ends at about `radius`, where the light has this box. The edge is
    /// `radius` itself if it lies at most 6e-5 further in. `lit` or `dark` is empty if the image ends more than a
    /// thousandth elsewhere.
    RowSearch look_near_edge(double radius, const DirectionBox& box) const;

    /// Boxes of all rows from `first_row` on, each searched where its neighbours in `seen` lead.
    PupilRowBoxes look_between(const std::vector<PupilTrack::Seen>& seen, int first_row = 0) const;

private:
    static constexpr int kStride = 8;
    static constexpr int kMostEdgeRounds = 32;

    /// Searches at these multiples of a radius, in ascending order, near the box of that radius.
    RowSearch look_around(double radius, const DirectionBox& box, const std::vector<double>& shares) const;

    /// Track that leads to a radius from the nearest two known boxes, on both sides of it if possible.
    static PupilTrack track_between(const std::vector<PupilTrack::Seen>& seen, double radius);

    const PupilSearch& search_;
    double image_radius_;
};

}  // namespace REALCAM_NAMESPACE
