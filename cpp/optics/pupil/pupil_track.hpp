#pragma once
#include <optional>

#include "pupil_search.hpp"

namespace REALCAM_NAMESPACE {

/// Search for the pupil's boxes at successive film radii, from the axis outwards. The edges of the region of passing
/// directions move smoothly, so that the last two boxes predict the next one. This is necessary near the edge of the
/// image circle, where the region is a sliver that moves by more than its own width.
struct PupilTrack {
    /// A film radius that light reaches, and the bounding box of the passing directions there.
    struct LitRadius {
        double radius;  ///< mm
        DirectionBox box;
    };
    std::optional<LitRadius> last, previous;  ///< the last radius found, and the one found before it

    /// Appends a radius to the track.
    void add(double radius, const DirectionBox& box) {
        previous = last;
        last = LitRadius{radius, box};
    }

    /// Finds the box at a film radius further out than those on the track, and adds it to the track. Returns
    /// std::nullopt if no light arrives.
    std::optional<DirectionBox> find(const PupilSearch& search, double radius) {
        return added(radius, search.find({radius, 0}, expected_at(radius)));
    }
    /// Same as find, but searches only near the predicted box. The track must not be empty.
    std::optional<DirectionBox> find_near(const PupilSearch& search, double radius) {
        return added(radius, search.find_near({radius, 0}, *expected_at(radius)));
    }

private:
    /// Adds the box to the track if there is one, and returns it.
    std::optional<DirectionBox> added(double radius, const std::optional<DirectionBox>& box) {
        if (box) add(radius, *box);
        return box;
    }
    /// Predicted box at a radius: the last box and its linear extrapolation; std::nullopt if the track is empty.
    std::optional<DirectionBox> expected_at(double radius) const {
        if (!previous) return last ? std::optional(last->box) : std::nullopt;
        const double steps = (radius - last->radius) / (last->radius - previous->radius);
        return last->box.expected_after(previous->box, steps);
    }
};

}  // namespace REALCAM_NAMESPACE
