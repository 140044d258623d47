#pragma once
#include <cstdint>

#include "../../math/lanes.hpp"
#include "../prescription/lens_limits.hpp"

namespace REALCAM_NAMESPACE {

/// An ellipse or a rectangle on a surface, in coordinates u and v about its centre, whose axes are those of x and y
/// turned by an angle. Lengths in mm.
template <class T>
struct AperturePiece {
    T middle_x, middle_y;  ///< centre, relative to the vertex
    T cos, sin;  ///< of the angle from the x axis to the u axis
    T inverse_half_u, inverse_half_v;  ///< inverse half widths, or semi-axes, along u and v
    std::int32_t is_rectangle;  ///< 1: rectangle, 0: ellipse

    /// True if the point lies inside or on the edge.
    REALCAM_INLINE bool contains(T x, T y) const {
        const T dx = x - middle_x, dy = y - middle_y;
        const T u = inverse_half_u * (cos * dx + sin * dy), v = inverse_half_v * (cos * dy - sin * dx);
        const T larger = std::fabs(u) > std::fabs(v) ? std::fabs(u) : std::fabs(v);
        return select(is_rectangle != 0, larger, u * u + v * v) <= T(1);
    }
};

/// Clear aperture of a surface: the part of the circle of its clear semi-diameter that lies inside an outline and
/// outside all obscurations.
template <class T>
struct alignas(16) ApertureView {
    std::int32_t is_shaped;  ///< 0: only the circle bounds the aperture
    std::int32_t has_outer;  ///< 1: `outer` bounds the aperture
    std::int32_t corners;  ///< number of corners of a bounding polygon; 0: no polygon
    std::int32_t obscurations;  ///< number of obscurations
    AperturePiece<T> outer;
    AperturePiece<T> obscuration[kMaxObscurations];
    T corner_x[kMaxApertureCorners], corner_y[kMaxApertureCorners];  ///< relative to the vertex, mm
};

/// Blocks the rays outside an aperture, which is shaped: sets their `status` from 0 (RayStatus::ok) to `vignetted`.
/// `origin`: points of the rays on the surface, in its frame, mm.
template <class T, int N>
REALCAM_HD inline void cross_aperture(const ApertureView<T>& aperture, const Vec3Lanes<T, N>& origin,
                                      Lanes<int, N>& status, int vignetted) {
    Lanes<int, N> open;
    REALCAM_LANES
    for (int i = 0; i < N; ++i)
        open[i] = aperture.has_outer ? static_cast<int>(aperture.outer.contains(origin.x[i], origin.y[i])) : 1;
    for (int k = 0; k < aperture.obscurations; ++k) {
        const AperturePiece<T> piece = aperture.obscuration[k];
        REALCAM_LANES
        for (int i = 0; i < N; ++i) open[i] &= static_cast<int>(!piece.contains(origin.x[i], origin.y[i]));
    }
    if (aperture.corners > 0) {
        // Even-odd rule: a point is inside if a ray from it towards +x crosses an odd number of edges.
        Lanes<int, N> odd;
        REALCAM_LANES
        for (int i = 0; i < N; ++i) odd[i] = 0;
        for (int k = 0; k < aperture.corners; ++k) {
            const int next = k + 1 < aperture.corners ? k + 1 : 0;
            const T ax = aperture.corner_x[k], ay = aperture.corner_y[k];
            const T bx = aperture.corner_x[next], by = aperture.corner_y[next];
            const T slope = by == ay ? T(0) : (bx - ax) / (by - ay);
            REALCAM_LANES
            for (int i = 0; i < N; ++i) {
                const bool spans = (ay > origin.y[i]) != (by > origin.y[i]);
                const bool is_left = origin.x[i] < ax + (origin.y[i] - ay) * slope;
                odd[i] ^= static_cast<int>(spans & is_left);
            }
        }
        REALCAM_LANES
        for (int i = 0; i < N; ++i) open[i] &= odd[i];
    }
    REALCAM_LANES
    for (int i = 0; i < N; ++i) status[i] = select((status[i] == 0) & (open[i] == 0), vignetted, status[i]);
}

}  // namespace REALCAM_NAMESPACE
