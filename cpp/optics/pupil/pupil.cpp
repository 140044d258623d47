#include "pupil.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace realcam {

Pupil::Pupil(const LensSystem& lens, double film_radius, PupilTracer tracer, const std::vector<double>& wavelengths_nm,
             const Pupil* similar)
    : PupilTable({lens, FilmMap::radial, std::move(tracer), wavelengths_nm}, {film_radius * (1 + 1e-6)}),
      film_radius_(points_.image_radius) {
    lens.require_rotational("the search for a pupil");
    if (!(film_radius > 0) || !(film_radius <= kLongest))
        throw InputError("the film's radius must be a positive length, of at most 1e9 mm");
    sectors_.resize(kRows * kSectors);
    was_found_near_similar_ = similar && find_near_similar(*similar);
    if (!was_found_near_similar_) find_from_scratch();
}

void Pupil::find_from_scratch() {
    points_.image_radius = film_radius_;
    nodes_.clear();
    find_nodes();
    is_continuous_ = image_radius() > 0 && nodes_are_continuous();
    if (!(image_radius() > 0)) return;  // no light at all; samplers read the table nevertheless
    outlines_ = std::make_shared<const OutlineLattice>(find_outlines());
    add_rows(*outlines_);
}

bool Pupil::find_near_similar(const Pupil& similar) {
    if (similar.film_radius_ != film_radius_ || !similar.is_continuous_ ||
        similar.nodes_.front().half_width <= kSmallHalfWidth)
        return false;
    nodes_ = similar.nodes_;
    ends_inside_film_ = similar.ends_inside_film_;
    is_continuous_ = true;
    outlines_ = similar.outlines_;
    OutlineLattice moved = *outlines_;
    const auto find_similar = [&](const LatticePoints& points) {
        constexpr double kSimilarTolerance = 2 * OutlineSearch::kNeighbourTolerance, kMaxDifference = 0.03;
        const std::vector<PupilOutline> expected = outlines_->outlines(points),
                                        found = find_near(moved, points, expected, kSimilarTolerance);
        moved.store(points, found);
        return mean_difference(expected, found) < kMaxDifference;
    };
    if (!find_similar({{0, 0}})) return false;  // on the axis, a few rays show whether the stop has changed
    if (ends_inside_film_ && !find_edge_near_similar(similar)) return false;
    if (!find_similar(outlines_->found_points())) return false;
    add_rows(moved);
    return true;
}

bool Pupil::find_edge_near_similar(const Pupil& similar) {
    PupilRowSearch::RadiusSearch search = rows().search_near_edge(similar.image_radius(), similar.last_box_);
    if (search.lit.empty() || search.dark.empty() || search.dark.back() > film_radius_) return false;
    set_image_edge(search);
    if (image_radius() == similar.image_radius()) return true;
    // The sectors of rows without outlines fill their boxes, which must therefore be accurate.
    constexpr int kFirst = kRows - kEdgeRows + 1;
    const PupilRowBoxes boxes = rows().boxes_of_rows(search.lit, kFirst);
    for (std::size_t row = kFirst; row < boxes.size(); ++row)
        if (boxes[row]) nodes_[row] = node_of(*boxes[row]);
    widen_last_nodes();
    return true;
}

void Pupil::find_nodes() {
    PupilRowSearch::RadiusSearch search = rows().search_from_axis();
    if (search.lit.empty()) {
        points_.image_radius = 0;
        nodes_.assign(kRows + 1, Node{});
        return;
    }
    rows().find_edge_of_image(search);
    ends_inside_film_ = !search.dark.empty();
    if (ends_inside_film_) set_image_edge(search);
    const PupilRowBoxes boxes = rows().boxes_of_rows(search.lit);
    std::optional<DirectionBox> box =
        *std::find_if(boxes.begin(), boxes.end(), [](const auto& found) { return found.has_value(); });
    for (const auto& found : boxes) {
        if (found) box = found;  // a node without light takes its inner neighbour's box
        nodes_.push_back(node_of(*box));
    }
    if (ends_inside_film_) widen_last_nodes();
}

