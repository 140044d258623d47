#pragma once
#include <functional>
#include <map>
#include <memory>
#include <vector>

#include "pupil_outline_search.hpp"
#include "pupil_row_search.hpp"
#include "pupil_view.hpp"
#include "stray_search.hpp"

namespace REALCAM_NAMESPACE {

/// Pupil of a rotationally symmetric lens: the directions that pass it, for every film radius. Found by tracing real
/// rays; owns the memory of its view.
class Pupil {
public:
    static constexpr int kRows = PupilRowSearch::kRows;
    static constexpr int kSectors = PupilRow::kSectors;  ///< for m >= 0
    /// Upper bound of the number of ray blocks of a search, for any lens. There are 270 box searches at a film radius:
    /// every eighth row, the rows around and beyond a dark one, the edge of the image, all rows, and half-way between
    /// them. Each row has outlines at both ends and at seven positions in between, found in five steps, and 256 rounds
    /// of rays. Lenses that can be made take a hundredth of it.
    static constexpr int kMostBlocks = 270 * PupilSearch::kMostBlocks + OutlineSearch::most_blocks(kRows / 2 + 1) +
                                       OutlineSearch::most_blocks(kRows / 2) + OutlineSearch::most_blocks(kRows) +
                                       OutlineSearch::most_blocks(2 * kRows) + OutlineSearch::most_blocks(4 * kRows) +
                                       256 * kRows;

    /// `film_radius`: radius of the film point farthest from the axis, mm. Throws InputError unless it is a positive
    /// length of at most 1e9 mm. The pupil contains the directions that pass at any of the wavelengths; if there are no
    /// wavelengths, at the lens's design wavelength.
    ///
    /// `similar`: pupil of the lens in another state, near whose edges the search begins. Takes a fifth of the rays if
    /// the edges are alike, and a few rays more if they are not.
    Pupil(const LensSystem& lens, double film_radius, PupilTracer tracer = {},
          const std::vector<double>& wavelengths_nm = {}, const Pupil* similar = nullptr);

    PupilView view() const;
    double image_radius() const { return image_radius_; }
    /// True if the table describes the pupil between its rows, too. A stop of a few micrometres moves by more than its
    /// own size from row to row.
    bool follows() const { return follows_; }
    /// True if the pupil was found near the edges of a similar one.
    bool is_moved() const { return is_moved_; }

private:
    /// Pupils of a smaller half-width, in direction cosines, may move by more than their own size from row to row.
    static constexpr float kSmall = 1e-3f;
    /// Number of outermost rows, 0.4% of the image's area, whose outline is just the box.
    static constexpr int kEdgeRows = 2;

    void find_from_scratch();

    /// Finds this pupil near a similar one, whose boxes it adopts; returns false if the two differ too much.
    bool find_near(const Pupil& similar);

    /// Finds the edge of the image near that of a similar pupil; returns false if it lies elsewhere.
    bool find_edge_near(const Pupil& similar);

    /// Finds the radius of the image, and the region's box at each node from the axis to that radius.
    void find_nodes();

    /// Ends the image at the innermost dark radius, with the box of the outermost lit one.
    void end_image(PupilRowSearch::RowSearch& search);

    static PupilNode node_of(const DirectionBox& box);

    /// Limits how fast the boxes shrink at the edge of the image: the search grid misses the thin ends of the crescent
    /// there.
    void widen_last_nodes();

    PupilRowSearch rows() const { return {search_, image_radius_}; }
    double radius_at(double position) const { return rows().radius_at(position); }

    /// True if a small pupil lies half-way between rows where its neighbours suggest. Large pupils are checked by their
    /// outlines; slivers at the edge of the image, which are small without a small stop, are skipped.
    bool nodes_follow() const;

    PupilNode node_at(double position) const;

    /// Outlines by position in the table, in eighths of a row.
    using OutlinesByEighth = std::map<int, PupilOutline>;

    std::vector<OutlineLook> looks_at(const std::vector<int>& eighths) const;

    /// Searches half-way between known outlines, which lie `step` eighths before and behind.
    void look_between(int step, int rows, const std::function<bool(int row)>& wanted, OutlinesByEighth& seen) const;

    /// Number of rows with an outline of their own.
    int outlined_rows() const { return ends_inside_film_ ? kRows - kEdgeRows : kRows; }

    /// Finds the outlines at both ends of each row and in between. Rows in which the outline changes much, as beyond
    /// the last surface that vignettes, get more film radii.
    OutlinesByEighth find_outlines() const;

    /// Adds all rows. A row contains the outlines at its ends and in between, extended by a share of their change over
    /// it.
    void add_rows(const OutlinesByEighth& seen);

    /// Outlines from the beginning of a row to its end.
    static std::vector<PupilOutline> outlines_of(int row, const OutlinesByEighth& seen);

    /// Adds a row, whose sectors StraySearch widens. Sectors that few rays pass do not describe the light, which may
    /// form several rings: the whole box replaces them.
    void add_row(int row, PupilRow sectors, double reach, int clean_rounds);

    PupilSearch search_;
    double film_radius_, image_radius_;
    bool ends_inside_film_ = false, follows_ = false, is_moved_ = false;
    std::vector<PupilNode> nodes_;
    DirectionBox last_box_{};  ///< box of the outermost lit radius
    /// Outlines in the boxes of the nodes: this pupil's own, or those of the similar one from which it was found.
    std::shared_ptr<const OutlinesByEighth> seen_;
    std::vector<PupilSector> outline_;
};

}  // namespace REALCAM_NAMESPACE
