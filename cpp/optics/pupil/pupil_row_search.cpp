#include "pupil_row_search.hpp"

#include <algorithm>
#include <iterator>

namespace realcam {

double PupilRowSearch::radius_at(double position) const {
    const double inward = 1 - position / kRows;
    return image_radius_ * (1 - inward * inward);
}

PupilRowSearch::Sight PupilRowSearch::look_from_axis() const {
    static_assert(kRows % kStride == 0);
    Sight sight;
    PupilTrack track;
    const auto is_lit = [&](int row) {
        if (!search_.look(radius_at(row), track)) return false;
        sight.lit.push_back(*track.last);
        return true;
    };
    int dark = 0;
    while (dark <= kRows && is_lit(dark)) dark += kStride;
    if (dark > kRows) return sight;
    // Towards the edge of the image the light moves and shrinks, so that every row is needed to follow it.
    const int dark_for_sure = dark;
    if (dark > 0) dark -= kStride - 1;
    while (dark < dark_for_sure && is_lit(dark)) ++dark;
    PupilRowBoxes ahead(kRows + 1);
    search_.lens().for_each(kRows - dark, [&](int i) {
        PupilTrack own = track;
        const int row = dark + 1 + i;
        ahead[static_cast<std::size_t>(row)] = search_.look(radius_at(row), own);
    });
    int last = kRows;
    while (last >= dark && !ahead[static_cast<std::size_t>(last)]) --last;
    for (int row = dark + 1; row <= last; ++row)
        if (const auto& box = ahead[static_cast<std::size_t>(row)]) sight.lit.push_back({radius_at(row), *box});
    for (int row = kRows; row > last; --row) sight.dark.push_back(radius_at(row));
    return sight;
}

void PupilRowSearch::find_edge_of_image(Sight& sight) const {
    PupilTrack track;
    for (const PupilTrack::Seen& seen : sight.lit) track.add(seen.radius, seen.box);
    std::vector<double>& dark = sight.dark;
    for (int round = 0; round < kMostEdgeRounds && !dark.empty(); ++round) {
        const double lit = track.last->radius, third = (dark.back() - lit) / 3;
        if (3 * third < kEdgeWidth * dark.back()) break;
        // A sliver that moves is missed from afar. So where none was seen is looked at again from nearby.
        const double radii[] = {lit + third, lit + 2 * third, dark.back()};
        constexpr int kCount = std::size(radii);
        std::optional<PupilBox> boxes[kCount];
        search_.lens().for_each(kCount, [&](int i) {
            PupilTrack own = track;
            // At first the track leads from so far away that the light may lie elsewhere.
            boxes[i] = round < 2 ? search_.look(radii[i], own) : search_.look_near(radii[i], own);
        });
        dark.pop_back();
        for (int i = kCount - 1; i >= 0 && !boxes[i]; --i) dark.push_back(radii[i]);
        for (int i = 0; i < kCount; ++i)
            if (boxes[i]) track.add(radii[i], *boxes[i]);
    }
    if (track.last->radius > sight.lit.back().radius) sight.lit.push_back(*track.last);
}

PupilTrack PupilRowSearch::track_between(const std::vector<PupilTrack::Seen>& seen, double radius) {
    const auto is_further = [](double r, const PupilTrack::Seen& other) { return r < other.radius; };
    const auto outer = std::upper_bound(seen.begin(), seen.end(), radius, is_further);
    const auto inner = outer == seen.begin() ? outer : std::prev(outer);
    PupilTrack track;
    if (inner + 1 != seen.end()) {
        track.add(inner[1].radius, inner[1].box);
    } else if (inner != seen.begin()) {
        track.add(inner[-1].radius, inner[-1].box);
    }
    track.add(inner->radius, inner->box);
    return track;
}

PupilRowBoxes PupilRowSearch::look_between(const std::vector<PupilTrack::Seen>& seen) const {
    PupilRowBoxes boxes(kRows + 1);
    search_.lens().for_each(kRows + 1, [&](int row) {
        const double radius = radius_at(row);
        PupilTrack track = track_between(seen, radius);
        const bool is_seen = track.last->radius == radius;
        boxes[static_cast<std::size_t>(row)] = is_seen ? track.last->box : search_.look(radius, track);
    });
    return boxes;
}

}  // namespace realcam