void Pupil::set_image_edge(PupilRowSearch::RadiusSearch& search) {
    points_.image_radius = search.dark.back();
    last_box_ = search.lit.back().box;
    search.lit.push_back({points_.image_radius, last_box_});
}

void Pupil::widen_last_nodes() {
    constexpr float kMinWidth = 0.75f;  // relative to the last node before the outermost rows
    const float min_width = kMinWidth * nodes_[kRows - kEdgeRows].half_width;
    for (int i = kRows - kEdgeRows + 1; i <= kRows; ++i) {
        float& width = nodes_[static_cast<std::size_t>(i)].half_width;
        width = std::max(width, min_width);
    }
}

bool Pupil::nodes_are_continuous() const {
    const float on_axis = nodes_.front().half_width;
    if (on_axis > kSmallHalfWidth) return true;
    PupilTrack track;
    for (int row = 0; row < kRows; ++row) {
        const double middle = row + 0.5;
        const Node node = box_at({middle, 0});
        if (node.half_width < 0.5f * on_axis) continue;  // a sliver at the edge of the image
        const std::optional<DirectionBox> box = track.find(search_, points_.radius_at(middle));
        const double width = static_cast<double>(node.half_width);
        if (!box || !(std::fabs(box->centre().l - static_cast<double>(node.centre_l)) < 0.5 * width) ||
            !(box->half_width() < 1.4 * width))
            return false;
    }
    return true;
}

OutlineLattice Pupil::find_outlines() const {
    // Outlines at every second row are searched without an expected one, those between them by successive halving.
    constexpr double kMaxRadiusRange = 0.08;  // over a row; rows over which the outline changes more get more outlines
    constexpr double kTolerance = OutlineSearch::kNeighbourTolerance;
    static_assert(kRows % 2 == 0 && kEdgeRows % 2 == 0);
    const int rows = outlined_rows();
    OutlineLattice outlines(kPositionsPerRow * rows + 1, 1, Map::kHalves, 1.0 / kPositionsPerRow);
    find_every(2 * kPositionsPerRow, outlines);
    for (const int step : {kPositionsPerRow, kPositionsPerRow / 2})
        find_midway(outlines.midway_points(step), step, kTolerance, outlines);
    std::vector<char> changes;
    for (int row = 0; row < rows; ++row) {
        const bool near_edge = ends_inside_film_ && row > kRows / 2;
        changes.push_back(near_edge || largest_radius_range(outlines.outlines_of_cell(row, 0, 0)) > kMaxRadiusRange);
    }
    for (int step = kPositionsPerRow / 4; step > 0; step /= 2) {
        LatticePoints midway = outlines.midway_points(step);
        std::erase_if(midway, [&](OutlineLattice::Point point) {
            return !changes[static_cast<std::size_t>(point.column / kPositionsPerRow)];
        });
        find_midway(midway, step, kTolerance, outlines);
    }
    return outlines;
}

void Pupil::add_rows(const OutlineLattice& outlines) {
    // Surroundings are larger, and rounds more, for rows over which the outline changes much.
    search_.lens().for_each(kRows, [&](int row) {
        if (row >= outlined_rows()) {
            add_row(row, box_outline(), {1.5, 16});
            return;
        }
        const bool changes = outlines.has({kPositionsPerRow * row + 1, 0});
        add_row(row, enclosing_outline(outlines.outlines_of_cell(row, 0, 0)),
                changes ? StrayExtent{1.4, 8} : StrayExtent{1.15, 1});
    });
}

void Pupil::add_row(int row, const PupilOutline& outline, StrayExtent extent) {
    PupilHalves upper{PupilRow(outline)};
    const StraySearch::Traced traced = extend_to_strays(row, 0, extent, upper);
    // Expected number of the rays all over the surroundings that lie inside the sectors: by the fraction of the area.
    const double expected_passing = traced.all_over * upper[0].area() / (2 * extent.half_size * extent.half_size);
    if (traced.passed_all_over < expected_passing / 4) upper[0] = PupilRow(box_outline());
    store(row, 0, upper);
}

}  // namespace realcam
