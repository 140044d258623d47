#pragma once
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "lens_path.hpp"
#include "pupil_view.hpp"

namespace REALCAM_NAMESPACE {

/// Traces float rays from the film of one lens; marks in `passes` those that leave the lens. The backend may bring a
/// faster one than the build's baseline.
using PupilTracer = std::function<void(const LensView<float>&, LensRays<float, 256>&)>;

/// The directions that pass a lens, for every film radius. Found with real rays; owns the memory of its view.
class Pupil {
  public:
    static constexpr int kRows = 48;
    static constexpr int kSectors = 32;  ///< for m >= 0

    /// `film_radius` in mm: the film point furthest from the axis.
    Pupil(const LensSystem& lens, double film_radius, PupilTracer tracer = nullptr)
        : lens_(round_iris(lens)),
          path_(lens_, LightDirection::to_scene, lens.wavelength_nm),
          tracer_(tracer ? std::move(tracer) : [](const LensView<float>& v, LensRays<float, kBlock>& r) { trace_lens(v, r); }) {
        image_radius_ = film_radius * (1 + 1e-6);
        find_nodes();
        if (image_radius_ > 0) {
            find_outlines();
        } else {
            outline_.assign(kRows * kSectors, PupilSector{});  // no light at all; a sampler still reads the table
        }
    }

    PupilView view() const {
        const float radius = static_cast<float>(image_radius_);
        return {nodes_.data(), outline_.data(), kRows, kSectors, radius, radius > 0 ? 1 / radius : 0.0f};
    }
    double image_radius() const { return image_radius_; }

  private:
    static constexpr int kBlock = 256;
    static constexpr int kAzimuths = 64;  ///< intervals of azimuth over the half plane m >= 0
    static constexpr int kGrid = 48;      ///< points of the search grid along l; half of them along m >= 0
    /// The outline is widened by this share, for what can pass between the film radii and azimuths looked at.
    static constexpr double kMargin = 0.004;
    static constexpr double kStep = static_cast<double>(kSectorStep);

    struct Box {
        double l_min, l_max, m_max;
        double l() const { return 0.5 * (l_min + l_max); }
        double half_width() const { return 0.5 * (l_max - l_min); }
    };
    struct Direction {
        double l, m;
    };
    /// Reach of the passing directions from the middle of the box, in units of the box, by azimuth.
    struct Outline {
        double outer[kAzimuths + 1] = {}, inner[kAzimuths + 1] = {};
    };

    /// Blades are ignored here and reject rays later; the circle around their opening holds all that pass.
    static LensSystem round_iris(LensSystem lens) {
        const double rim = lens.stop().clear_semi_diameter;
        if (lens.iris.blades > 0 && !lens.is_wide_open()) {
            const Iris<double> open = open_iris(lens.iris, lens.stop_semi_diameter, rim);
            const double h = open.apothem, q = open.curvature;
            const double linear = (1 - q * h) * std::cos(std::numbers::pi / open.blades), constant = 2 * h - q * h * h;
            lens.stop_semi_diameter = std::min(rim, constant / (linear + std::sqrt(linear * linear + q * constant)));
        }
        lens.iris.blades = 0;
        return lens;
    }

    /// Which of these directions, from a film point at (radius, 0), pass the lens.
    template <class DirectionAt, class Result>
    void trace(double radius, int count, DirectionAt&& direction_at, Result&& result) const {
        trace(path_.view(), radius, count, direction_at,
              [&](int i, const LensRays<float, kBlock>& rays, int lane) { result(i, rays.status[lane] == 0); });
    }

