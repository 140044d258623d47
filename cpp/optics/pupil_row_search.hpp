#pragma once
#include <algorithm>
#include <optional>
#include <vector>

#include "pupil_search.hpp"

namespace REALCAM_NAMESPACE {

/// Of each row of a pupil's table, from the axis outwards; nothing where it is dark.
using PupilRowBoxes = std::vector<std::optional<PupilBox>>;

/// Looks for the boxes at the rows of a pupil's table, which lie closer and closer towards the edge of the image.
class PupilRowSearch {
public:
    static constexpr int kRows = 48;  ///< and one more on the axis

    /// `image_radius`: film radius of the last row, mm.
    PupilRowSearch(const PupilSearch& search, double image_radius) : search_(search), image_radius_(image_radius) {}

    /// Film radius at which a row, or a place inside one, lies.
    double radius_at(double position) const {
        const double inward = 1 - position / kRows;
        return image_radius_ * (1 - inward * inward);
    }

    /// Far apart first: what lies between rows with light is looked for at once, and then what lies beyond them.
    PupilRowBoxes look_from_axis() const {
        constexpr int kStride = 8;
        static_assert(kRows % kStride == 0);
        PupilRowBoxes boxes;
        PupilTrack track;
        int dark = kRows + 1;
        for (int row = 0; row <= kRows; row += kStride) {
            const std::optional<PupilBox> box = search_.look(radius_at(row), track);
            if (!box) {
                dark = row;
                break;
            }
            boxes.resize(static_cast<std::size_t>(row) + 1);
            boxes.back() = box;
        }
        search_.lens().for_each(static_cast<int>(boxes.size()) / kStride, [&](int stretch) {
            const int first = stretch * kStride;
            PupilTrack own = track_to(boxes, first, kStride);
            for (int row = first + 1; row < first + kStride; ++row)
                boxes[static_cast<std::size_t>(row)] = search_.look(radius_at(row), own);
        });
        look_outwards(boxes, dark);
        return boxes;
    }

    struct Edge {
        double radius;  ///< the first without light
        PupilBox last_box;  ///< just inside
    };

    Edge edge_of_image(int last_lit_row, const PupilRowBoxes& boxes) const {
        PupilTrack track = track_to(boxes, last_lit_row, 1);
        double dark = radius_at(last_lit_row + 1);
        for (int i = 0; i < 24; ++i) {
            const double middle = 0.5 * (track.last->radius + dark);
            if (!search_.look(middle, track)) dark = middle;
        }
        return {dark, track.last->box};
    }

private:
    /// What was seen at a row and at one further in.
    PupilTrack track_to(const PupilRowBoxes& boxes, int row, int step) const {
        PupilTrack track;
        for (const int at : {row - step, row})
            if (at >= 0)
                if (const auto& box = boxes[static_cast<std::size_t>(at)]) track.add(radius_at(at), *box);
        return track;
    }

    /// Row after row, from those that are there to the last. One is known to be dark.
    void look_outwards(PupilRowBoxes& boxes, int dark) const {
        const auto look = [&](int row, PupilTrack& track) {
            return row == dark ? std::nullopt : search_.look(radius_at(row), track);
        };
        PupilTrack track = track_to(boxes, static_cast<int>(boxes.size()) - 1, 1);
        bool looked_ahead = false;
        while (static_cast<int>(boxes.size()) <= kRows) {
            boxes.push_back(look(static_cast<int>(boxes.size()), track));
            if (boxes.back() || looked_ahead) continue;
            // From the first dark row on all is dark, most often. Then what a row sees depends on no row before.
            looked_ahead = true;
            const int next = static_cast<int>(boxes.size());
            PupilRowBoxes ahead(static_cast<std::size_t>(kRows + 1 - next));
            search_.lens().for_each(kRows + 1 - next, [&](int i) {
                PupilTrack own = track;
                ahead[static_cast<std::size_t>(i)] = look(next + i, own);
            });
            const auto lit = std::find_if(ahead.begin(), ahead.end(), [](const auto& box) { return box.has_value(); });
            boxes.insert(boxes.end(), ahead.begin(), lit);
        }
    }

    const PupilSearch& search_;
    double image_radius_;
};

}  // namespace REALCAM_NAMESPACE
