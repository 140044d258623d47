#pragma once
#include <memory>
#include <vector>

#include "pupil_row_search.hpp"
#include "pupil_table.hpp"

namespace REALCAM_NAMESPACE {

/// Pupil of a rotationally symmetric lens, found by tracing real rays.
class Pupil : public PupilTable<RadialFilmPoints> {
public:
    static constexpr int kRows = RadialFilmPoints::columns;  ///< rows of the table; there are kRows + 1 nodes
    static constexpr int kSectors = kPupilSectors;  ///< sectors of a row, for m >= 0
    /// Upper bound of the number of ray blocks that the search takes for any lens: 270 searches for boxes (every eighth
    /// row, the rows around and beyond a dark one, the edge of the image, all rows, and half-way between them),
    /// outlines at both ends of each row and at seven positions in between, found in five steps, and the rounds of
    /// StraySearch of each row. Lenses that can be made take a hundredth of it.
    static constexpr int kMaxBlocks = 270 * PupilSearch::kMaxBlocks + OutlineSearch::max_blocks(kRows / 2 + 1) +
                                      OutlineSearch::max_blocks(kRows / 2) + OutlineSearch::max_blocks(kRows) +
                                      OutlineSearch::max_blocks(2 * kRows) + OutlineSearch::max_blocks(4 * kRows) +
                                      RadialFilmPoints::kStrayRounds * kRows;

    /// `film_radius`: distance of the farthest film point from the axis, mm. `wavelengths_nm`: the pupil contains the
    /// directions that pass at any of these wavelengths; if empty, at the design wavelength. `similar`: pupil of the
    /// lens in another state (such as another focus distance), or null. The search then begins near its edges. This
    /// takes a fifth of the rays if the edges are similar, and a few more rays if they are not. Throws InputError if
    /// the lens is not rotationally symmetric, or if `film_radius` is not a positive length of at most 1e9 mm.
    Pupil(const LensSystem& lens, double film_radius, PupilTracer tracer = {},
          const std::vector<double>& wavelengths_nm = {}, const Pupil* similar = nullptr);

    /// Radius of the image circle, at most `film_radius`, mm; 0 if no light reaches the film.
    double image_radius() const { return points_.image_radius; }
    /// True if interpolation between the rows of the table describes the pupil. It does not for a stop of a few
    /// micrometres, whose pupil moves by more than its own size from row to row.
    bool is_continuous() const { return is_continuous_; }
    /// True if the pupil was found near the edges of a similar one.
    bool was_found_near_similar() const { return was_found_near_similar_; }

private:
    /// Half-width in direction cosines below which a pupil may move by more than its own size from row to row.
    static constexpr float kSmallHalfWidth = 1e-3f;
    /// Number of outermost rows (0.4% of the image's area) whose outline is the whole box.
    static constexpr int kEdgeRows = 2;
    /// Number of positions in a row at which outlines may be searched.
    static constexpr int kPositionsPerRow = 8;

    /// Finds the pupil without a similar one.
    void find_from_scratch();

    /// Finds the pupil near a similar one, whose boxes it adopts. Returns false if the two differ too much.
    bool find_near_similar(const Pupil& similar);

    /// Finds the edge of the image circle near that of a similar pupil. Returns false if it is not there.
    bool find_edge_near_similar(const Pupil& similar);

    /// Finds the radius of the image circle, and the box of the region at each node from the axis to that radius.
    void find_nodes();

    /// Sets the image radius to the innermost dark radius, and adds it to the lit radii with the box of the outermost
    /// one.
    void set_image_edge(PupilRowSearch::RadiusSearch& search);

    /// Sets a minimum width for the boxes of the last nodes, because the search grid misses the thin ends of the
    /// crescent at the edge of the image.
    void widen_last_nodes();

    /// Search over the rows of the table.
    PupilRowSearch rows() const { return {search_, points_}; }

    /// True if the boxes half-way between rows are where their neighbours predict them, or if the pupil is not small.
    /// Skips slivers at the edge of the image, which are small even if the stop is not.
    bool nodes_are_continuous() const;

    /// Number of rows with an outline of their own.
    int outlined_rows() const { return ends_inside_film_ ? kRows - kEdgeRows : kRows; }

    /// Finds the outlines at both ends of each row, at its midpoint, and more densely in rows over which the outline
    /// changes much, such as near the edge of the image.
    OutlineLattice find_outlines() const;

    /// Sets the sectors of all rows. They contain the outlines from one end of the row to the other, with a margin
    /// (enclosing_outline).
    void add_rows(const OutlineLattice& outlines);

    /// Sets the sectors of a row, after StraySearch has enlarged them. If few rays pass inside the sectors, they do not
    /// describe the light, which may form several rings; the whole box then replaces them.
    void add_row(int row, const PupilOutline& outline, StrayExtent extent);

    double film_radius_;  ///< mm
    bool ends_inside_film_ = false, is_continuous_ = false, was_found_near_similar_ = false;
    DirectionBox last_box_{};  ///< box of the outermost lit radius
    /// Outlines in the boxes of the nodes: this pupil's own, or those of the similar one from which it was found.
    std::shared_ptr<const OutlineLattice> outlines_;
};

}  // namespace REALCAM_NAMESPACE
