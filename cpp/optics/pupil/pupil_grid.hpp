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

/// True if the pupil of a film point depends only on its distance from the axis, and directions at all film points
/// share one frame: for a centred, rotationally symmetric lens before a flat film. Its pupil is found and sampled
/// faster (Pupil).
bool has_radial_pupil(const LensSystem& lens);

/// Throws InputError unless the lens has a radial pupil: "`what` needs a centred lens of revolution before a flat film;
/// surface 3 is tilted".
void require_radial_pupil(const LensSystem& lens, const std::string& what);

MirrorPlanes mirror_planes(const LensSystem& lens);

/// Pupil of a lens of any kind: the directions that pass it, for every point on the film. Found by tracing real rays;
/// owns the memory of its view.
class PupilGrid {
public:
    /// The pupil contains the directions that pass at any of the wavelengths; if there are no wavelengths, at the
    /// lens's design wavelength.
    PupilGrid(const LensSystem& lens, const FilmArea& film, MirrorPlanes planes = {}, PupilTracer tracer = {},
              const std::vector<double>& wavelengths_nm = {});

    PupilGridView view() const;
    /// True if light arrives anywhere on the film.
    bool is_lit() const { return is_lit_; }

private:
    static constexpr int kBlock = PupilTracer::kBlock;

    int node_columns() const { return columns_ / kCellsPerPupilNode + 1; }
    int node_rows() const { return rows_ / kCellsPerPupilNode + 1; }
    std::size_t node_index(int column, int row) const {
        return static_cast<std::size_t>(row * node_columns() + column);
    }

    /// Film point at a position in cells from the corner of the grid.
    Vec2<double> film_point(double column, double row) const;
    Vec2<double> node_point(int column, int row) const {
        return film_point(kCellsPerPupilNode * column, kCellsPerPupilNode * row);
    }

    /// Finds the box of each node, from a lit one outwards, searching near the boxes of its inner neighbours. Dark
    /// nodes take the box of their inner neighbour.
    void find_nodes();

    std::optional<DirectionBox> look(int column, int row, const std::vector<std::optional<DirectionBox>>& found,
                                     int from_column, int from_row) const;

    /// Replaces the box of each node, found by a grid of rays, by the bounding box of the node's outline. Returns the
    /// outlines.
    std::vector<PupilOutline> sharpen_nodes();

    /// Adds the searches for both halves of a film point's region.
    void add_looks(double column, double row, std::vector<OutlineLook>& looks) const;

    static PupilGridNode node_of(const DirectionBox& box);

    PupilGridNode box_at(double column, double row) const;

    /// A grid of film points with odd numbers of columns and rows. Each point has two outline searches: of the upper
    /// and of the lower half.
    struct Lattice {
        int columns, rows;

        std::size_t look(int column, int row) const { return 2 * static_cast<std::size_t>(row * columns + column); }
        std::vector<std::size_t> even_looks() const {
            std::vector<std::size_t> looks;
            for (int row = 0; row < rows; row += 2)
                for (int column = 0; column < columns; column += 2)
                    for (const std::size_t half : {0, 1}) looks.push_back(look(column, row) + half);
            return looks;
        }
    };

    /// Searches the points whose column or row is odd, near the mean outline of their even neighbours.
    void look_between(Lattice lattice, const std::vector<OutlineLook>& looks, double tolerance,
                      std::vector<PupilOutline>& outlines) const;

    /// Finds the outlines at the corners of all cells. `of_nodes`: expected outlines at the nodes.
    std::vector<PupilOutline> outlines(const std::vector<PupilOutline>& of_nodes) const;

    void find_cells(const std::vector<PupilOutline>& of_nodes);

    void set_cell(int column, int row, const std::vector<PupilOutline>& outlines);

    /// Sets rays from random positions in a cell to points in units of the box interpolated there.
    void set_rays(int column, int row, std::uint32_t stream, const StraySearch::Places& positions,
                  PupilRays& rays) const;

    PupilSearch search_;
    FilmArea film_;  ///< the part that the grid covers
    MirrorPlanes planes_;
    int columns_ = 24, rows_ = 16;  ///< cells
    bool is_lit_ = false;
    std::vector<PupilGridNode> nodes_;
    std::vector<PupilGridCell> cells_;
    std::vector<PupilSector> sectors_;
};

}  // namespace REALCAM_NAMESPACE
