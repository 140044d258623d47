#pragma once
#include <optional>

#include "pupil_search.hpp"

namespace REALCAM_NAMESPACE {

/// Boxes found so far, from the axis outwards. The edges of the region move smoothly, so the last two boxes predict the
/// next: near the edge of the image circle the region is a sliver that moves by more than its own width.
struct PupilTrack {
    struct Seen {
        double radius;
        DirectionBox box;
    };
    std::optional<Seen> last, before;

    void add(double radius, const DirectionBox& box) {
        before = last;
        last = Seen{radius, box};
    }

    /// Finds the box at a film radius further out than those on the track, and adds it to the track. Returns
    /// std::nullopt if no light arrives.
    std::optional<DirectionBox> look(const PupilSearch& search, double radius) {
        return added(radius, search.look({radius, 0}, expected_at(radius)));
    }
    /// Same as look, but searches only where the track, which is not empty, leads.
    std::optional<DirectionBox> look_near(const PupilSearch& search, double radius) {
        return added(radius, search.look_near({radius, 0}, *expected_at(radius)));
    }

private:
    std::optional<DirectionBox> added(double radius, const std::optional<DirectionBox>& box) {
        if (box) add(radius, *box);
        return box;
    }
    std::optional<DirectionBox> expected_at(double radius) const {
        if (!before) return last ? std::optional(last->box) : std::nullopt;
        const double steps = (radius - last->radius) / (last->radius - before->radius);
        return last->box.joined_with(last->box.moved_on_from(before->box, steps));
    }
};

}  // namespace REALCAM_NAMESPACE
