#include "pupil_outline.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace realcam {

PupilDirection PupilOutline::fine_direction(int i) {
    static const auto all = [] {
        std::array<PupilDirection, kAzimuths * kFine + 1> directions;
        for (std::size_t k = 0; k < directions.size(); ++k) {
            const double angle = std::numbers::pi * static_cast<double>(k) / (kAzimuths * kFine);
            directions[k] = {std::cos(angle), std::sin(angle)};
        }
        return directions;
    }();
    return all[static_cast<std::size_t>(i)];
}

PupilOutline box_outline() {
    PupilOutline outline;
    for (int a = 0; a <= PupilOutline::kAzimuths; ++a) {
        const PupilDirection d = PupilOutline::direction(a);
        outline.outer[a] = 1.3 / std::max(std::fabs(d.l), std::fabs(d.m));
    }
    return outline;
}

double radius_range(const std::vector<PupilOutline>& outlines, int azimuth) {
    const auto [least, most] = std::minmax_element(
        outlines.begin(), outlines.end(),
        [azimuth](const PupilOutline& x, const PupilOutline& y) { return x.outer[azimuth] < y.outer[azimuth]; });
    return most->outer[azimuth] - least->outer[azimuth];
}

double largest_radius_range(const std::vector<PupilOutline>& outlines) {
    double largest = 0;
    for (int a = 0; a <= PupilOutline::kAzimuths; ++a) largest = std::max(largest, radius_range(outlines, a));
    return largest;
}

double mean_difference(const std::vector<PupilOutline>& a, const std::vector<PupilOutline>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        for (int k = 0; k <= PupilOutline::kAzimuths; ++k) {
            const bool changed = (a[i].outer[k] > 0) != (b[i].outer[k] > 0);
            sum += changed ? 1 : std::fabs(a[i].outer[k] - b[i].outer[k]);
        }
    return sum / static_cast<double>(a.size() * (PupilOutline::kAzimuths + 1));
}

PupilOutline mean_outline(const std::vector<const PupilOutline*>& outlines) {
    PupilOutline mean;
    for (int a = 0; a <= PupilOutline::kAzimuths; ++a) {
        const auto is_lit = [a](const PupilOutline* outline) { return outline->outer[a] > 0; };
        const auto has_hole = [a](const PupilOutline* outline) { return outline->inner[a] > 0; };
        const auto holes = std::count_if(outlines.begin(), outlines.end(), has_hole);
        if (!std::all_of(outlines.begin(), outlines.end(), is_lit) ||
            (holes > 0 && holes < static_cast<std::ptrdiff_t>(outlines.size())))
            continue;
        for (const PupilOutline* outline : outlines) {
            mean.outer[a] += outline->outer[a] / static_cast<double>(outlines.size());
            mean.inner[a] += outline->inner[a] / static_cast<double>(outlines.size());
        }
    }
    return mean;
}

PupilOutline enclosing_outline(const std::vector<PupilOutline>& outlines) {
    constexpr double kMargin = 0.004;  // relative to the radius
    constexpr double kRangeFraction = 0.05;  // of the range of radii
    PupilOutline all;
    for (int a = 0; a <= PupilOutline::kAzimuths; ++a) {
        double outer = 0, inner = std::numeric_limits<double>::infinity();
        for (const PupilOutline& outline : outlines) {
            if (!(outline.outer[a] > 0)) continue;
            outer = std::max(outer, outline.outer[a]);
            inner = std::min(inner, outline.inner[a]);
        }
        if (!(outer > 0)) continue;
        const double range_margin = kRangeFraction * radius_range(outlines, a);
        all.outer[a] = (1 + kMargin) * outer + range_margin;
        all.inner[a] = std::max(0.0, (1 - kMargin) * inner - range_margin);
    }
    return all;
}

