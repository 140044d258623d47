#include "pupil.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "../../math/random.hpp"

namespace realcam {

Pupil::Pupil(const LensSystem& lens, double film_radius, PupilTracer tracer, const std::vector<double>& wavelengths_nm,
             const Pupil* similar)
    : search_(lens, FilmMap::radial, std::move(tracer), wavelengths_nm),
      film_radius_(film_radius * (1 + 1e-6)),
      image_radius_(film_radius_) {
    lens.require_rotational("the search for a pupil");
    if (!(film_radius > 0) || !(film_radius <= kLongest))
        throw InputError("the film's radius must be a positive length, of at most 1e9 mm");
    was_found_near_similar_ = similar && find_near_similar(*similar);
    if (!was_found_near_similar_) find_from_scratch();
}

void Pupil::find_from_scratch() {
    image_radius_ = film_radius_;
    nodes_.clear();
    find_nodes();
    is_continuous_ = image_radius_ > 0 && nodes_are_continuous();
    if (image_radius_ > 0) {
        outlines_ = std::make_shared<const OutlinesByEighth>(find_outlines());
        add_rows(*outlines_);
    } else {
        outline_.assign(kRows * kSectors, PupilSector{});  // no light at all; samplers read the table nevertheless
    }
}

bool Pupil::find_near_similar(const Pupil& similar) {
    if (similar.film_radius_ != film_radius_ || !similar.is_continuous_ ||
        similar.nodes_.front().half_width <= kSmallHalfWidth)
        return false;
    nodes_ = similar.nodes_;
    ends_inside_film_ = similar.ends_inside_film_;
    is_continuous_ = true;
    outlines_ = similar.outlines_;
    const auto find_outlines_near = [this](const std::vector<int>& eighths, std::vector<PupilOutline>& expected) {
        for (const int eighth : eighths) expected.push_back(outlines_->at(eighth));
        constexpr double kSimilarTolerance = 2 * OutlineSearch::kNeighbourTolerance;
        return OutlineSearch::find_near(search_.lens(), requests_at(eighths), expected, kSimilarTolerance);
    };
    std::vector<PupilOutline> expected, found;
    constexpr double kMaxDifference = 0.03;  // in units of the boxes
    const auto are_similar = [&] { return mean_difference(expected, found) < kMaxDifference; };
    found = find_outlines_near({0}, expected);  // on the axis, a few rays show whether the stop has changed
    if (!are_similar()) return false;
    if (ends_inside_film_ && !find_edge_near_similar(similar)) return false;
    std::vector<int> eighths;
    for (const auto& [eighth, outline] : *outlines_) eighths.push_back(eighth);
    expected.clear();
    found = find_outlines_near(eighths, expected);
    if (!are_similar()) return false;
    OutlinesByEighth moved;
    for (std::size_t i = 0; i < found.size(); ++i) moved.emplace(eighths[i], found[i]);
    add_rows(moved);
    return true;
}

PupilView Pupil::view() const {
    // Rounded up, so that the last lit film point does not fall outside.
    const float radius = image_radius_ > 0 ? std::nextafter(static_cast<float>(image_radius_), 1e30f) : 0.0f;
    return {nodes_.data(),
            outline_.data(),
            kRows,
            radius,
            radius > 0 ? 1 / radius : 0.0f,
            static_cast<float>(search_.lens().index_squared())};
}

bool Pupil::find_edge_near_similar(const Pupil& similar) {
    PupilRowSearch::RadiusSearch search = rows().search_near_edge(similar.image_radius_, similar.last_box_);
    if (search.lit.empty() || search.dark.empty() || search.dark.back() > film_radius_) return false;
    set_image_edge(search);
    if (image_radius_ == similar.image_radius_) return true;
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
        image_radius_ = 0;
        nodes_.assign(kRows + 1, PupilNode{});
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
    image_radius_ = search.dark.back();
    last_box_ = search.lit.back().box;
    search.lit.push_back({image_radius_, last_box_});
}

PupilNode Pupil::node_of(const DirectionBox& box) {
    return {static_cast<float>(box.centre().l), static_cast<float>(box.half_width()),
            static_cast<float>(box.half_height())};
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
        const PupilNode node = node_at(row + 0.5);
        if (node.half_width < 0.5f * on_axis) continue;  // a sliver at the edge of the image
        const std::optional<DirectionBox> box = track.find(search_, radius_at(row + 0.5));
        const double width = static_cast<double>(node.half_width);
        if (!box || !(std::fabs(box->centre().l - static_cast<double>(node.centre)) < 0.5 * width) ||
            !(box->half_width() < 1.4 * width))
            return false;
    }
    return true;
}

PupilNode Pupil::node_at(double position) const {
    const int row = std::min(static_cast<int>(position), kRows - 1);
    const float f = static_cast<float>(position - row);
    const PupilNode &a = nodes_[static_cast<std::size_t>(row)], &b = nodes_[static_cast<std::size_t>(row) + 1];
    return {a.centre + f * (b.centre - a.centre), a.half_width + f * (b.half_width - a.half_width),
            a.half_height + f * (b.half_height - a.half_height)};
}

