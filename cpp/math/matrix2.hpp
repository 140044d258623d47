#pragma once
#include <algorithm>
#include <cmath>

#include "hypotenuse.hpp"
#include "vec3.hpp"

namespace REALCAM_NAMESPACE {

/// 2 x 2 matrix.
struct Matrix2 {
    Vec2<double> first, second;  ///< rows

    Vec2<double> operator*(Vec2<double> v) const {
        return {first.x * v.x + first.y * v.y, second.x * v.x + second.y * v.y};
    }
    Matrix2 operator*(const Matrix2& m) const {
        const Vec2<double> a = *this * Vec2<double>{m.first.x, m.second.x},
                           b = *this * Vec2<double>{m.first.y, m.second.y};
        return {{a.x, b.x}, {a.y, b.y}};
    }
    Matrix2 operator+(const Matrix2& m) const {
        return {{first.x + m.first.x, first.y + m.first.y}, {second.x + m.second.x, second.y + m.second.y}};
    }
    friend Matrix2 operator*(double factor, const Matrix2& m) {
        return {{factor * m.first.x, factor * m.first.y}, {factor * m.second.x, factor * m.second.y}};
    }
    double determinant() const { return first.x * second.y - first.y * second.x; }
    double trace() const { return first.x + second.y; }
    Matrix2 transposed() const { return {{first.x, second.x}, {first.y, second.y}}; }
    /// Returns the inverse. The determinant must not be 0.
    Matrix2 inverse() const { return (1 / determinant()) * Matrix2{{second.y, -first.y}, {-second.x, first.x}}; }
};

/// Singular value decomposition m = left diag(larger, smaller) right^T, in which `left` and `right` are rotations. The
/// smaller value therefore has the sign of the determinant.
struct SingularValues {
    double larger, smaller;
    double left, right;  ///< angles of the rotations, rad
};

/// Returns the singular value decomposition in closed form (G. H. Golub and C. F. Van Loan, "Matrix Computations").
inline SingularValues singular_values(const Matrix2& m) {
    const double e = 0.5 * (m.first.x + m.second.y), f = 0.5 * (m.first.x - m.second.y);
    const double g = 0.5 * (m.second.x + m.first.y), h = 0.5 * (m.second.x - m.first.y);
    const double q = hypotenuse(e, h), r = hypotenuse(f, g);
    const double difference = r == 0 ? 0 : std::atan2(g, f), sum = q == 0 ? 0 : std::atan2(h, e);
    return {q + r, q - r, 0.5 * (sum + difference), 0.5 * (difference - sum)};
}

}  // namespace REALCAM_NAMESPACE
