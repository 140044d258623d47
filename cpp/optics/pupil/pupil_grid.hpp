#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "direction_search.hpp"
#include "moved_outline.hpp"
#include "pupil_grid_view.hpp"
#include "pupil_outline_search.hpp"

namespace REALCAM_NAMESPACE {

/// A rectangle of the film, mm, in the axes of the film.
struct FilmArea {
    Vec2<double> least, most;  ///< x and y
};

/// The planes in which a lens, whatever its film is, is its own mirror image.
struct MirrorPlanes {
    bool x = false, y = false;  ///< what lies at -x, or -y, is as at x, or y
};

/// Whether the pupil of a film point depends on its distance from the axis alone, and lies in one plane's frame for
/// all: that of a centred lens of revolution before a flat film. It is found and sampled in less time (Pupil).
bool has_radial_pupil(const LensSystem& lens);

/// For `what` wants such a pupil. Throws InputError for other lenses: "`what` needs a centred lens of revolution before
/// a flat film; surface 3 is tilted".
void require_radial_pupil(const LensSystem& lens, const std::string& what);

MirrorPlanes mirror_planes(const LensSystem& lens);

/// The directions that pass a lens of any kind, for every place on the film. Found with real rays; owns the memory of
/// its view.
class PupilGrid {
public:
    /// The pupil holds what passes at any of the wavelengths; none: the lens's design wavelength.
    PupilGrid(const LensSystem& lens, const FilmArea& film, MirrorPlanes planes = {}, PupilTracer tracer = {},
              const std::vector<double>& wavelengths_nm = {});

    PupilGridView view() const;
    /// Whether light arrives anywhere on the film.
    bool is_lit() const { return is_lit_; }

private:
    static constexpr int kBlock = PupilTracer::kBlock;

    /// Sectors above and below the middle of the box.
    using Halves = std::array<PupilRow, 2>;

    int node_columns() const { return columns_ / kCellsPerPupilNode + 1; }
    int node_rows() const { return rows_ / kCellsPerPupilNode + 1; }
    std::size_t node_index(int column, int row) const {
        return static_cast<std::size_t>(row * node_columns() + column);
    }

    /// `column` and `row` count cells, from the corner.
    Vec2<double> film_point(double column, double row) const;
    Vec2<double> node_point(int column, int row) const {
        return film_point(kCellsPerPupilNode * column, kCellsPerPupilNode * row);
    }

    /// Finds the box of each node, from a lit one outwards: its neighbours tell where to look. Nodes in the dark take
    /// their inner neighbour's.
    void find_nodes();

    std::optional<DirectionBox> look(int column, int row, const std::vector<std::optional<DirectionBox>>& found,
                                     int from_column, int from_row) const;

    /// Gives each node the bounding box of its outline instead of what a grid of rays saw of it. Returns the outlines.
    std::vector<PupilOutline> sharpen_nodes();

    /// For both halves of a film point's region.
    void add_looks(double column, double row, std::vector<OutlineLook>& looks) const;

    static PupilGridNode node_of(const DirectionBox& box);

    PupilGridNode box_at(double column, double row) const;

    /// Places in columns and rows, odd numbers of both. Each has two looks: at the upper half, and at the lower one.
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

    /// Looks where column or row is odd, near what the places around have.
    void look_between(Lattice lattice, const std::vector<OutlineLook>& looks, double tolerance,
                      std::vector<PupilOutline>& outlines) const;

    /// At the corners of all cells. `of_nodes`: in boxes that were not sharp.
    std::vector<PupilOutline> outlines(const std::vector<PupilOutline>& of_nodes) const;

    void find_cells(const std::vector<PupilOutline>& of_nodes);

    void set_cell(int column, int row, const std::vector<PupilOutline>& outlines);

    /// Sends rays all over a cell and its surroundings, and widens the sectors beside which some pass, until so many
    /// rounds in a row find none. Returns how many passed.
    int take_in_strays(int column, int row, double reach, int clean_rounds, Halves& halves) const;

    /// A place close to the edge of the i-th sector of the region.
    static Vec2f beside_edge(const Halves& halves, int i, Vec2f u);

    /// From places in a cell, both from 0 to 1, to places in the box that is interpolated there.
    void set_rays(int column, int row, const Vec2Lanes<float, kBlock>& in_cell, const Vec2Lanes<float, kBlock>& places,
                  PupilRays& rays) const;

    DirectionSearch search_;
    FilmArea film_;  ///< what the grid covers of it
    MirrorPlanes planes_;
    int columns_ = 24, rows_ = 16;  ///< cells
    bool is_lit_ = false;
    std::vector<PupilGridNode> nodes_;
    std::vector<PupilGridCell> cells_;
    std::vector<PupilSector> sectors_;
};

}  // namespace REALCAM_NAMESPACE
