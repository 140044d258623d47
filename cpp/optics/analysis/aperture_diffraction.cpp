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

/// z component of the cross product.
double cross(Point a, Point b) {
    return a.x * b.y - a.y * b.x;
}

Point operator-(Point a, Point b) {
    return {a.x - b.x, a.y - b.y};
}

/// Width of the fine rings of diffraction_cells.hpp, in double precision.
constexpr double kFineStep = static_cast<double>(kDiffractionMaxFrequency) / kDiffractionFineRings;

}  // namespace

double normal_angle(Point from, Point to) {
    return std::atan2(from.x - to.x, to.y - from.y) / (2 * std::numbers::pi);
}

namespace {

/// Returns the difference of two angles in turns, from -1/2 to 1/2.
double angle_between(double from, double to) {
    const double turn = to - from;
    return turn - std::round(turn);
}

/// Smallest change of direction between the two neighbours of a side, in turns, at which the side cuts off a corner. At
/// a corner of nine straight blades the direction changes by 1/9, and over two sides of a circle of 128 sides by 2/128.
constexpr double kCornerAngle = 12.0 / 360;

/// Side of a polygon.
struct Side {
    Point from, to;
    double angle;  ///< azimuth of the outward normal, turns
    bool begins_at_corner = false, ends_at_corner = false;

    Side(Point from, Point to) : from(from), to(to), angle(normal_angle(from, to)) {}
    double length() const { return hypotenuse(to.x - from.x, to.y - from.y); }
};

/// Returns the sides of a polygon after restoring its corners. The points of the polygon lie on the true edge, beside
/// its corners, so that a short side cuts each corner off. These sides are dropped, and their neighbours are extended
/// until they intersect.
std::vector<Side> sides_of(const std::vector<Point>& polygon) {
    const std::size_t count = polygon.size();
    std::vector<Side> sides;
    for (std::size_t k = 0; k < count; ++k) sides.emplace_back(polygon[k], polygon[(k + 1) % count]);
    const auto bend_at = [&](std::size_t k) {
        return std::fabs(angle_between(sides[(k + count - 1) % count].angle, sides[(k + 1) % count].angle));
    };
    std::vector<bool> cuts_corner(count);
    for (std::size_t k = 0; k < count; ++k) {
        const double turn = bend_at(k);
        cuts_corner[k] =
            turn > kCornerAngle && turn >= bend_at((k + 1) % count) && turn > bend_at((k + count - 1) % count);
    }
    std::vector<Side> result;
    for (std::size_t k = 0; k < count; ++k) {
        Side &before = sides[(k + count - 1) % count], &after = sides[(k + 1) % count];
        if (!cuts_corner[k]) continue;
        const Point along_before = before.to - before.from, along_after = after.to - after.from;
        const double t = cross(after.from - before.from, along_after) / cross(along_before, along_after);
        const Point corner = {before.from.x + t * along_before.x, before.from.y + t * along_before.y};
        before.to = after.from = corner;
        before.ends_at_corner = after.begins_at_corner = true;
    }
    for (std::size_t k = 0; k < count; ++k)
        if (!cuts_corner[k] && sides[k].length() > 0) result.push_back(sides[k]);
    return result;
}

/// Appends the sides of a polygon to `edges`, with their normals at both ends. On a smooth edge, the normal at the
/// point between two sides is the mean of their normals; it rotates uniformly along a side.
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
        double before = 0.5 * angle_between(sides[(k + count - 1) % count].angle, side.angle),
               after = 0.5 * angle_between(side.angle, sides[(k + 1) % count].angle);
        if (side.begins_at_corner) before = side.ends_at_corner ? 0 : after;
        if (side.ends_at_corner) after = side.begins_at_corner ? 0 : before;
        const double begin = side.angle - before;
        edges.push_back({side.length(),
                         {static_cast<float>(begin - std::floor(begin)), static_cast<float>(before + after),
                          static_cast<float>(1 / smooth_length[k])}});
    }
}

/// Adds |F|^2 of frequencies in one direction u (at `angle`, rad) to `power`, at the centres of the fine rings. F is
/// the Fourier transform of the aperture, the integral of exp(-2 pi i f u.x). By Gauss's theorem it is the sum over the
/// sides of i / (2 pi f) (u x e) sinc(f u.e) exp(-2 pi i f u.m), where e is the side and m its midpoint.
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
            // sinc = sin x / x with x^2 = f^2 along[k]; the error is below 1e-7 up to the largest x, 0.4.
            const double x2 = f * f * along[k], sinc = 1 - x2 * (1.0 / 6 - x2 * (1.0 / 120 - x2 * (1.0 / 5040)));
            sum_re += across[k] * sinc * re[k];
            sum_im += across[k] * sinc * im[k];
            const double next_re = re[k] * step_re[k] - im[k] * step_im[k];
            im[k] = re[k] * step_im[k] + im[k] * step_re[k];
            re[k] = next_re;
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
        const std::vector<Side> sides_of_polygon = sides_of(polygon);
        add_edges(sides_of_polygon, result.edges);
        sides.insert(sides.end(), sides_of_polygon.begin(), sides_of_polygon.end());
    }
    for (const Side& side : sides) {
        area += 0.5 * cross(side.from, side.to);
        perimeter += side.length();
    }
    result.edge_share =
        std::min(perimeter / (2 * kPi * kPi * area * static_cast<double>(kDiffractionMaxFrequency)), 1.0);

    // Opposite frequencies have the same power.
    result.cells.assign(kDiffractionCells, 0.0);
    double sum = 0;
    for (int azimuth = 0; azimuth < kDiffractionAzimuths; ++azimuth) {
        std::array<double, kDiffractionFineRings> power{};
        for (const double half : {0.25, 0.75})
            add_power_along(sides, kPi * (azimuth + half) / kDiffractionAzimuths, power);
        for (int ring = 0; ring < kDiffractionFineRings; ++ring) {
            const double f = (ring + 0.5) * kFineStep;
            const double fraction =
                power[static_cast<std::size_t>(ring)] * f * kFineStep * kPi / kDiffractionAzimuths / area;
            result.cells[static_cast<std::size_t>(stored_ring_of(ring) * kDiffractionAzimuths + azimuth)] += fraction;
            sum += fraction;
        }
    }
    result.found_share = sum + result.edge_share;
    for (double& fraction : result.cells) fraction *= (1 - result.edge_share) / sum;
    return result;
}

}  // namespace realcam
