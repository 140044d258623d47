#pragma once
#include <functional>
#include <map>
#include <memory>
#include <vector>

#include "pupil_outline_search.hpp"
#include "pupil_row_search.hpp"
#include "pupil_view.hpp"

namespace REALCAM_NAMESPACE {

/// The directions that pass a lens, for every film radius. Found with real rays; owns the memory of its view.
class Pupil {
public:
    static constexpr int kRows = PupilRowSearch::kRows;
    static constexpr int kSectors = PupilRow::kSectors;  ///< for m >= 0
    /// No search traces more, whatever the lens. There are 270 looks at a film radius: every eighth row, those around
    /// and beyond a dark one, the edge of the image, all rows, and half-way between them. Each row has outlines at both
    /// ends and seven places, looked for in five steps, and 256 rounds. Lenses that can be made take a hundredth of it.
    static constexpr int kMostBlocks = 270 * PupilSearch::kMostBlocks + OutlineSearch::most_blocks(kRows / 2 + 1) +
                                       OutlineSearch::most_blocks(kRows / 2) + OutlineSearch::most_blocks(kRows) +
                                       OutlineSearch::most_blocks(2 * kRows) + OutlineSearch::most_blocks(4 * kRows) +
                                       256 * kRows;

    /// `film_radius` in mm: the film point furthest from the axis. Throws InputError where it is no positive length.
    /// The pupil holds what passes at any of the wavelengths; none: the lens's design wavelength.
    ///
    /// `similar`: that of the lens in another state, whose edges are taken for about where these lie. It takes a fifth
    /// of the rays where they do, and a few more where they do not.
    Pupil(const LensSystem& lens, double film_radius, PupilTracer tracer = {},
          const std::vector<double>& wavelengths_nm = {}, const Pupil* similar = nullptr);

    PupilView view() const;
    double image_radius() const { return image_radius_; }
    /// Whether the table holds the pupil between its rows too. A stop of some micrometres moves by more than its own
    /// size from row to row.
    bool follows() const { return follows_; }
    /// Whether it was found near the edges of a similar one.
    bool is_moved() const { return is_moved_; }

private:
    /// Smaller ones, in direction cosines, move by more than their own size from row to row.
    static constexpr float kSmall = 1e-3f;
    /// Outermost rows, 0.4% of the image's area, that get no finer outline than a box.
    static constexpr int kEdgeRows = 2;

    void find_anew();

    /// Finds this pupil near a similar one, in whose boxes; false where the two differ too much.
    bool find_near(const Pupil& similar);

    /// Finds where the image ends near the end of a similar one; false where it ends elsewhere.
    bool find_edge_near(const Pupil& similar);

    /// Finds how far out there is light, and the region's box at each node from the axis to there.
    void find_nodes();

    /// The image ends where there is no light any more. The box there is that of the last light.
    void end_image(PupilRowSearch::Sight& sight);

    static PupilNode node_of(const PupilBox& box);

    /// The grid sees too little of the thin ends of a crescent at the edge of the image: its box must not shrink as
    /// fast as it does.
    void widen_last_nodes();

    PupilRowSearch rows() const { return {search_, image_radius_}; }
    double radius_at(double position) const { return rows().radius_at(position); }

    /// Whether a small pupil lies half-way between rows where its neighbours say. Of large ones the outlines see it;
    /// and slivers at the edge of the image are small without a small stop.
    bool nodes_follow() const;

    PupilNode node_at(double position) const;

    /// The key is the place in the table, in eighths of rows.
    using OutlinesByEighth = std::map<int, PupilOutline>;

    std::vector<OutlineLook> looks_at(const std::vector<int>& eighths) const;

    /// Looks half-way between outlines that have been seen, which lie `step` eighths before and behind.
    void look_between(int step, int rows, const std::function<bool(int row)>& wanted, OutlinesByEighth& seen) const;

    /// Rows that get an outline.
    int outlined_rows() const { return ends_inside_film_ ? kRows - kEdgeRows : kRows; }

    /// At the two ends of each row, and in between. Where it changes by much, as behind the last surface that cuts the
    /// light off, more film radii are looked at.
    OutlinesByEighth find_outlines() const;

    /// A row holds what passes at its two ends and in between, and a share more of what changes over it.
    void add_rows(const OutlinesByEighth& seen);

    /// From the beginning of a row to its end.
    static std::vector<PupilOutline> outlines_of(int row, const OutlinesByEighth& seen);

    /// Adds a row. Sends rays all over its surroundings in one round, and just beside the sectors in the next, and
    /// widens those that do not hold what passes, until so many rounds in a row find none. The reason is that corners
    /// of slivers lie between spokes, and ends of crescents between the points of a grid. Sectors that few rays pass do
    /// not tell where the light is, which may lie in several rings: the whole box takes their place.
    void add_row(int row, PupilRow sectors, double reach, int clean_rounds);

    PupilSearch search_;
    double film_radius_, image_radius_;
    bool ends_inside_film_ = false, follows_ = false, is_moved_ = false;
    std::vector<PupilNode> nodes_;
    PupilBox last_box_{};  ///< of the last light before the edge of the image
    /// In the boxes of the nodes: this pupil's, or those of the similar one from which this was found.
    std::shared_ptr<const OutlinesByEighth> seen_;
    std::vector<PupilSector> outline_;
};

}  // namespace REALCAM_NAMESPACE