PupilRow::PupilRow(const PupilOutline& outline) {
    constexpr int kAzimuths = PupilOutline::kAzimuths;
    constexpr int kFine = PupilOutline::kFine, kPoints = kAzimuths * kFine;
    double outer[kPoints + 1], inner[kPoints + 1], area[kPoints + 1];
    for (int i = 0; i <= kPoints; ++i) {
        const int a = std::min(i / kFine, kAzimuths - 1);
        const double f = static_cast<double>(i - a * kFine) / kFine;
        const double outer_0 = outline.outer[a], outer_1 = outline.outer[a + 1];
        // If the radius jumps between two azimuths, a corner of a sliver lies between them, further out than either.
        const bool is_jump = std::fabs(outer_1 - outer_0) > 0.2 * std::max(outer_0, outer_1);
        // At a corner between two rims, both sides of the outline are extrapolated linearly until they meet. At
        // azimuths 0 and pi the outline is assumed to be symmetric in m.
        const double extrapolated_0 = outer_0 + f * (outer_0 - outline.outer[a > 0 ? a - 1 : 1]);
        const double extrapolated_1 =
            outer_1 + (1 - f) * (outer_1 - outline.outer[a + 1 < kAzimuths ? a + 2 : kAzimuths - 1]);
        const double linear = outer_0 + f * (outer_1 - outer_0);
        outer[i] =
            is_jump ? 1.25 * std::max(outer_0, outer_1) : std::max(linear, std::min(extrapolated_0, extrapolated_1));
        inner[i] = is_jump ? std::min(outline.inner[a], outline.inner[a + 1])
                           : outline.inner[a] + f * (outline.inner[a + 1] - outline.inner[a]);
    }
    area[0] = 0;
    for (int i = 1; i <= kPoints; ++i)
        area[i] = area[i - 1] + outer[i] * outer[i - 1] - inner[i] * inner[i - 1] + 1e-12;
    int from = 0;
    for (int s = 0; s < kSectors; ++s) {
        int to = from + 1;
        while (to < kPoints - (kSectors - 1 - s) && area[to] < area[kPoints] * (s + 1) / kSectors) ++to;
        if (s == kSectors - 1) to = kPoints;
        sectors_.push_back(sector_over(outer, inner, from, to));
        from = to;
    }
}

double PupilRow::area() const {
    double twice = 0;
    for (const PupilSector& s : sectors_)
        twice += static_cast<double>((s.x * s.dy - s.y * s.dx) * (1 - s.hole_squared));
    return 0.5 * twice;
}

bool PupilRow::extend_to(Vec2f point) {
    const std::optional<std::size_t> at = sector_of(point);
    if (!at) return false;
    PupilSector& s = sectors_[*at];
    const float radius = relative_radius(s, point);
    if (contains(s, radius)) return false;
    const float scale = std::max(1.0f, 1.03f * radius);
    s = {scale * s.x, scale * s.y, scale * s.dx, scale * s.dy,
         std::min(s.hole_squared / (scale * scale), 0.98f * radius * radius / (scale * scale))};
    return true;
}

Vec2f PupilRow::sample_beside(std::size_t sector, Vec2f u) const {
    constexpr float kDepth = 0.15f;
    const PupilSector& s = sectors_[sector];
    // If there is a hole, a quarter of the points lies in it.
    const bool in_hole = s.hole_squared > 0 && u.y < 0.25f;
    const float radius = in_hole ? (1 - 4 * u.y * kDepth) * std::sqrt(s.hole_squared) : 1 + u.y * kDepth;
    return {radius * (s.x + u.x * s.dx), radius * (s.y + u.x * s.dy)};
}

std::optional<std::size_t> PupilRow::sector_of(Vec2f point) const {
    const auto begins_before = [point](const PupilSector& s) { return s.x * point.y - s.y * point.x >= 0; };
    const auto ends_before = [point](const PupilSector& s) {
        return !(point.x * (s.y + s.dy) - point.y * (s.x + s.dx) >= 0);
    };
    // Branch-free bisection: the branches would be unpredictable.
    static_assert((kSectors & (kSectors - 1)) == 0);
    std::size_t at = 0;
    for (std::size_t half = kSectors / 2; half > 0; half /= 2)
        at += half * static_cast<std::size_t>(ends_before(sectors_[at + half - 1]));
    if (ends_before(sectors_[at]) || !begins_before(sectors_[at])) return std::nullopt;
    return at;
}

