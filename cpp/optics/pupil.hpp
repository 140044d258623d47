#pragma once
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "../math/random.hpp"
#include "pupil_outline_search.hpp"
#include "pupil_row_search.hpp"
#include "pupil_view.hpp"

namespace REALCAM_NAMESPACE {

/// The directions that pass a lens, for every film radius. Found with real rays; owns the memory of its view.
class Pupil {
public:
    static constexpr int kRows = PupilRowSearch::kRows;
    static constexpr int kSectors = PupilRow::kSectors;  ///< for m >= 0
    /// No search traces more, whatever the lens: 270 looks at a film radius (two tables of nodes, both looked for ahead
    /// too, the edge of the image, half-way between rows), outlines at both ends and seven places of each row, and 256
    /// rounds for it. Lenses that can be made take a hundredth of it.
    static constexpr int kMostBlocks = 270 * PupilSearch::kMostBlocks + OutlineSearch::most_blocks(2 * kRows + 1) +
                                       OutlineSearch::most_blocks(6 * kRows) + 256 * kRows;

    /// `film_radius` in mm: the film point furthest from the axis. Throws InputError where it is no positive length.
    /// The pupil holds what passes at any of the wavelengths; none: the lens's design wavelength.
    Pupil(const LensSystem& lens, double film_radius, PupilTracer tracer = {},
          const std::vector<double>& wavelengths_nm = {})
        : search_(lens, std::move(tracer), wavelengths_nm), image_radius_(film_radius * (1 + 1e-6)) {
        if (!(film_radius > 0) || !(film_radius <= kLongest))
            throw InputError("the film's radius must be a positive length, of at most 1e9 mm");
        find_nodes();
        follows_ = image_radius_ > 0 && nodes_follow();
        if (image_radius_ > 0) {
            find_outlines();
        } else {
            outline_.assign(kRows * kSectors, PupilSector{});  // no light at all; a sampler still reads the table
        }
    }

    PupilView view() const {
        // Rounded up: the last lit film point must not fall outside.
        const float radius = image_radius_ > 0 ? std::nextafter(static_cast<float>(image_radius_), 1e30f) : 0.0f;
        return {nodes_.data(),
                outline_.data(),
                kRows,
                kSectors,
                radius,
                radius > 0 ? 1 / radius : 0.0f,
                static_cast<float>(search_.lens().index_squared())};
    }
    double image_radius() const { return image_radius_; }
    /// Whether the table holds the pupil between its rows too. A stop of some micrometres moves by more than its own
    /// size from row to row.
    bool follows() const { return follows_; }

private:
    /// Outermost rows, 0.4% of the image's area, that get no finer outline than a box.
    static constexpr int kEdgeRows = 2;

    /// Finds how far out there is light, and the region's box at each node from the axis to there.
    void find_nodes() {
        PupilRowBoxes boxes = rows().look_from_axis();
        const auto lit = [](const std::optional<PupilBox>& box) { return box.has_value(); };
        const auto last = std::find_if(boxes.rbegin(), boxes.rend(), lit);
        if (last == boxes.rend()) {
            image_radius_ = 0;
            nodes_.assign(kRows + 1, PupilNode{});
            return;
        }
        if (last != boxes.rbegin()) {
            const PupilRowSearch::Edge edge = rows().edge_of_image(static_cast<int>(boxes.rend() - last - 1), boxes);
            image_radius_ = edge.radius;
            ends_inside_film_ = true;
            boxes = rows().look_from_axis();
            boxes.back() = edge.last_box;
        }
        std::optional<PupilBox> box = *std::find_if(boxes.begin(), boxes.end(), lit);
        for (const auto& found : boxes) {
            if (found) box = found;  // a node without light takes its inner neighbour's box
            nodes_.push_back(
                {static_cast<float>(box->l()), static_cast<float>(box->half_width()), static_cast<float>(box->m_max)});
        }
        if (!ends_inside_film_) return;
        // The grid sees too little of a crescent's thin ends: its box must not shrink as fast as it does.
        const float least = 0.75f * nodes_[kRows - kEdgeRows].half_width;
        for (int i = kRows - kEdgeRows + 1; i <= kRows; ++i) {
            float& width = nodes_[static_cast<std::size_t>(i)].half_width;
            width = std::max(width, least);
        }
    }

    PupilRowSearch rows() const { return {search_, image_radius_}; }
    double radius_at(double position) const { return rows().radius_at(position); }

    /// Whether a small pupil lies half-way between rows where its neighbours say. Of large ones the outlines see it;
    /// and slivers at the edge of the image are small without a small stop.
    bool nodes_follow() const {
        constexpr float kSmall = 1e-3f;
        const float on_axis = nodes_.front().half_width;
        if (on_axis > kSmall) return true;
        PupilTrack track;
        for (int row = 0; row < kRows; ++row) {
            const PupilNode node = node_at(row + 0.5);
            if (node.half_width < 0.5f * on_axis) continue;
            const std::optional<PupilBox> box = search_.look(radius_at(row + 0.5), track);
            const double width = static_cast<double>(node.half_width);
            if (!box || !(std::fabs(box->l() - static_cast<double>(node.centre)) < 0.5 * width) ||
                !(box->half_width() < 1.4 * width))
                return false;
        }
        return true;
    }