    template <class DirectionAt, class Result>
    void trace(const LensView<float>& view, double radius, int count, DirectionAt&& direction_at, Result&& result) const {
        LensRays<float, kBlock> rays;
        for (int first = 0; first < count; first += kBlock) {
            const int used = std::min(kBlock, count - first);
            for (int i = 0; i < kBlock; ++i) {
                const Direction d = direction_at(first + std::min(i, used - 1));
                const double n2 = 1 - d.l * d.l - d.m * d.m;
                rays.origin.set(i, {static_cast<float>(radius), 0, static_cast<float>(lens_.film_distance)});
                rays.direction.set(i, {static_cast<float>(d.l), static_cast<float>(d.m),
                                       static_cast<float>(-std::sqrt(std::max(n2, 0.0)))});
                rays.status[i] = n2 > 0 ? 0 : static_cast<int>(RayStatus::missed);
            }
            tracer_(view, rays);
            for (int i = 0; i < used; ++i) result(first + i, rays, i);
        }
    }

    /// Box of the directions from a film point to the last surface's clear aperture.
    Box box_of_last_surface(double radius) const {
        const Surface& last = lens_.surfaces.back();
        Box box{1, -1, 0};
        for (int ring = 0; ring <= 8; ++ring)
            for (int spoke = 0; spoke <= 16; ++spoke) {
                const double r = last.clear_semi_diameter * ring / 8, angle = std::numbers::pi * spoke / 16;
                const Vec3d d = normalized(Vec3d{r * std::cos(angle) - radius, r * std::sin(angle),
                                                 last.sag(r) - lens_.film_distance});
                box = {std::min(box.l_min, d.x), std::max(box.l_max, d.x), std::max(box.m_max, d.y)};
            }
        return grown(box, 0.02);
    }

    static Box grown(const Box& box, double share) {
        const double w = share * 2 * box.half_width(), h = share * box.m_max;
        return {std::max(box.l_min - w, -1.0), std::min(box.l_max + w, 1.0), std::min(box.m_max + h, 1.0)};
    }

    static Direction grid_point(const Box& box, int i) {
        const double a = (i % kGrid + 0.5) / kGrid, b = (i / kGrid + 0.5) / (kGrid / 2);
        return {box.l_min + a * (box.l_max - box.l_min), b * box.m_max};
    }

    /// Bounding box of the passing directions inside `search`; nothing where fewer than
    /// `wanted` points of the grid pass.
    std::optional<Box> passing_box(double radius, const Box& search, int wanted) const {
        Box box{1, -1, 0};
        Direction highest{0, 0};  // the middle of the top row's passing points
        double leftmost = 0;
        int passed = 0;
        trace(radius, kGrid * kGrid / 2, [&](int i) { return grid_point(search, i); },
              [&](int i, bool passes) {
                  if (!passes) return;
                  const Direction d = grid_point(search, i);
                  if (d.m > highest.m) leftmost = d.l;
                  highest = {0.5 * (leftmost + d.l), d.m};
                  box = {std::min(box.l_min, d.l), std::max(box.l_max, d.l), std::max(box.m_max, d.m)};
                  ++passed;
              });
        if (passed < wanted) return std::nullopt;
        const double cell_l = (search.l_max - search.l_min) / kGrid, cell_m = search.m_max / (kGrid / 2);
        return refined(radius, box, highest, cell_l, cell_m);
    }

    /// Moves the box's three edges out to where the light ends, which is less than a cell away from the outermost
    /// grid point that passes. The region is symmetric in m, so it is widest along l where m is 0.
    Box refined(double radius, Box box, Direction highest, double cell_l, double cell_m) const {
        constexpr int kSteps = kBlock / 3;
        const Box from = box;
        const auto direction = [&](int i) {
            const double step = (i % kSteps + 1.0) / kSteps;
            switch (i / kSteps) {
                case 0: return Direction{from.l_min - step * cell_l, 0};
                case 1: return Direction{from.l_max + step * cell_l, 0};
                default: return Direction{highest.l, from.m_max + step * cell_m};
            }
        };
        trace(radius, 3 * kSteps, direction, [&](int i, bool passes) {
            if (!passes) return;
            const Direction d = direction(i);
            box = {std::min(box.l_min, d.l), std::max(box.l_max, d.l), std::max(box.m_max, d.m)};
        });
        box.l_min -= cell_l / kSteps;
        box.l_max += cell_l / kSteps;
        box.m_max += cell_m / kSteps;
        return box;
    }