std::vector<OutlineRequest> Pupil::requests_at(const std::vector<int>& eighths) const {
    std::vector<OutlineRequest> requests;
    for (const int eighth : eighths) {
        const double position = eighth / 8.0;
        const PupilNode box = node_at(position);
        requests.push_back({{radius_at(position), 0},
                            {static_cast<double>(box.centre), 0},
                            static_cast<double>(box.half_width),
                            static_cast<double>(box.half_height)});
    }
    return requests;
}

void Pupil::find_midway(int step, int rows, const std::function<bool(int row)>& is_selected,
                        OutlinesByEighth& outlines) const {
    std::vector<int> eighths;
    std::vector<PupilOutline> expected;
    for (int eighth = step; eighth < 8 * rows; eighth += 2 * step) {
        if (!is_selected(eighth / 8)) continue;
        eighths.push_back(eighth);
        expected.push_back(mean_outline({&outlines.at(eighth - step), &outlines.at(eighth + step)}));
    }
    const std::vector<PupilOutline> found =
        OutlineSearch::find_near(search_.lens(), requests_at(eighths), expected, OutlineSearch::kNeighbourTolerance);
    for (std::size_t i = 0; i < found.size(); ++i) outlines.emplace(eighths[i], found[i]);
}

Pupil::OutlinesByEighth Pupil::find_outlines() const {
    // Outlines at every second row are searched without an expected one, those between them by successive halving.
    constexpr int kFirstStep = 16;            // eighths
    constexpr double kMaxRadiusRange = 0.08;  // over a row; rows over which the outline changes more get more outlines
    const int rows = outlined_rows();
    static_assert(kRows % 2 == 0 && kEdgeRows % 2 == 0);
    std::vector<int> first;
    for (int eighth = 0; eighth <= 8 * rows; eighth += kFirstStep) first.push_back(eighth);
    const std::vector<PupilOutline> found = OutlineSearch::find(search_.lens(), requests_at(first));
    OutlinesByEighth outlines;
    for (std::size_t i = 0; i < first.size(); ++i) outlines.emplace(first[i], found[i]);
    for (const int step : {8, 4}) find_midway(step, rows, [](int) { return true; }, outlines);
    std::vector<char> changes;
    for (int row = 0; row < rows; ++row) {
        const bool near_edge = ends_inside_film_ && row > kRows / 2;
        changes.push_back(near_edge || largest_radius_range(outlines_of(row, outlines)) > kMaxRadiusRange);
    }
    const auto does_change = [&](int row) { return changes[static_cast<std::size_t>(row)] != 0; };
    for (const int step : {2, 1}) find_midway(step, rows, does_change, outlines);
    return outlines;
}

void Pupil::add_rows(const OutlinesByEighth& outlines) {
    outline_.resize(kRows * kSectors);
    // Surroundings are larger, and rounds more, for rows over which the outline changes much.
    search_.lens().for_each(kRows, [&](int row) {
        if (row >= outlined_rows()) {
            add_row(row, PupilRow(box_outline()), 1.5, 16);
            return;
        }
        const PupilRow sectors(enclosing_outline(outlines_of(row, outlines)));
        const bool changes = outlines.contains(8 * row + 1);
        add_row(row, sectors, changes ? 1.4 : 1.15, changes ? 8 : 1);
    });
}

std::vector<PupilOutline> Pupil::outlines_of(int row, const OutlinesByEighth& all) {
    std::vector<PupilOutline> outlines;
    for (auto at = all.lower_bound(8 * row); at != all.end() && at->first <= 8 * row + 8; ++at)
        outlines.push_back(at->second);
    return outlines;
}

void Pupil::add_row(int row, PupilRow sectors, double half_size, int clean_rounds) {
    PupilHalves upper{std::move(sectors)};
    const auto set_rays = [&](int round, std::uint32_t stream, const StraySearch::Points& points, PupilRays& rays) {
        // The first rounds are at the outer and at the inner end of the row, the others at random film radii.
        constexpr double kOuterEnd = 0.9999;
        const double position = row + (round < 2   ? kOuterEnd
                                       : round < 4 ? 0.0
                                                   : static_cast<double>(sample_2d(stream, 0, 1).x));
        const PupilNode node = node_at(position);
        const double radius = radius_at(position);
        for (int i = 0; i < StraySearch::kBlock; ++i)
            rays.set(i, {radius, 0},
                     {static_cast<double>(node.centre + node.half_width * points.x[i]),
                      static_cast<double>(node.half_height * points.y[i])});
    };
    constexpr int kMaxRounds = 256;  // see kMaxBlocks
    const StraySearch search{kMaxRounds, static_cast<std::uint32_t>(row), 0, half_size, clean_rounds};
    const StraySearch::Traced traced = search.widen(search_.lens(), set_rays, upper);
    // Expected number of the rays all over the surroundings that lie inside the sectors: by the fraction of the area.
    const double expected_passing = traced.all_over * upper[0].area() / (2 * half_size * half_size);
    if (traced.passed_all_over < expected_passing / 4) upper[0] = PupilRow(box_outline());
    std::copy(upper[0].sectors().begin(), upper[0].sectors().end(), outline_.begin() + row * kSectors);
}

}  // namespace realcam
