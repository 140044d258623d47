#include "pupil_row_search.hpp"

namespace realcam {

double PupilRowSearch::radius_at(double position) const {
    const double inward = 1 - position / kRows;
    return image_radius_ * (1 - inward * inward);
}

PupilRowBoxes PupilRowSearch::look_from_axis() const {
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

PupilRowSearch::Edge PupilRowSearch::edge_of_image(int last_lit_row, const PupilRowBoxes& boxes) const {
    PupilTrack track = track_to(boxes, last_lit_row, 1);
    double dark = radius_at(last_lit_row + 1);
    for (int i = 0; i < kEdgeHalvings; ++i) {
        const double middle = 0.5 * (track.last->radius + dark);
        if (!search_.look_near(middle, track)) dark = middle;
    }
    return {dark, track.last->box};
}

PupilTrack PupilRowSearch::track_to(const PupilRowBoxes& boxes, int row, int step) const {
    PupilTrack track;
    for (const int at : {row - step, row})
        if (at >= 0)
            if (const auto& box = boxes[static_cast<std::size_t>(at)]) track.add(radius_at(at), *box);
    return track;
}

void PupilRowSearch::look_outwards(PupilRowBoxes& boxes, int dark) const {
    const auto look = [&](int row, PupilTrack& track) {
        return row == dark ? std::nullopt : search_.look(radius_at(row), track);
    };
    PupilTrack track = track_to(boxes, static_cast<int>(boxes.size()) - 1, 1);
    bool looked_ahead = false;
    while (static_cast<int>(boxes.size()) <= kRows) {
        boxes.push_back(look(static_cast<int>(boxes.size()), track));
        if (boxes.back() || looked_ahead) continue;
        // Beyond the first dark row nearly always all is dark. Then no row depends on one before it.
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

}  // namespace realcam
