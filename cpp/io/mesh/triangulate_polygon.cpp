#include "triangulate_polygon.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace realcam::io {
namespace {

/// Corner in the plane of projection.
struct Point {
    double x, y;
    bool operator==(const Point&) const = default;
};

/// Returns twice the signed area of a triangle, positive if it is counter-clockwise.
double double_area(Point a, Point b, Point c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// True if p is inside a counter-clockwise triangle or on its edge.
bool is_inside(Point p, Point a, Point b, Point c) {
    return double_area(a, b, p) >= 0 && double_area(b, c, p) >= 0 && double_area(c, a, p) >= 0;
}

/// Projects the polygon along the axis that is nearest to its normal (Newell's), so that it is counter-clockwise.
/// Returns an empty list if the normal is zero.
std::vector<Point> projected(std::span<const Vec3d> corners) {
    Vec3d normal = {0, 0, 0};
    const Vec3d origin = corners[0];
    for (std::size_t i = 0; i < corners.size(); ++i)
        normal += cross(corners[i] - origin, corners[(i + 1) % corners.size()] - origin);
    const double x = std::abs(normal.x), y = std::abs(normal.y), z = std::abs(normal.z);
    if (!(x + y + z > 0)) return {};
    std::vector<Point> points;
    points.reserve(corners.size());
    for (const Vec3d& corner : corners) {
        const Vec3d p = corner - origin;
        if (z >= x && z >= y)
            points.push_back(normal.z > 0 ? Point{p.x, p.y} : Point{p.y, p.x});
        else if (x >= y)
            points.push_back(normal.x > 0 ? Point{p.y, p.z} : Point{p.z, p.y});
        else
            points.push_back(normal.y > 0 ? Point{p.z, p.x} : Point{p.x, p.z});
    }
    return points;
}

/// Points sorted by the cells of a square grid, with about as many cells as points.
class Grid {
public:
    /// `members`: indices of the points that the grid holds; its size is that of all points.
    Grid(const std::vector<Point>& points, const std::vector<std::uint32_t>& members) {
        low_ = high_ = points[0];
        for (const Point& p : points) {
            low_ = {std::min(low_.x, p.x), std::min(low_.y, p.y)};
            high_ = {std::max(high_.x, p.x), std::max(high_.y, p.y)};
        }
        side_ = static_cast<std::size_t>(std::sqrt(static_cast<double>(members.size()))) + 1;
        begin_.assign(side_ * side_ + 1, 0);
        for (const std::uint32_t m : members) ++begin_[cell(points[m]) + 1];
        for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
        members_.resize(members.size());
        std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
        for (const std::uint32_t m : members) members_[next[cell(points[m])]++] = m;
    }

    /// True if `test` is true for any member in the cells that a triangle touches. Adds the number of visited cells and
    /// members to `work`.
    template <class Test>
    bool any_in(const std::array<Point, 3>& triangle, std::size_t& work, Test&& test) const {
        const auto [lowest, highest] = std::minmax({triangle[0].y, triangle[1].y, triangle[2].y});
        const std::size_t last = row(highest);
        for (std::size_t y = row(lowest); y <= last; ++y) {
            const auto [left, right] = columns_in_row(triangle, y);
            for (std::size_t c = y * side_ + left; c <= y * side_ + right; ++c) {
                work += 1 + begin_[c + 1] - begin_[c];
                for (std::uint32_t k = begin_[c]; k < begin_[c + 1]; ++k)
                    if (test(members_[k])) return true;
            }
        }
        return false;
    }

private:
    /// Returns the row or column of a coordinate.
    std::size_t bucket(double v, double low, double high) const {
        const double position = high > low ? (v - low) / (high - low) : 0;
        return std::min(static_cast<std::size_t>(std::clamp(position, 0.0, 1.0) * static_cast<double>(side_)),
                        side_ - 1);
    }
    /// Returns the first and last column of row y that a triangle may touch. A long triangle across the grid touches
    /// only a few cells of each row. One more row and column on both sides allow for rounding.
    std::pair<std::size_t, std::size_t> columns_in_row(const std::array<Point, 3>& triangle, std::size_t y) const {
        const double height = (high_.y - low_.y) / static_cast<double>(side_);
        const double bottom = low_.y + (static_cast<double>(y) - 1) * height, top = bottom + 3 * height;
        double left = high_.x, right = low_.x;
        for (std::size_t i = 0; i < 3; ++i) {
            const Point a = triangle[i], b = triangle[(i + 1) % 3];
            if (std::max(a.y, b.y) < bottom || std::min(a.y, b.y) > top) continue;
            for (const double end : {bottom, top}) {
                // The edge's end point, or its intersection with the border of the row.
                const double t = a.y == b.y ? (end == top ? 1 : 0) : std::clamp((end - a.y) / (b.y - a.y), 0.0, 1.0);
                const double x = a.x + t * (b.x - a.x);
                left = std::min(left, x);
                right = std::max(right, x);
            }
        }
        const std::size_t first = column(left), last = column(std::max(left, right));
        return {first > 0 ? first - 1 : 0, std::min(last + 1, side_ - 1)};
    }
    std::size_t column(double x) const { return bucket(x, low_.x, high_.x); }
    std::size_t row(double y) const { return bucket(y, low_.y, high_.y); }
    std::size_t cell(Point p) const { return row(p.y) * side_ + column(p.x); }

    Point low_{}, high_{};  // bounds of all points
    std::size_t side_ = 1;  // number of rows and of columns
    std::vector<std::uint32_t> begin_, members_;  // begin_[c] .. begin_[c + 1] of members_ are the points in cell c
};

/// Returns the corners with an interior angle above 180 degrees.
std::vector<std::uint32_t> reflex_corners(const std::vector<Point>& points) {
    // A corner that is straight up to rounding is not reflex.
    double size = 0;
    for (const Point& p : points) size = std::max({size, std::abs(p.x), std::abs(p.y)});
    const double rounding = 1e-12 * size * size;
    std::vector<std::uint32_t> found;
    const std::size_t n = points.size();
    for (std::size_t i = 0; i < n; ++i)
        if (double_area(points[(i + n - 1) % n], points[i], points[(i + 1) % n]) < -rounding)
            found.push_back(static_cast<std::uint32_t>(i));
    return found;
}

/// Ear clipping: cuts off triangles at convex corners that contain no other corner. If such a triangle contains any
/// corner, it contains a reflex one; so only these are searched, with a grid.
class EarClipper {
public:
    EarClipper(const std::vector<Point>& points, const std::vector<std::uint32_t>& reflex)
        : points_(points),
          grid_(points, reflex),
          is_reflex_(points.size(), false),
          before_(points.size()),
          after_(points.size()) {
        for (const std::uint32_t r : reflex) is_reflex_[r] = true;
        const auto n = static_cast<std::uint32_t>(points.size());
        for (std::uint32_t i = 0; i < n; ++i) before_[i] = (i + n - 1) % n, after_[i] = (i + 1) % n;
    }

    /// See triangulate_polygon.
    bool clip(std::vector<PolygonTriangle>& triangles, Checkpoint& checkpoint) {
        std::size_t corners_left = points_.size(), work = 0, since_last_ear = 0;
        const std::size_t max_work =
            400 * corners_left + 20000;  // far above that of polygons that do not cross themselves
        std::uint32_t corner = 0;
        while (corners_left > 3 && work < max_work) {
            const std::size_t work_before = work++;
            // If a full round has no ear, the polygon crosses itself, and any corner is as good as another.
            const bool clips = since_last_ear >= corners_left || is_ear(corner, work);
            checkpoint.pass(work - work_before);
            const std::uint32_t next = after_[corner];
            if (clips) {
                triangles.push_back({before_[corner], corner, next});
                remove(corner);
                --corners_left;
            }
            since_last_ear = clips ? 0 : since_last_ear + 1;
            // Continues at the corner after the ear's neighbour: this cuts ears all around, instead of a fan of slivers
            // at one corner.
            corner = clips ? after_[next] : next;
        }
        for (std::uint32_t second = after_[corner]; corners_left > 2; --corners_left, second = after_[second])
            triangles.push_back({corner, second, after_[second]});
        return work < max_work;
    }

private:
    /// True if the triangle at a corner can be cut off. Adds the work of the test to `work`.
    bool is_ear(std::uint32_t corner, std::size_t& work) const {
        if (is_reflex_[corner]) return false;
        const Point a = points_[before_[corner]], b = points_[corner], c = points_[after_[corner]];
        return !grid_.any_in({a, b, c}, work, [&](std::uint32_t other) {
            const Point p = points_[other];
            // Corners coincide in polygons with a hole: a pair of coincident edges connects the hole to the outline.
            return is_reflex_[other] && p != a && p != b && p != c && is_inside(p, a, b, c);
        });
    }

    void remove(std::uint32_t corner) {
        const std::uint32_t neighbours[] = {before_[corner], after_[corner]};
        after_[neighbours[0]] = neighbours[1];
        before_[neighbours[1]] = neighbours[0];
        is_reflex_[corner] = false;
        for (const std::uint32_t i : neighbours)
            is_reflex_[i] = is_reflex_[i] && double_area(points_[before_[i]], points_[i], points_[after_[i]]) < 0;
    }

    const std::vector<Point>& points_;
    Grid grid_;
    std::vector<bool> is_reflex_;
    std::vector<std::uint32_t> before_, after_;  // the neighbours of each corner in what is left of the polygon
};

}  // namespace

bool triangulate_polygon(std::span<const Vec3d> corners, std::vector<PolygonTriangle>& triangles,
                         Checkpoint& checkpoint) {
    const auto n = static_cast<std::uint32_t>(corners.size());
    if (n > 3) {
        const std::vector<Point> points = projected(corners);
        const std::vector<std::uint32_t> reflex =
            points.empty() ? std::vector<std::uint32_t>() : reflex_corners(points);
        if (!reflex.empty()) return EarClipper(points, reflex).clip(triangles, checkpoint);
    }
    checkpoint.pass(n);
    for (std::uint32_t i = 2; i < n; ++i) triangles.push_back({0, i - 1, i});
    return true;
}

}  // namespace realcam::io
