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

    /// Radii with light, going outwards, and those beyond them where none was seen, going inwards.
    struct Sight {
        std::vector<PupilTrack::Seen> lit;
        std::vector<double> dark;
    };

    /// Every eighth row from the axis. Before and beyond a dark one all of them: the light may end there or begin
    /// again.
    Sight look_from_axis() const;

    /// Adds the last radius with light, and at most `width` of it further out the first without; none where light
    /// reaches the last dark one. In so many rounds at first the light may lie elsewhere than where the last lit ones
    /// lead.
    void find_edge_of_image(Sight& sight, double width = 1e-5, int far_rounds = 2) const;

    /// The edge, to 1e-4, of an image that ends about at `radius`, where the light has this box. It is `radius` itself
    /// where it lies 6e-5 further in or less. Nothing is lit, or nothing dark, where the image ends more than a
    /// thousandth elsewhere.
    Sight look_near_edge(double radius, const PupilBox& box) const;

    /// All rows from the first one on, each looked for where its neighbours among those that were seen lead to.
    PupilRowBoxes look_between(const std::vector<PupilTrack::Seen>& seen, int first_row = 0) const;

private:
    static constexpr int kStride = 8;
    static constexpr int kMostEdgeRounds = 32;

    /// What is seen at these shares of a radius, going outwards, near the box of that radius.
    Sight look_around(double radius, const PupilBox& box, const std::vector<double>& shares) const;

    /// Leads to a radius from the nearest two that were seen, on both sides of it where there are such.
    static PupilTrack track_between(const std::vector<PupilTrack::Seen>& seen, double radius);

    const PupilSearch& search_;
    double image_radius_;
};

}  // namespace REALCAM_NAMESPACE
