#pragma once
#include <optional>
#include <vector>

#include "pupil_search.hpp"

namespace REALCAM_NAMESPACE {

/// The box of each row of a pupil's table, from the axis outwards; nothing where it is dark.
using PupilRowBoxes = std::vector<std::optional<PupilBox>>;

/// Looks for the boxes at the rows of a pupil's table, which lie closer and closer towards the edge of the image.
class PupilRowSearch {
public:
    static constexpr int kRows = 48;  ///< and one more on the axis

    /// `image_radius`: film radius of the last row, mm.
    PupilRowSearch(const PupilSearch& search, double image_radius) : search_(search), image_radius_(image_radius) {}

    /// Film radius at which a row, or a place inside one, lies.
    double radius_at(double position) const;

    /// Far apart first: what lies between rows with light is looked for at once, and then what lies beyond them.
    PupilRowBoxes look_from_axis() const;

    struct Edge {
        double radius;  ///< the first without light
        PupilBox last_box;  ///< just inside
    };

    /// Within a millionth of the image's radius, on the dark side.
    Edge edge_of_image(int last_lit_row, const PupilRowBoxes& boxes) const;

private:
    static constexpr int kEdgeHalvings = 16;  ///< of a row, which takes 4% of the radius at most

    /// What was seen at a row and at one further in.
    PupilTrack track_to(const PupilRowBoxes& boxes, int row, int step) const;

    /// Row after row, from those that are there to the last. One is known to be dark.
    void look_outwards(PupilRowBoxes& boxes, int dark) const;

    const PupilSearch& search_;
    double image_radius_;
};

}  // namespace REALCAM_NAMESPACE
