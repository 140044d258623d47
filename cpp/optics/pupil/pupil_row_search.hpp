#pragma once
#include <optional>
#include <vector>

#include "film_points.hpp"
#include "pupil_track.hpp"

namespace REALCAM_NAMESPACE {

/// Bounding box of the passing directions at each row of a pupil's table, from the axis outwards; std::nullopt if no
/// light reaches the row's film radius.
using PupilRowBoxes = std::vector<std::optional<DirectionBox>>;

/// Searches for the boxes at the rows of the table of a Pupil, and for the edge of the image circle. A row belongs to a
/// film radius; the spacing of rows decreases towards the edge of the image.
class PupilRowSearch {
public:
    static constexpr int kRows = RadialFilmPoints::columns;  ///< index of the last row; row 0 is the axis

    /// The object keeps a reference to `search`.
    PupilRowSearch(const PupilSearch& search, RadialFilmPoints points) : search_(search), points_(points) {}

    /// Film radii that have been searched.
    struct RadiusSearch {
        std::vector<PupilTrack::LitRadius> lit;  ///< radii that light reaches, with their boxes, in ascending order
        std::vector<double> dark;  ///< radii beyond them that no light reaches, in descending order
    };

    /// Searches every eighth row from the axis to the first dark one, then all rows shortly before it and all rows
    /// beyond: the light may end there, or begin again further out.
    RadiusSearch search_from_axis() const;

    /// Finds the edge of the image circle by repeated division into thirds: adds the outermost lit radius and an
    /// innermost dark radius to `search`, which differ by at most the fraction `width`. `search.dark` becomes empty if
    /// light reaches the outermost radius. In the first `global_rounds` rounds light is searched in all directions, and
    /// later only near the box that is predicted from the lit radii.
    void find_edge_of_image(RadiusSearch& search, double width = 1e-5, int global_rounds = 2) const;

    /// Finds the edge of an image circle that probably ends at about `radius` with this box, to a relative accuracy of
    /// 1e-4. `radius` itself is used if the edge lies between 0.99994 times `radius` and `radius`. In the result, `lit`
    /// or `dark` is empty if the edge lies more than a thousandth away from `radius`.
    RadiusSearch search_near_edge(double radius, const DirectionBox& box) const;

    /// Finds the boxes of all rows from `first_row` on. Each search begins with the box that is predicted from the
    /// nearest radii in `lit`, which must not be empty.
    PupilRowBoxes boxes_of_rows(const std::vector<PupilTrack::LitRadius>& lit, int first_row = 0) const;

private:
    static constexpr int kStride = 8;  ///< step of rows in search_from_axis
    static constexpr int kMaxEdgeRounds = 32;  ///< largest number of divisions into thirds

    /// Searches the radii radius * factors[i] near `box`, the box of `radius`. `factors` must be in ascending order.
    RadiusSearch search_multiples(double radius, const DirectionBox& box, const std::vector<double>& factors) const;

    /// Returns a track of the two radii in `lit` nearest to `radius`, on both sides of it if possible, for a search
    /// there.
    static PupilTrack track_between(const std::vector<PupilTrack::LitRadius>& lit, double radius);

    const PupilSearch& search_;
    RadialFilmPoints points_;
};

}  // namespace REALCAM_NAMESPACE
