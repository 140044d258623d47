#include "pupil_edges.hpp"

#include <algorithm>
#include <cmath>

#include "pupil_outline.hpp"
#include "pupil_outline_search.hpp"

namespace realcam {

std::optional<PupilEdges> pupil_edges(const PupilLens& lens, double radius, double azimuth, const DirectionBox& box) {
    const double cos = std::cos(azimuth), sin = std::sin(azimuth);
    std::vector<OutlineRequest> requests;
    for (const int sign : {1, -1})
        requests.push_back({{radius * cos, radius * sin},
                            {box.centre().l * cos, box.centre().l * sin},
                            box.half_width(),
                            sign * box.half_height(),
                            cos,
                            sin});
    // Errors of the aperture's shape are visible in the diffraction pattern: the edges are accurate to 1e-6 of the box.
    constexpr OutlineScan kFineScan{48, 16};
    const std::vector<PupilOutline> halves = OutlineSearch::find(lens, requests, kFineScan);
    bool is_obstructed = true;
    for (const PupilOutline& half : halves) {
        if (std::find(std::begin(half.outer), std::end(half.outer), 0.0) != std::end(half.outer)) return std::nullopt;
        is_obstructed &= std::find(std::begin(half.inner), std::end(half.inner), 0.0) == std::end(half.inner);
    }
    PupilEdges edges(is_obstructed ? 2 : 1);
    // Appends a corner; `radii`: member of PupilOutline that holds the radii of the edge.
    const auto add = [&](std::vector<Vec2<double>>& edge, int corner, auto radii) {
        const TurnAzimuth at(corner);
        const PupilDirection d = requests[at.half].direction(at.azimuth, (halves[at.half].*radii)[at.azimuth]);
        edge.push_back({d.l, d.m});
    };
    for (int i = 0; i < kPupilEdgeCorners; ++i) {
        add(edges[0], i, &PupilOutline::outer);
        if (is_obstructed) add(edges[1], kPupilEdgeCorners - 1 - i, &PupilOutline::inner);
    }
    return edges;
}

}  // namespace realcam