PupilSector PupilRow::sector_over(const double* outer, const double* inner, int from, int to) {
    const auto point = [&](int i) {
        // The radius is at least 1e-3: if the other corner lies a thousand times as far out, the float32 triangle would
        // otherwise have no area.
        const double r = std::max(outer[i], 1e-3);
        const PupilDirection d = PupilOutline::fine_direction(i);
        return Point{r * d.l, r * d.m};
    };
    const Point a = point(from), b = point(to);
    const double twice_area = a.x * b.y - a.y * b.x;
    // By Cramer's rule, the distance from the centre to the edge along an azimuth is `twice_area` over this.
    const auto per_distance = [&](int i) {
        const PupilDirection d = PupilOutline::fine_direction(i);
        return (b.y - a.y) * d.l - (b.x - a.x) * d.m;
    };
    double outermost = twice_area, innermost = std::numeric_limits<double>::infinity();
    for (int i = from; i <= to; ++i) outermost = std::max(outermost, outer[i] * per_distance(i));
    for (int i = from; i <= to && innermost > 0; ++i) innermost = std::min(innermost, inner[i] * per_distance(i));
    const double scale = outermost / twice_area, hole = std::min(1.0, innermost / outermost);
    return {static_cast<float>(scale * a.x), static_cast<float>(scale * a.y), static_cast<float>(scale * (b.x - a.x)),
            static_cast<float>(scale * (b.y - a.y)), static_cast<float>(hole * hole)};
}

namespace {

constexpr int kAzimuths = PupilOutline::kAzimuths, kTurn = 2 * kAzimuths;

/// z component of the cross product.
double cross(Vec2<double> a, Vec2<double> b) {
    return a.x * b.y - a.y * b.x;
}

using RadiusTable = double (PupilOutline::*)[kAzimuths + 1];

/// Sets one edge of the moved outline. Returns false if the edge does not surround the centre of the box.
bool move_edge(const OutlineHalves& outline, const DirectionBox& from, const DirectionBox& to, RadiusTable edge,
               OutlineHalves& moved) {
    std::vector<Vec2<double>> corners;
    for (int i = 0; i <= kTurn; ++i) {
        const TurnAzimuth at(i % kTurn);
        const double radius = (outline[at.half].*edge)[at.azimuth];
        if (!(radius > 0)) return false;
        corners.push_back(
            {(from.centre().l + radius * from.half_width() * at.direction.x - to.centre().l) / to.half_width(),
             (from.centre().m + radius * from.half_height() * at.direction.y - to.centre().m) / to.half_height()});
    }
    const auto is_beyond = [&](Vec2<double> direction, std::size_t corner) {
        return cross(corners[corner], direction) >= 0;
    };
    std::size_t side = 0;
    for (int i = 0; i < kTurn; ++i) {
        const TurnAzimuth at(i);
        std::size_t tries = 0;
        while (!(is_beyond(at.direction, side) && !is_beyond(at.direction, side + 1))) {
            side = (side + 1) % kTurn;
            if (++tries > kTurn) return false;
        }
        const Vec2<double> along = {corners[side + 1].x - corners[side].x, corners[side + 1].y - corners[side].y};
        (moved[at.half].*edge)[at.azimuth] = cross(corners[side], along) / cross(at.direction, along);
    }
    for (const int end : {0, kAzimuths}) (moved[1].*edge)[end] = (moved[0].*edge)[end];
    return true;
}

/// True if the region has a central obstruction.
bool has_hole(const OutlineHalves& outline) {
    return outline[0].inner[0] > 0;
}

}  // namespace

TurnAzimuth::TurnAzimuth(int i) : half(i > kAzimuths), azimuth(half ? kTurn - i : i) {
    const PupilDirection d = PupilOutline::direction(azimuth);
    direction = {d.l, half ? -d.m : d.m};
}

OutlineHalves moved_outline(const OutlineHalves& outline, const DirectionBox& from, const DirectionBox& to) {
    OutlineHalves moved;
    if (!move_edge(outline, from, to, &PupilOutline::outer, moved)) return {};
    if (has_hole(outline) && !move_edge(outline, from, to, &PupilOutline::inner, moved)) return {};
    return moved;
}

}  // namespace realcam
