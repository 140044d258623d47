#pragma once
#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "outline_lattice.hpp"
#include "pupil_outline_search.hpp"
#include "pupil_search.hpp"
#include "stray_search.hpp"

namespace REALCAM_NAMESPACE {

/// Table of a pupil over a film map: for every film point, the region of directions in which rays pass the lens. Owns
/// the memory of its view, from which rays are sampled. Derived classes find the boxes of the nodes by tracing rays,
/// and choose the points at which outlines are searched. `Points`: film points of the map (film_points.hpp).
template <class Points>
class PupilTable {
public:
    /// View for sampling, valid as long as this object.
    PupilTableView<typename Points::Map> view() const {
        return {points_.map(), nodes_.data(), sectors_.data(), halves_.empty() ? nullptr : halves_.data(),
                static_cast<float>(search_.lens().index_squared())};
    }

protected:
    using Map = typename Points::Map;
    using Node = typename Map::Node;
    using LatticePoints = std::vector<OutlineLattice::Point>;

    PupilTable(PupilSearch search, Points points) : search_(std::move(search)), points_(std::move(points)) {}

    /// Converts a box to the type of nodes.
    static Node node_of(const DirectionBox& box);

    /// Interpolates the boxes of the nodes.
    Node box_at(CellPosition at) const { return points_.map().interpolated(nodes_.data(), points_.nodes_at(at)); }

    /// Returns requests for the outlines at lattice points, in the interpolated boxes of the nodes.
    std::vector<OutlineRequest> requests_at(const OutlineLattice& lattice, const LatticePoints& points) const;

    /// Finds outlines at lattice points near expected ones. `tolerance`: see OutlineSearch::find_near.
    std::vector<PupilOutline> find_near(const OutlineLattice& lattice, const LatticePoints& points,
                                        const std::vector<PupilOutline>& expected, double tolerance) const {
        return OutlineSearch::find_near(search_.lens(), requests_at(lattice, points), expected, tolerance);
    }

    /// Finds the outlines at the lattice points that are multiples of `step`, without expected ones.
    void find_every(int step, OutlineLattice& lattice) const {
        const LatticePoints points = lattice.points(step);
        lattice.store(points, OutlineSearch::find(search_.lens(), requests_at(lattice, points)));
    }

    /// Finds outlines at points of lattice.midway_points(step), near the means of their neighbours' outlines.
    void find_midway(const LatticePoints& midway, int step, double tolerance, OutlineLattice& lattice) const {
        lattice.store(midway, find_near(lattice, midway, lattice.expected(midway, step), tolerance));
    }

    /// Extent of a StraySearch: its members of the same names.
    struct StrayExtent {
        double half_size;
        int clean_rounds;
    };

    /// Enlarges the sectors of a cell by a StraySearch from film points of the cell.
    StraySearch::Traced extend_to_strays(int column, int row, StrayExtent extent, PupilHalves& halves) const;

    /// Stores the sectors of a cell.
    void store(int column, int row, const PupilHalves& halves);

    /// Index of a cell.
    int cell_index(int column, int row) const { return row * points_.columns + column; }

    PupilSearch search_;
    Points points_;
    std::vector<Node> nodes_;
    std::vector<PupilSector> sectors_;
    std::vector<PupilHalfSampling> halves_;
};

template <class Points>
auto PupilTable<Points>::node_of(const DirectionBox& box) -> Node {
    const auto l = static_cast<float>(box.centre().l), m = static_cast<float>(box.centre().m),
               half_width = static_cast<float>(box.half_width()), half_height = static_cast<float>(box.half_height());
    if constexpr (Map::kHalves == 1)
        return {l, half_width, half_height};
    else
        return {l, m, half_width, half_height};
}

template <class Points>
std::vector<OutlineRequest> PupilTable<Points>::requests_at(const OutlineLattice& lattice,
                                                            const LatticePoints& points) const {
    std::vector<OutlineRequest> requests;
    for (const OutlineLattice::Point point : points) {
        const CellPosition at = lattice.position(point);
        const Node box = box_at(at);
        for (int half = 0; half < Map::kHalves; ++half)
            requests.push_back({points_.film_point(at),
                                {static_cast<double>(box.centre_l), static_cast<double>(box.centre_m)},
                                static_cast<double>(box.half_width),
                                (half == 0 ? 1 : -1) * static_cast<double>(box.half_height)});
    }
    return requests;
}

template <class Points>
StraySearch::Traced PupilTable<Points>::extend_to_strays(int column, int row, StrayExtent extent,
                                                         PupilHalves& halves) const {
    const Map map = points_.map();
    const auto set_rays = [&](int round, std::uint32_t stream, const StraySearch::Points& directions, PupilRays& rays) {
        const auto start_of = points_.stray_points(column, row, round, stream);
        REALCAM_LANES
        for (int i = 0; i < StraySearch::kBlock; ++i) {
            const StrayPoint start = start_of(i);
            const Node box = map.interpolated(nodes_.data(), start.nodes);
            rays.set(i, start.film,
                     {static_cast<double>(box.centre_l + box.half_width * directions.x[i]),
                      static_cast<double>(box.centre_m + box.half_height * directions.y[i])});
        }
    };
    const StraySearch search{Points::kStrayRounds, static_cast<std::uint32_t>(cell_index(column, row)),
                             Points::kStrayDimension, extent.half_size, extent.clean_rounds};
    return search.widen(search_.lens(), set_rays, halves);
}

template <class Points>
void PupilTable<Points>::store(int column, int row, const PupilHalves& halves) {
    auto to = sectors_.begin() + cell_index(column, row) * Map::kHalves * kPupilSectors;
    for (const PupilRow& half : halves) to = std::copy(half.sectors().begin(), half.sectors().end(), to);
}

}  // namespace REALCAM_NAMESPACE
