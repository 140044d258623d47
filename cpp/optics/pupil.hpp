#pragma once
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "../math/random.hpp"
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
          tracer_(tracer ? std::move(tracer)
                         : [](const LensView<float>& v, LensRays<float, kBlock>& r) { trace_lens(v, r); }) {
        image_radius_ = film_radius * (1 + 1e-6);
        find_nodes();
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
                static_cast<float>(path_.entry_index * path_.entry_index)};
    }
    double image_radius() const { return image_radius_; }

private:
    static constexpr int kBlock = 256;
    static constexpr int kEdgeRows =
        2;   ///< outermost rows, 0.4% of the image's area, that get no finer outline than a box
    static constexpr int kAzimuths = 64;  ///< intervals of azimuth over the half plane m >= 0
    static constexpr int kGrid = 48;      ///< points of the search grid along l; half of them along m >= 0
    /// The outline is widened by this share, for what can pass between the film radii and azimuths looked at.
    static constexpr double kMargin = 0.004;
    /// And by this share of how much it changes over a row.
    static constexpr double kSpreadShare = 0.05;

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
    void trace(const LensView<float>& view, double radius, int count, DirectionAt&& direction_at,
               Result&& result) const {
        LensRays<float, kBlock> rays;
        for (int first = 0; first < count; first += kBlock) {
            const int used = std::min(kBlock, count - first);
            for (int i = 0; i < kBlock; ++i) {
                const Direction d = direction_at(first + std::min(i, used - 1));
                const double n2 = path_.entry_index * path_.entry_index - d.l * d.l - d.m * d.m;
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
        Box box{kInfinity, -kInfinity, 0};
        for (int ring = 0; ring <= 8; ++ring)
            for (int spoke = 0; spoke <= 16; ++spoke) {
                const double r = last.clear_semi_diameter * ring / 8, angle = std::numbers::pi * spoke / 16;
                const Vec3d d = path_.entry_index * normalized(Vec3d{r * std::cos(angle) - radius, r * std::sin(angle),
                                                                     last.sag(r) - lens_.film_distance});
                box = {std::min(box.l_min, d.x), std::max(box.l_max, d.x), std::max(box.m_max, d.y)};
            }
        return grown(box, 0.02);
    }

    static Box grown(const Box& box, double share) {
        const double w = share * 2 * box.half_width(), h = share * box.m_max;
        return {box.l_min - w, box.l_max + w, box.m_max + h};
    }

    static Direction grid_point(const Box& box, int i) {
        const double a = (i % kGrid + 0.5) / kGrid, b = (i / kGrid + 0.5) / (kGrid / 2);
        return {box.l_min + a * (box.l_max - box.l_min), b * box.m_max};
    }

    /// Bounding box of the passing directions inside `search`; nothing where fewer than
    /// `wanted` points of the grid pass.
    std::optional<Box> passing_box(double radius, const Box& search, int wanted) const {
        Box box{kInfinity, -kInfinity, 0};
        Direction highest{0, 0};  // the middle of the top row's passing points
        double leftmost = 0;
        int passed = 0;
        trace(
            radius, kGrid * kGrid / 2, [&](int i) { return grid_point(search, i); },
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
        trace(
            to_stop, radius, kGrid * kGrid / 2, [&](int i) { return grid_point(search, i); },
            [&](int i, const LensRays<float, kBlock>& rays, int lane) {
                const float x = rays.origin.x[lane], y = rays.origin.y[lane];
                if (rays.status[lane] != 0 || !(x * x + y * y < least)) return;
                least = x * x + y * y;
                nearest = grid_point(search, i);
            });
        return nearest;
    }

    /// Boxes found so far, going outwards. The edges of the region move evenly, so the last two tell where it went:
    /// near the edge of the image circle it is a sliver that moves by more than its own width.
    struct Track {
        struct Seen {
            double radius;
            Box box;
        };
        std::optional<Seen> last, before;

        void add(double radius, const Box& box) {
            before = last;
            last = Seen{radius, box};
        }
        Box search_at(double radius) const {
            Box box = last->box;
            if (before) {
                const double f = (radius - last->radius) / (last->radius - before->radius);
                const auto ahead = [f](double now, double then) { return now + f * (now - then); };
                box.l_min = std::min(box.l_min, ahead(box.l_min, before->box.l_min));
                box.l_max = std::max(box.l_max, ahead(box.l_max, before->box.l_max));
                box.m_max = std::max(box.m_max, ahead(box.m_max, before->box.m_max));
            }
            return grown(box, 0.4);
        }
    };

    /// The box at a film radius further out than those on the track; adds it there.
    std::optional<Box> look(double radius, Track& track) const {
        std::optional<Box> box;
        if (track.last) {
            const Box search = track.search_at(radius);
            box = passing_box(radius, search, 48);
            const bool whole =
                box && box->l_min > search.l_min && box->l_max < search.l_max && box->m_max < search.m_max;
            if (!whole) box = find_box(radius, search);
        }
        if (!box) box = find_box(radius, box_of_last_surface(radius));
        if (box) track.add(radius, *box);
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
            const Edge edge = edge_of_image(static_cast<int>(boxes.rend() - last - 1), boxes);
            image_radius_ = edge.radius;
            ends_inside_film_ = true;
            boxes = look_from_axis();
            boxes.back() = edge.last_box;
        }
        std::optional<Box> box = *std::find_if(boxes.begin(), boxes.end(), lit);
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

    std::vector<std::optional<Box>> look_from_axis() const {
        std::vector<std::optional<Box>> boxes;
        Track track;
        for (int i = 0; i <= kRows; ++i) boxes.push_back(look(radius_at(i), track));
        return boxes;
    }

    /// Film radius at which a row, or a place inside one, lies.
    double radius_at(double position) const {
        const double inward = 1 - position / kRows;
        return image_radius_ * (1 - inward * inward);
    }

    struct Edge {
        double radius;  ///< the first without light
        Box last_box;  ///< just inside
    };

    Edge edge_of_image(int last_lit_row, const std::vector<std::optional<Box>>& boxes) const {
        Track track;
        for (int row = std::max(0, last_lit_row - 1); row <= last_lit_row; ++row)
            if (const auto& box = boxes[static_cast<std::size_t>(row)]) track.add(radius_at(row), *box);
        double dark = radius_at(last_lit_row + 1);
        for (int i = 0; i < 24; ++i) {
            const double middle = 0.5 * (track.last->radius + dark);
            if (!look(middle, track)) dark = middle;
        }
        return {dark, track.last->box};
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
            spoke[a] = {static_cast<double>(node.half_width) * std::cos(angle),
                        static_cast<double>(node.half_height) * std::sin(angle)};
        }
        const auto direction = [&](int azimuth, double reach) {
            return Direction{static_cast<double>(node.centre) + reach * spoke[azimuth].l, reach * spoke[azimuth].m};
        };
        int first[kRays], last[kRays];
        std::fill(first, first + kRays, -1);
        std::fill(last, last + kRays, -1);
        trace(
            radius, kRays * kSteps, [&](int i) { return direction(i / kSteps, kReach * (i % kSteps) / kSteps); },
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
            trace(
                radius, has_hole ? 2 * kRays : kRays,
                [&](int k) {
                    return direction(k % kRays, 0.5 * (open[k / kRays][k % kRays] + shut[k / kRays][k % kRays]));
                },
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

    /// A row holds what passes at its two ends and in between, and a share more of what changes over it. Where it
    /// changes by much, as behind the last surface that cuts the light off, more film radii are looked at.
    void find_outlines() {
        Outline near = outline_at(0);
        for (int row = 0; row < kRows; ++row) {
            if (ends_inside_film_ && row >= kRows - kEdgeRows) {
                add_sectors(box_outline());
                take_in_stray_rays(row, 1.5, 16);
                continue;
            }
            std::vector<Outline> looks{near, outline_at(row + 0.5), outline_at(row + 1.0)};
            near = looks.back();
            const bool near_edge = ends_inside_film_ && row > kRows / 2;
            const bool changes = near_edge || largest_spread(looks) > 0.08;
            const int steps = near_edge ? 8 : changes ? 8 : 2;
            for (int i = 1; i < steps; ++i)
                if (2 * i != steps) looks.push_back(outline_at(row + static_cast<double>(i) / steps));
            add_sectors(holding_all(looks));
            take_in_stray_rays(row, changes ? 1.4 : 1.15, changes ? 24 : 1);
        }
    }

    /// The whole box, and a little more. At the edge of the image circle the last light comes through a crescent, thin
    /// and bent, that spokes from its middle do not describe.
    static Outline box_outline() {
        Outline outline;
        for (int a = 0; a <= kAzimuths; ++a) {
            const double angle = std::numbers::pi * a / kAzimuths;
            outline.outer[a] = 1.3 / std::max(std::fabs(std::cos(angle)), std::fabs(std::sin(angle)));
        }
        return outline;
    }

    static double spread(const std::vector<Outline>& looks, int azimuth) {
        const auto [least, most] = std::minmax_element(
            looks.begin(), looks.end(),
            [azimuth](const Outline& x, const Outline& y) { return x.outer[azimuth] < y.outer[azimuth]; });
        return most->outer[azimuth] - least->outer[azimuth];
    }

    static double largest_spread(const std::vector<Outline>& looks) {
        double largest = 0;
        for (int a = 0; a <= kAzimuths; ++a) largest = std::max(largest, spread(looks, a));
        return largest;
    }

    static Outline holding_all(const std::vector<Outline>& looks) {
        Outline all;
        for (int a = 0; a <= kAzimuths; ++a) {
            double outer = 0, inner = kInfinity;
            for (const Outline& look : looks) {
                if (!(look.outer[a] > 0)) continue;
                outer = std::max(outer, look.outer[a]);
                inner = std::min(inner, look.inner[a]);
            }
            if (!(outer > 0)) continue;
            const double more = kSpreadShare * spread(looks, a);
            all.outer[a] = (1 + kMargin) * outer + more;
            all.inner[a] = std::max(0.0, (1 - kMargin) * inner - more);
        }
        return all;
    }

    /// Sends rays all over a row's surroundings, and widens the sectors beside which some pass, until so many rounds in
    /// a row find none: the corners of slivers lie between spokes, and the ends of crescents between the points of a
    /// grid.
    void take_in_stray_rays(int row, double reach, int clean_rounds) {
        constexpr int kMostRounds = 256;
        for (int round = 0, clean = 0; round < kMostRounds && clean < clean_rounds; ++round) {
            const auto stream = static_cast<std::uint32_t>(kMostRounds * row + round);
            // Both ends of the row first.
            const double position = row + (round == 0   ? 0.9999
                                           : round == 1 ? 0.0
                                                        : static_cast<double>(sample_2d(stream, 0, 1).x));
            const PupilNode node = node_at(position);
            Vec2f places[kBlock];
            for (std::uint32_t i = 0; i < kBlock; ++i) {
                const Vec2f u = sample_2d(stream, i, 0);
                places[i] = {static_cast<float>(reach) * (2 * u.x - 1), static_cast<float>(reach) * u.y};
            }
            const auto direction = [&](int i) {
                return Direction{static_cast<double>(node.centre + node.half_width * places[i].x),
                                 static_cast<double>(node.half_height * places[i].y)};
            };
            bool strayed = false;
            trace(radius_at(position), kBlock, direction,
                  [&](int i, bool passes) { strayed |= passes && take_in(row, places[i]); });
            clean = strayed ? 0 : clean + 1;
        }
    }

    /// Widens the sector of a place in the box such that it holds it; false where it does already.
    bool take_in(int row, Vec2f place) {
        for (int k = 0; k < kSectors; ++k) {
            PupilSector& s = outline_[static_cast<std::size_t>(row * kSectors + k)];
            const bool after = s.x * place.y - s.y * place.x >= 0;
            const bool before = place.x * (s.y + s.dy) - place.y * (s.x + s.dx) >= 0;
            if (!after || !before) continue;
            const float reach = (place.x * s.dy - place.y * s.dx) / (s.x * s.dy - s.y * s.dx);
            if (reach <= 1 && reach * reach >= s.hole_squared) return false;
            const float scale = std::max(1.0f, 1.03f * reach);
            s = {scale * s.x, scale * s.y, scale * s.dx, scale * s.dy,
                 std::min(s.hole_squared / (scale * scale), 0.98f * reach * reach / (scale * scale))};
            return true;
        }
        return false;
    }

    /// Cuts the outline into sectors of nearly equal area.
    void add_sectors(const Outline& outline) {
        constexpr int kFine = 16;  // points of azimuth in each interval
        constexpr int kPoints = kAzimuths * kFine;
        std::vector<double> outer(kPoints + 1), inner(kPoints + 1), area(kPoints + 1, 0.0);
        for (int i = 0; i <= kPoints; ++i) {
            const int a = std::min(i / kFine, kAzimuths - 1);
            const double f = static_cast<double>(i - a * kFine) / kFine;
            const double before = outline.outer[a], after = outline.outer[a + 1];
            // Where the reach jumps, the corner of a sliver lies between the two spokes, further out than either.
            const bool corner = std::fabs(after - before) > 0.2 * std::max(before, after);
            outer[static_cast<std::size_t>(i)] =
                corner ? 1.25 * std::max(before, after) : before + f * (after - before);
            inner[static_cast<std::size_t>(i)] = corner
                                                     ? std::min(outline.inner[a], outline.inner[a + 1])
                                                     : outline.inner[a] + f * (outline.inner[a + 1] - outline.inner[a]);
        }
        for (std::size_t i = 1; i <= kPoints; ++i)
            area[i] = area[i - 1] + outer[i] * outer[i - 1] - inner[i] * inner[i - 1] + 1e-12;
        std::size_t from = 0;
        for (int s = 0; s < kSectors; ++s) {
            std::size_t to = from + 1;
            while (to < kPoints - static_cast<std::size_t>(kSectors - 1 - s) &&
                   area[to] < area[kPoints] * (s + 1) / kSectors)
                ++to;
            if (s == kSectors - 1) to = kPoints;
            outline_.push_back(sector_over(outer, inner, from, to));
            from = to;
        }
    }

    /// The smallest triangle on these two azimuths whose outer edge lies outside the outline in between.
    static PupilSector sector_over(const std::vector<double>& outer, const std::vector<double>& inner, std::size_t from,
                                   std::size_t to) {
        const auto angle = [&](std::size_t i) {
            return std::numbers::pi * static_cast<double>(i) / static_cast<double>(outer.size() - 1);
        };
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
        return {static_cast<float>(scale * a.l), static_cast<float>(scale * a.m),
                static_cast<float>(scale * (b.l - a.l)), static_cast<float>(scale * (b.m - a.m)),
                static_cast<float>(hole * hole)};
    }

    LensSystem lens_;
    LensPath<float> path_;
    PupilTracer tracer_;
    double image_radius_ = 0;
    bool ends_inside_film_ = false;
    std::vector<PupilNode> nodes_;
    std::vector<PupilSector> outline_;
};

}  // namespace REALCAM_NAMESPACE