    /// A small aperture falls through any grid: where too few rays pass, goes to the ray that comes nearest to the
    /// middle of the stop, in a smaller box.
    std::optional<Box> find_box(double radius, Box search) const {
        constexpr int kLevels = 6;
        for (int level = 0; level < kLevels; ++level) {
            if (const auto box = passing_box(radius, search, 48)) return box;
            const auto nearest = nearest_to_stop(radius, search);
            if (!nearest) break;
            const double w = search.half_width() / 6, h = search.m_max / 6;
            const auto few = passing_box(radius, search, 1);
            search = few ? grown(*few, 0.2) : Box{nearest->l - w, nearest->l + w, nearest->m + h};
        }
        return passing_box(radius, search, 1);
    }

    std::optional<Direction> nearest_to_stop(double radius, const Box& search) const {
        LensView<float> to_stop = path_.view();
        std::vector<LensStep<float>> steps(to_stop.steps, to_stop.steps + to_stop.count);
        const int stop = lens_.stop_index();
        const auto count = lens_.surfaces.size() - static_cast<std::size_t>(stop);
        steps[count - 1].rim_squared = std::numeric_limits<float>::max();
        to_stop.steps = steps.data();
        to_stop.count = static_cast<int>(count);
        std::optional<Direction> nearest;
        float least = std::numeric_limits<float>::max();
        trace(to_stop, radius, kGrid * kGrid / 2, [&](int i) { return grid_point(search, i); },
              [&](int i, const LensRays<float, kBlock>& rays, int lane) {
                  const float x = rays.origin.x[lane], y = rays.origin.y[lane];
                  if (rays.status[lane] != 0 || !(x * x + y * y < least)) return;
                  least = x * x + y * y;
                  nearest = grid_point(search, i);
              });
        return nearest;
    }

    /// The box at a film radius; starts from the box at a radius nearby where there is one.
    std::optional<Box> look(double radius, const std::optional<Box>& nearby) const {
        if (nearby) {
            const Box search = grown(*nearby, 0.4);
            const auto box = passing_box(radius, search, 48);
            const bool whole = box && box->l_min > search.l_min && box->l_max < search.l_max && box->m_max < search.m_max;
            if (whole) return box;
        }
        std::optional<Box> box = find_box(radius, box_of_last_surface(radius));
        // Near the edge of the image circle a sliver is left, close to where the last one was.
        if (!box && nearby) box = find_box(radius, grown(*nearby, 0.5));
        return box;
    }

    /// Finds how far out there is light, and the region's box at each node from the axis to there.
    void find_nodes() {
        std::vector<std::optional<Box>> boxes = look_from_axis();
        const auto lit = [](const std::optional<Box>& box) { return box.has_value(); };
        const auto last = std::find_if(boxes.rbegin(), boxes.rend(), lit);
        if (last == boxes.rend()) {
            image_radius_ = 0;
            nodes_.assign(kRows + 1, PupilNode{});
            return;
        }
        if (last != boxes.rbegin()) {
            image_radius_ = edge_of_image(static_cast<double>(boxes.rend() - last - 1), **last);
            boxes = look_from_axis();
        }
        std::optional<Box> box = *std::find_if(boxes.begin(), boxes.end(), lit);
        for (const auto& found : boxes) {
            if (found) box = found;  // a node without light takes its inner neighbour's box
            nodes_.push_back({static_cast<float>(box->l()), static_cast<float>(box->half_width()), static_cast<float>(box->m_max)});
        }
    }

    std::vector<std::optional<Box>> look_from_axis() const {
        std::vector<std::optional<Box>> boxes;
        std::optional<Box> last;
        for (int i = 0; i <= kRows; ++i) {
            boxes.push_back(look(radius_at(i), last));
            if (boxes.back()) last = boxes.back();
        }
        return boxes;
    }

