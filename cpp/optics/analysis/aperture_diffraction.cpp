#include "aperture_diffraction.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "../../math/hypotenuse.hpp"

namespace realcam {

namespace aperture_diffraction_detail {

namespace {

double cross(Point a, Point b) {
    return a.x * b.y - a.y * b.x;
}

Point operator-(Point a, Point b) {
    return {a.x - b.x, a.y - b.y};
}

/// Width of the fine rings of diffraction_cells.hpp, in double precision.
constexpr double kFineStep = static_cast<double>(kDiffractionReach) / kDiffractionFineRings;

}  // namespace

double normal_angle(Point from, Point to) {
    return std::atan2(from.x - to.x, to.y - from.y) / (2 * std::numbers::pi);
}

namespace {

/// Difference of two angles in turns, from -1/2 to 1/2.
double turn_between(double from, double to) {
    const double turn = to - from;
    return turn - std::round(turn);
}

/// Threshold in turns: a corner lies between a side and the second one after it if their directions differ by more.
/// Nine straight blades turn by 1/9 at a corner; a circle of 128 sides turns by 2/128 over two sides.
constexpr double kCorner = 12.0 / 360;

struct Side {
    Point from, to;
    double angle;  ///< direction of the outward normal, turns
    bool begins_at_corner = false, ends_at_corner = false;

