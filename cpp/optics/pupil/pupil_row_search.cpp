#include "pupil_row_search.hpp"

#include <algorithm>
#include <iterator>

namespace realcam {

PupilRowSearch::RadiusSearch PupilRowSearch::search_from_axis() const {
    static_assert(kRows % kStride == 0);
    RadiusSearch search;
    PupilTrack track;
    const auto is_lit = [&](int row) {
        if (!track.find(search_, points_.radius_at(row))) return false;
        search.lit.push_back(*track.last);
        return true;
    };
    int dark = 0;
    while (dark <= kRows && is_lit(dark)) dark += kStride;
    if (dark > kRows) return search;
    // Towards the edge of the image the light moves and shrinks, so that every row is needed to follow it.
    const int dark_for_sure = dark;
    if (dark > 0) dark -= kStride - 1;
    while (dark < dark_for_sure && is_lit(dark)) ++dark;
    PupilRowBoxes boxes_beyond(kRows + 1);
    search_.lens().for_each(kRows - dark, [&](int i) {
        PupilTrack local_track = track;
        const int row = dark + 1 + i;
        boxes_beyond[static_cast<std::size_t>(row)] = local_track.find(search_, points_.radius_at(row));
    });
    int last = kRows;
    while (last >= dark && !boxes_beyond[static_cast<std::size_t>(last)]) --last;
    for (int row = dark + 1; row <= last; ++row)
        if (const auto& box = boxes_beyond[static_cast<std::size_t>(row)])
            search.lit.push_back({points_.radius_at(row), *box});
    for (int row = kRows; row > last; --row) search.dark.push_back(points_.radius_at(row));
    return search;
}

void PupilRowSearch::find_edge_of_image(RadiusSearch& search, double width, int global_rounds) const {
    PupilTrack track;
    for (const PupilTrack::LitRadius& lit : search.lit) track.add(lit.radius, lit.box);
    std::vector<double>& dark = search.dark;
    for (int round = 0; round < kMaxEdgeRounds && !dark.empty(); ++round) {
        const double lit = track.last->radius, third = (dark.back() - lit) / 3;
        if (3 * third < width * dark.back()) break;
        // A moving sliver may be missed from a distance, so dark radii are searched again from nearby.
        const double radii[] = {lit + third, lit + 2 * third, dark.back()};
        constexpr int kCount = std::size(radii);
        std::optional<DirectionBox> boxes[kCount];
        search_.lens().for_each(kCount, [&](int i) {
            PupilTrack local_track = track;
            boxes[i] =
                round < global_rounds ? local_track.find(search_, radii[i]) : local_track.find_near(search_, radii[i]);
        });
        dark.pop_back();
        for (int i = kCount - 1; i >= 0 && !boxes[i]; --i) dark.push_back(radii[i]);
        for (int i = 0; i < kCount; ++i)
            if (boxes[i]) track.add(radii[i], *boxes[i]);
    }
    if (track.last->radius > search.lit.back().radius) search.lit.push_back(*track.last);
}

PupilRowSearch::RadiusSearch PupilRowSearch::search_near_edge(double radius, const DirectionBox& box) const {
    RadiusSearch search = search_multiples(radius, box, {0.99994, 1});
    if (search.lit.size() == 1 && search.dark.size() == 1) return search;
    search = search_multiples(radius, box, {0.999, 0.9999, 1, 1.0001, 1.001});
    if (!search.lit.empty()) find_edge_of_image(search, 1.1e-4, 0);
    return search;
}

PupilRowSearch::RadiusSearch PupilRowSearch::search_multiples(double radius, const DirectionBox& box,
                                                              const std::vector<double>& factors) const {
    PupilRowBoxes boxes(factors.size());
    search_.lens().for_each(static_cast<int>(factors.size()), [&](int i) {
        PupilTrack track;
        track.add(radius, box);
        boxes[static_cast<std::size_t>(i)] = track.find_near(search_, radius * factors[static_cast<std::size_t>(i)]);
    });
    RadiusSearch search;
    std::size_t lit = boxes.size();
    for (; lit > 0 && !boxes[lit - 1]; --lit) search.dark.push_back(radius * factors[lit - 1]);
    for (std::size_t i = 0; i < lit; ++i)
        if (boxes[i]) search.lit.push_back({radius * factors[i], *boxes[i]});
    return search;
}

PupilTrack PupilRowSearch::track_between(const std::vector<PupilTrack::LitRadius>& lit, double radius) {
    const auto is_further = [](double r, const PupilTrack::LitRadius& other) { return r < other.radius; };
    const auto outer = std::upper_bound(lit.begin(), lit.end(), radius, is_further);
    const auto inner = outer == lit.begin() ? outer : std::prev(outer);
    PupilTrack track;
    if (inner + 1 != lit.end()) {
        track.add(inner[1].radius, inner[1].box);
    } else if (inner != lit.begin()) {
        track.add(inner[-1].radius, inner[-1].box);
    }
    track.add(inner->radius, inner->box);
    return track;
}

PupilRowBoxes PupilRowSearch::boxes_of_rows(const std::vector<PupilTrack::LitRadius>& lit, int first_row) const {
    PupilRowBoxes boxes(kRows + 1);
    search_.lens().for_each(kRows + 1 - first_row, [&](int i) {
        const int row = first_row + i;
        const double radius = points_.radius_at(row);
        PupilTrack track = track_between(lit, radius);
        const bool is_known = track.last->radius == radius;
        boxes[static_cast<std::size_t>(row)] = is_known ? track.last->box : track.find(search_, radius);
    });
    return boxes;
}

}  // namespace realcam
