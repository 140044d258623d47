#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pupil_grid_view.hpp"
#include "pupil_outline.hpp"
#include "pupil_outline_search.hpp"
#include "pupil_search.hpp"
#include "stray_search.hpp"

namespace REALCAM_NAMESPACE {

/// A rectangle on the film, mm, in the axes of the film.
struct FilmArea {
    Vec2<double> least, most;  ///< smallest and largest x and y
};

/// Mirror symmetries of a lens, including the placement of its film.
struct MirrorPlanes {
    bool x = false, y = false;  ///< `x`: symmetric under x -> -x; `y`: under y -> -y
};

/// True if the pupil of a film point depends only on the point's distance from the axis: for a centred, rotationally
/// symmetric lens with a flat film. The class Pupil finds and samples such pupils faster than PupilGrid.
bool has_radial_pupil(const LensSystem& lens);

/// Throws InputError unless the lens has a radial pupil. `what`: subject of the message, such as "a thin lens".
void require_radial_pupil(const LensSystem& lens, const std::string& what);

/// Returns the mirror symmetries of a lens; a symmetry may be missed for surface terms and apertures of unusual kinds.
MirrorPlanes mirror_planes(const LensSystem& lens);

/// Pupil of a lens of any kind: for every film point, the region of directions in which rays pass the lens, found by
/// tracing real rays. Owns the memory of its PupilGridView, from which rays are sampled. The film is divided into
/// cells. Nodes, at the corners of every second cell, hold the bounding boxes of the regions, and cells hold their
/// outlines.
class PupilGrid {
public:
    /// `film`: rectangle that contains all film points; `planes`: mirror symmetries, which save half of the film each;
    /// `wavelengths_nm`: the pupil contains the directions that pass at any of these wavelengths; if empty, at the
    /// design wavelength.
    PupilGrid(const LensSystem& lens, const FilmArea& film, MirrorPlanes planes = {}, PupilTracer tracer = {},
              const std::vector<double>& wavelengths_nm = {});

    /// View for sampling, valid as long as this object.
    PupilGridView view() const;
    /// True if light reaches any node of the film.
    bool is_lit() const { return is_lit_; }

private:
    static constexpr int kBlock = PupilTracer::kBlock;

    // Numbers of nodes, and index of a node in nodes_.
    int node_columns() const { return columns_ / kCellsPerPupilNode + 1; }
    int node_rows() const { return rows_ / kCellsPerPupilNode + 1; }
    std::size_t node_index(int column, int row) const {
        return static_cast<std::size_t>(row * node_columns() + column);
    }

    /// Returns the film point (mm) at a position in units of cells from the corner of the grid.
    Vec2<double> film_point(double column, double row) const;
    Vec2<double> node_point(int column, int row) const {
        return film_point(kCellsPerPupilNode * column, kCellsPerPupilNode * row);
    }

    /// Finds the box of each node, from a lit node outwards, by searching near the box predicted from its inner
    /// neighbours. Dark nodes copy the box of their inner neighbour.
    void find_nodes();

    /// Finds the box of one node; std::nullopt if no light reaches it. `found`: boxes of all nodes found so far; the
    /// search started at the node (`from_column`, `from_row`).
    std::optional<DirectionBox> find_node(int column, int row, const std::vector<std::optional<DirectionBox>>& found,
                                          int from_column, int from_row) const;

    /// Replaces the box of each node, which a grid of rays has found, by the bounding box of the node's outline.
    /// Returns the outlines: two halves for each node.
    std::vector<PupilOutline> refine_nodes();

    /// Adds the requests for the outlines of the upper and lower half at a film point; `column`, `row`: its position in
    /// units of cells.
    void add_requests(double column, double row, std::vector<OutlineRequest>& requests) const;

    /// Converts a box to the type of nodes.
    static PupilGridNode node_of(const DirectionBox& box);

    /// Interpolates the boxes of the nodes at a position in units of cells.
    PupilGridNode box_at(double column, double row) const;

    /// Grid of film points with odd numbers of columns and rows. Each point has two consecutive outline requests: for
    /// the upper half and for the lower half.
    struct Lattice {
        int columns, rows;

        /// Index of the request for the upper half at a point.
        std::size_t request(int column, int row) const { return 2 * static_cast<std::size_t>(row * columns + column); }
        /// Indices of the requests at points with an even column and an even row.
        std::vector<std::size_t> even_requests() const {
            std::vector<std::size_t> requests;
            for (int row = 0; row < rows; row += 2)
                for (int column = 0; column < columns; column += 2)
                    for (const std::size_t half : {0, 1}) requests.push_back(request(column, row) + half);
            return requests;
        }
    };

    /// Finds the outlines at points whose column or row is odd, near the mean of the outlines of their even neighbours.
    /// `tolerance`: see OutlineSearch::find_near.
    void find_midway(Lattice lattice, const std::vector<OutlineRequest>& requests, double tolerance,
                     std::vector<PupilOutline>& outlines) const;

    /// Returns the outlines at the corners of all cells, two halves for each. `node_outlines`: expected outlines at the
    /// nodes.
    std::vector<PupilOutline> outlines(const std::vector<PupilOutline>& node_outlines) const;

    /// Finds the sectors of all cells.
    void find_cells(const std::vector<PupilOutline>& node_outlines);

    /// Sets the sectors and weights of a cell. `outlines`: those at the corners of all cells.
    void set_cell(int column, int row, const std::vector<PupilOutline>& outlines);

    /// Sets a block of rays from random film points in a cell (StraySearch::SetRays). `positions`: in units of the
    /// half-widths of the box that is interpolated at the film point.
    void set_rays(int column, int row, std::uint32_t stream, const StraySearch::Points& positions,
                  PupilRays& rays) const;

    PupilSearch search_;
    FilmArea film_;  ///< the part that the grid covers
    MirrorPlanes planes_;
    int columns_ = 24, rows_ = 16;  ///< numbers of cells; halved by a mirror symmetry
    bool is_lit_ = false;
    std::vector<PupilGridNode> nodes_;
    std::vector<PupilGridCell> cells_;
    std::vector<PupilSector> sectors_;
};

}  // namespace REALCAM_NAMESPACE
