#pragma once
#include <optional>
#include <vector>

#include "pupil_table.hpp"

namespace REALCAM_NAMESPACE {

/// Pupil of a lens of any kind, found by tracing real rays.
class PupilGrid : public PupilTable<PlanarFilmPoints> {
public:
    /// `film`: rectangle that contains all film points; `planes`: mirror symmetries, which save half of the film each;
    /// `wavelengths_nm`: the pupil contains the directions that pass at any of these wavelengths; if empty, at the
    /// design wavelength.
    PupilGrid(const LensSystem& lens, const FilmArea& film, MirrorPlanes planes = {}, PupilTracer tracer = {},
              const std::vector<double>& wavelengths_nm = {});

    /// True if light reaches any node of the film.
    bool is_lit() const { return is_lit_; }

private:
    // Numbers of nodes, and index of a node in nodes_.
    int node_columns() const { return points_.map().node_columns(); }
    int node_rows() const { return points_.map().node_rows(); }
    std::size_t node_index(int column, int row) const {
        return static_cast<std::size_t>(row * node_columns() + column);
    }
    Vec2<double> node_point(int column, int row) const {
        constexpr double kCells = Map::kCellsPerNode;
        return points_.film_point({kCells * column, kCells * row});
    }

    /// Finds the box of each node, from a lit node outwards, by searching near the box predicted from its inner
    /// neighbours. Dark nodes copy the box of their inner neighbour.
    void find_nodes();

    /// Finds the box of one node; std::nullopt if no light reaches it. `dx`, `dy`: step to its inner neighbour; `ring`:
    /// distance from the node at which the search started; `found`: boxes of all nodes found so far.
    std::optional<DirectionBox> find_node(int column, int row, int dx, int dy, int ring,
                                          const std::vector<std::optional<DirectionBox>>& found) const;

    /// Replaces the box of each node, which a grid of rays has found, by the bounding box of the node's outline.
    /// Returns the outlines: two halves for each node.
    std::vector<PupilOutline> refine_nodes();

    /// Finds the outlines at the corners of all cells. `node_outlines`: expected outlines at the nodes.
    OutlineLattice find_outlines(const std::vector<PupilOutline>& node_outlines) const;

    /// Sets the sectors of all cells, and the sampling of their halves.
    void add_cells(const OutlineLattice& outlines);
    void add_cell(int column, int row, const OutlineLattice& outlines);

    bool is_lit_ = false;
};

}  // namespace REALCAM_NAMESPACE