    /// Film radius at which a row, or a place inside one, lies.
    double radius_at(double position) const {
        const double inward = 1 - position / kRows;
        return image_radius_ * (1 - inward * inward);
    }

    double edge_of_image(double last_lit_row, Box last) const {
        double lit = radius_at(last_lit_row), dark = radius_at(last_lit_row + 1);
        for (int i = 0; i < 12; ++i) {
            const double middle = 0.5 * (lit + dark);
            const std::optional<Box> box = look(middle, last);
            if (box) last = *box;
            (box ? lit : dark) = middle;
        }
        return dark;
    }

    PupilNode node_at(double position) const {
        const int row = std::min(static_cast<int>(position), kRows - 1);
        const float f = static_cast<float>(position - row);
        const PupilNode &a = nodes_[static_cast<std::size_t>(row)], &b = nodes_[static_cast<std::size_t>(row) + 1];
        return {a.centre + f * (b.centre - a.centre), a.half_width + f * (b.half_width - a.half_width),
                a.half_height + f * (b.half_height - a.half_height)};
    }

    /// Scans outwards along each azimuth, then halves the last and the first interval at which the light changes.
    Outline outline_at(double position) const {
        constexpr int kSteps = 24, kHalvings = 9;
        constexpr double kReach = 1.5;  // past the corner of the box
        const PupilNode node = node_at(position);
        const double radius = radius_at(position);
        constexpr int kRays = kAzimuths + 1;
        Direction spoke[kRays];
        for (int a = 0; a < kRays; ++a) {
            const double angle = std::numbers::pi * a / kAzimuths;
            spoke[a] = {static_cast<double>(node.half_width) * std::cos(angle), static_cast<double>(node.half_height) * std::sin(angle)};
        }
        const auto direction = [&](int azimuth, double reach) {
            return Direction{static_cast<double>(node.centre) + reach * spoke[azimuth].l, reach * spoke[azimuth].m};
        };
        int first[kRays], last[kRays];
        std::fill(first, first + kRays, -1);
        std::fill(last, last + kRays, -1);
        trace(radius, kRays * kSteps, [&](int i) { return direction(i / kSteps, kReach * (i % kSteps) / kSteps); },
              [&](int i, bool passes) {
                  if (!passes) return;
                  const int azimuth = i / kSteps, step = i % kSteps;
                  if (first[azimuth] < 0) first[azimuth] = step;
                  last[azimuth] = step;
              });
        double open[2][kRays], shut[2][kRays];  // [0] outer edge, [1] inner edge
        for (int a = 0; a < kRays; ++a) {
            open[0][a] = kReach * last[a] / kSteps;
            shut[0][a] = kReach * (last[a] + 1) / kSteps;
            open[1][a] = kReach * first[a] / kSteps;
            shut[1][a] = kReach * std::max(first[a] - 1, 0) / kSteps;
        }
        const bool has_hole = std::any_of(first, first + kRays, [](int step) { return step > 0; });
        for (int i = 0; i < kHalvings; ++i)
            trace(radius, has_hole ? 2 * kRays : kRays,
                  [&](int k) { return direction(k % kRays, 0.5 * (open[k / kRays][k % kRays] + shut[k / kRays][k % kRays])); },
                  [&](int k, bool passes) {
                      const int edge = k / kRays, a = k % kRays;
                      (passes ? open : shut)[edge][a] = 0.5 * (open[edge][a] + shut[edge][a]);
                  });
        Outline outline;
        for (int a = 0; a < kRays; ++a) {
            if (last[a] < 0) continue;
            outline.outer[a] = shut[0][a];
            outline.inner[a] = first[a] == 0 ? 0 : shut[1][a];
        }
        return outline;
    }