    PupilNode node_at(double position) const {
        const int row = std::min(static_cast<int>(position), kRows - 1);
        const float f = static_cast<float>(position - row);
        const PupilNode &a = nodes_[static_cast<std::size_t>(row)], &b = nodes_[static_cast<std::size_t>(row) + 1];
        return {a.centre + f * (b.centre - a.centre), a.half_width + f * (b.half_width - a.half_width),
                a.half_height + f * (b.half_height - a.half_height)};
    }

    std::vector<PupilOutline> outlines_at(const std::vector<double>& positions) const {
        std::vector<OutlineLook> looks;
        for (const double position : positions) looks.push_back({radius_at(position), node_at(position)});
        return OutlineSearch::find(search_.lens(), looks);
    }

    /// A row holds what passes at its two ends and in between, and a share more of what changes over it. Where it
    /// changes by much, as behind the last surface that cuts the light off, more film radii are looked at.
    void find_outlines() {
        const int rows = ends_inside_film_ ? kRows - kEdgeRows : kRows;
        std::vector<double> positions;
        for (int i = 0; i <= 2 * rows; ++i) positions.push_back(0.5 * i);
        const std::vector<PupilOutline> halves = outlines_at(positions);
        std::vector<std::vector<PupilOutline>> looks;
        positions.clear();
        for (int row = 0; row < rows; ++row) {
            looks.emplace_back(halves.begin() + 2 * row, halves.begin() + 2 * row + 3);
            const bool near_edge = ends_inside_film_ && row > kRows / 2;
            if (!near_edge && largest_spread(looks.back()) <= 0.08) continue;
            for (const int eighth : {1, 2, 3, 5, 6, 7}) positions.push_back(row + eighth / 8.0);
        }
        const std::vector<PupilOutline> eighths = outlines_at(positions);
        for (std::size_t i = 0; i < eighths.size(); ++i)
            looks[static_cast<std::size_t>(positions[i])].push_back(eighths[i]);
        outline_.resize(kRows * kSectors);
        search_.lens().for_each(kRows, [&](int row) {
            if (row >= rows) {
                add_row(row, PupilRow(box_outline()), 1.5, 16);
                return;
            }
            const std::vector<PupilOutline>& seen = looks[static_cast<std::size_t>(row)];
            const bool changes = seen.size() > 3;
            add_row(row, PupilRow(holding_all(seen)), changes ? 1.4 : 1.15, changes ? 24 : 1);
        });
    }

    /// Adds a row. Sends rays all over its surroundings first, and widens the sectors beside which some pass, until so
    /// many rounds in a row find none: the corners of slivers lie between spokes, and the ends of crescents between the
    /// points of a grid. Sectors that few rays pass do not tell where the light is, which may lie in several rings: the
    /// whole box takes their place.
    void add_row(int row, PupilRow sectors, double reach, int clean_rounds) {
        constexpr int kMostRounds = 256, kBlock = PupilSearch::kBlock;
        int held = 0, passing = 0;  // of the rays inside the sectors
        for (int round = 0, clean = 0; round < kMostRounds && clean < clean_rounds; ++round) {
            const auto stream = static_cast<std::uint32_t>(kMostRounds * row + round);
            // Both ends of the row first.
            const double position = row + (round == 0   ? 0.9999
                                           : round == 1 ? 0.0
                                                        : static_cast<double>(sample_2d(stream, 0, 1).x));
            const PupilNode node = node_at(position);
            const double radius = radius_at(position);
            Vec2f places[kBlock];
            PupilRays rays;
            for (int i = 0; i < kBlock; ++i) {
                const Vec2f u = sample_2d(stream, static_cast<std::uint32_t>(i), 0);
                places[i] = {static_cast<float>(reach) * (2 * u.x - 1), static_cast<float>(reach) * u.y};
                rays.set(i, radius,
                         {static_cast<double>(node.centre + node.half_width * places[i].x),
                          static_cast<double>(node.half_height * places[i].y)});
            }
            bool passes[kBlock], strayed = false;
            search_.lens().trace(rays, passes);
            for (int i = 0; i < kBlock; ++i) {
                const bool holds = sectors.holds(places[i]);
                held += static_cast<int>(holds);
                passing += static_cast<int>(passes[i]);
                strayed |= passes[i] && !holds && sectors.take_in(places[i]);
            }
            clean = strayed ? 0 : clean + 1;
        }
        if (passing < held / 4) sectors = PupilRow(box_outline());
        std::copy(sectors.sectors().begin(), sectors.sectors().end(), outline_.begin() + row * kSectors);
    }

    PupilSearch search_;
    double image_radius_;
    bool ends_inside_film_ = false, follows_ = false;
    std::vector<PupilNode> nodes_;
    std::vector<PupilSector> outline_;
};

}  // namespace REALCAM_NAMESPACE