    Side(Point from, Point to) : from(from), to(to), angle(normal_angle(from, to)) {}
    double length() const { return hypotenuse(to.x - from.x, to.y - from.y); }
};

/// Returns the sides of a polygon, with sharp corners. The polygon's points lie beside the corners of the true edge, so
/// that a short side cuts each corner off: it is dropped, and its neighbours are extended until they intersect.
std::vector<Side> sides_of(const std::vector<Point>& polygon) {
    const std::size_t count = polygon.size();
    std::vector<Side> sides;
    for (std::size_t k = 0; k < count; ++k) sides.emplace_back(polygon[k], polygon[(k + 1) % count]);
    const auto turn_over = [&](std::size_t k) {
        return std::fabs(turn_between(sides[(k + count - 1) % count].angle, sides[(k + 1) % count].angle));
    };
    std::vector<bool> cuts_corner(count);
    for (std::size_t k = 0; k < count; ++k) {
        const double turn = turn_over(k);
        cuts_corner[k] =
            turn > kCorner && turn >= turn_over((k + 1) % count) && turn > turn_over((k + count - 1) % count);
    }
    std::vector<Side> sharp;
    for (std::size_t k = 0; k < count; ++k) {
        Side &before = sides[(k + count - 1) % count], &after = sides[(k + 1) % count];
        if (!cuts_corner[k]) continue;
        const Point along = before.to - before.from, other = after.to - after.from;
        const double t = cross(after.from - before.from, other) / cross(along, other);
        const Point corner = {before.from.x + t * along.x, before.from.y + t * along.y};
        before.to = after.from = corner;
        before.ends_at_corner = after.begins_at_corner = true;
    }
    for (std::size_t k = 0; k < count; ++k)
        if (!cuts_corner[k] && sides[k].length() > 0) sharp.push_back(sides[k]);
    return sharp;
}

/// Appends the sides as edges with the normals at both ends; the normal turns uniformly along a smooth edge.
void add_edges(const std::vector<Side>& sides, std::vector<ApertureDiffraction::Edge>& edges) {
    const std::size_t count = sides.size();
    // Length of the smooth edge that contains a side: to the next corner in both directions.
    std::vector<double> smooth_length(count);
    double perimeter = 0;
    for (const Side& side : sides) perimeter += side.length();
    for (std::size_t k = 0; k < count; ++k) {
        double length = sides[k].length();
        for (std::size_t j = k; !sides[j].ends_at_corner && length < perimeter; length += sides[j].length())
            j = (j + 1) % count;
        for (std::size_t j = k; !sides[j].begins_at_corner && length < perimeter; length += sides[j].length())
            j = (j + count - 1) % count;
        smooth_length[k] = std::min(length, perimeter);
    }
    for (std::size_t k = 0; k < count; ++k) {
        const Side& side = sides[k];
        double before = 0.5 * turn_between(sides[(k + count - 1) % count].angle, side.angle),
               after = 0.5 * turn_between(side.angle, sides[(k + 1) % count].angle);
        if (side.begins_at_corner) before = side.ends_at_corner ? 0 : after;
        if (side.ends_at_corner) after = side.begins_at_corner ? 0 : before;
        const double begin = side.angle - before;
        edges.push_back({side.length(),
                         {static_cast<float>(begin - std::floor(begin)), static_cast<float>(before + after),
                          static_cast<float>(1 / smooth_length[k])}});
    }
}

/// Adds |F|^2 along one direction at the centres of the rings. By Gauss's theorem for exp(-2 pi i f u.x) over the
/// aperture, F is the sum over the sides of i / (2 pi f) (u x e) sinc(f u.e) exp(-2 pi i f u.m).
void add_power_along(const std::vector<Side>& sides, double angle, std::array<double, kDiffractionFineRings>& power) {
    constexpr double kPi = std::numbers::pi;
    const Point u = {std::cos(angle), std::sin(angle)};
    const std::size_t count = sides.size();
    std::vector<double> across(count), along(count), re(count), im(count), step_re(count), step_im(count);
    for (std::size_t k = 0; k < count; ++k) {
        const Point side = sides[k].to - sides[k].from;
        const double middle = 0.5 * (u.x * (sides[k].from.x + sides[k].to.x) + u.y * (sides[k].from.y + sides[k].to.y));
        across[k] = cross(u, side);
        along[k] = std::pow(kPi * (u.x * side.x + u.y * side.y), 2);
        const double phase = -2 * kPi * kFineStep * middle;
        step_re[k] = std::cos(phase);
        step_im[k] = std::sin(phase);
        re[k] = std::cos(0.5 * phase);
        im[k] = std::sin(0.5 * phase);
    }
    for (std::size_t ring = 0; ring < power.size(); ++ring) {
        const double f = (static_cast<double>(ring) + 0.5) * kFineStep;
        double sum_re = 0, sum_im = 0;
#pragma omp simd reduction(+ : sum_re, sum_im)
        for (std::size_t k = 0; k < count; ++k) {
            // sin x / x, with an error below 1e-7 up to the largest x, 0.4.
            const double x2 = f * f * along[k], sinc = 1 - x2 * (1.0 / 6 - x2 * (1.0 / 120 - x2 * (1.0 / 5040)));
            sum_re += across[k] * sinc * re[k];
            sum_im += across[k] * sinc * im[k];
            const double turned = re[k] * step_re[k] - im[k] * step_im[k];
            im[k] = re[k] * step_im[k] + im[k] * step_re[k];
            re[k] = turned;
        }
        power[ring] += (sum_re * sum_re + sum_im * sum_im) / (4 * kPi * kPi * f * f);
    }
}

}  // namespace

}  // namespace aperture_diffraction_detail

ApertureDiffraction diffraction_of(const PupilEdges& edges) {
    using namespace aperture_diffraction_detail;
    constexpr double kPi = std::numbers::pi;
    Point low = edges[0][0], high = low;
    for (const Point& point : edges[0]) {
        low = {std::min(low.x, point.x), std::min(low.y, point.y)};
        high = {std::max(high.x, point.x), std::max(high.y, point.y)};
    }
    ApertureDiffraction result{std::max(high.x - low.x, high.y - low.y), {}, 0, {}, 0};
    std::vector<Side> sides;
    double area = 0, perimeter = 0;
    for (std::vector<Point> polygon : edges) {
        for (Point& point : polygon)
            point = {(point.x - 0.5 * (low.x + high.x)) / result.width,
                     (point.y - 0.5 * (low.y + high.y)) / result.width};
        const std::vector<Side> own = sides_of(polygon);
        add_edges(own, result.edges);
        sides.insert(sides.end(), own.begin(), own.end());
    }
    for (const Side& side : sides) {
        area += 0.5 * cross(side.from, side.to);
        perimeter += side.length();
    }
    result.edge_share = std::min(perimeter / (2 * kPi * kPi * area * static_cast<double>(kDiffractionReach)), 1.0);

    // Opposite frequencies have the same power.
    result.cells.assign(kDiffractionCells, 0.0);
    double sum = 0;
    for (int azimuth = 0; azimuth < kDiffractionAzimuths; ++azimuth) {
        std::array<double, kDiffractionFineRings> power{};
        for (const double half : {0.25, 0.75})
            add_power_along(sides, kPi * (azimuth + half) / kDiffractionAzimuths, power);
        for (int ring = 0; ring < kDiffractionFineRings; ++ring) {
            const double f = (ring + 0.5) * kFineStep;
            const double share =
                power[static_cast<std::size_t>(ring)] * f * kFineStep * kPi / kDiffractionAzimuths / area;
            result.cells[static_cast<std::size_t>(cell_of_fine_ring(ring) * kDiffractionAzimuths + azimuth)] += share;
            sum += share;
        }
    }
    result.found_share = sum + result.edge_share;
    for (double& share : result.cells) share *= (1 - result.edge_share) / sum;
    return result;
}

}  // namespace realcam