    /// A row holds what passes at its two ends and in its middle.
    void find_outlines() {
        Outline near = outline_at(0);
        for (int row = 0; row < kRows; ++row) {
            const Outline middle = outline_at(row + 0.5), far = outline_at(row + 1);
            Outline all;
            for (int a = 0; a <= kAzimuths; ++a) {
                double inner = kInfinity;
                for (const Outline* o : {&std::as_const(near), &middle, &far})
                    if (o->outer[a] > 0) {
                        all.outer[a] = std::max(all.outer[a], (1 + kMargin) * o->outer[a]);
                        inner = std::min(inner, (1 - kMargin) * o->inner[a]);
                    }
                all.inner[a] = std::isfinite(inner) ? inner : 0;
            }
            add_sectors(all);
            near = far;
        }
    }

    /// Cuts the outline into sectors of nearly equal area.
    void add_sectors(const Outline& outline) {
        constexpr int kFine = 16;  // points of azimuth in each interval
        constexpr int kPoints = kAzimuths * kFine;
        std::vector<double> outer(kPoints + 1), inner(kPoints + 1), area(kPoints + 1, 0.0);
        for (int i = 0; i <= kPoints; ++i) {
            const int a = std::min(i / kFine, kAzimuths - 1);
            const double f = static_cast<double>(i - a * kFine) / kFine;
            outer[static_cast<std::size_t>(i)] = outline.outer[a] + f * (outline.outer[a + 1] - outline.outer[a]);
            inner[static_cast<std::size_t>(i)] = outline.inner[a] + f * (outline.inner[a + 1] - outline.inner[a]);
        }
        for (std::size_t i = 1; i <= kPoints; ++i)
            area[i] = area[i - 1] + outer[i] * outer[i - 1] - inner[i] * inner[i - 1] + 1e-12;
        std::size_t from = 0;
        for (int s = 0; s < kSectors; ++s) {
            std::size_t to = from + 1;
            while (to < kPoints - static_cast<std::size_t>(kSectors - 1 - s) && area[to] < area[kPoints] * (s + 1) / kSectors) ++to;
            if (s == kSectors - 1) to = kPoints;
            outline_.push_back(sector_over(outer, inner, from, to));
            from = to;
        }
    }

    /// The smallest triangle on these two azimuths whose outer edge lies outside the outline in between.
    static PupilSector sector_over(const std::vector<double>& outer, const std::vector<double>& inner, std::size_t from,
                                   std::size_t to) {
        const auto angle = [&](std::size_t i) { return std::numbers::pi * static_cast<double>(i) / static_cast<double>(outer.size() - 1); };
        const auto point = [&](std::size_t i) {
            const double r = std::max(outer[i], 1e-9);
            return Direction{r * std::cos(angle(i)), r * std::sin(angle(i))};
        };
        const Direction a = point(from), b = point(to);
        const double twice_area = a.l * b.m - a.m * b.l;
        // Distance from the middle to the edge along an azimuth, by Cramer's rule.
        const auto edge = [&](std::size_t i) {
            return twice_area / ((b.m - a.m) * std::cos(angle(i)) - (b.l - a.l) * std::sin(angle(i)));
        };
        double scale = 1, hole = 1;
        for (std::size_t i = from; i <= to; ++i) scale = std::max(scale, outer[i] / edge(i));
        for (std::size_t i = from; i <= to; ++i) hole = std::min(hole, inner[i] / (scale * edge(i)));
        const double x = scale * a.l, y = scale * a.m;
        return {packed(x, y), packed(scale * b.l - x, scale * b.m - y), static_cast<float>(hole * hole)};
    }

    static std::int32_t packed(double x, double y) {
        const auto steps = [](double v) { return static_cast<std::int32_t>(std::lround(std::clamp(v / kStep, -32767.0, 32767.0))); };
        return static_cast<std::int32_t>(static_cast<std::uint32_t>(steps(y)) << 16 | (static_cast<std::uint32_t>(steps(x)) & 0xffffu));
    }

    LensSystem lens_;
    LensPath<float> path_;
    PupilTracer tracer_;
    double image_radius_ = 0;
    std::vector<PupilNode> nodes_;
    std::vector<PupilSector> outline_;
};

}  // namespace REALCAM_NAMESPACE
