#pragma once
#include <cmath>
#include <cstddef>
#include <vector>

#include "../prescription/crossing.hpp"
#include "../prescription/surface_frames.hpp"
#include "lens_view.hpp"

namespace REALCAM_NAMESPACE {

namespace path_frames_detail {

inline bool has_placements(const LensSystem& lens) {
    for (const Surface& surface : lens.surfaces)
        if (!surface.placement.is_in_place()) return true;
    return false;
}

/// Whether a surface has what only the code for lenses of any kind knows.
inline bool is_free(const Surface& surface) {
    return !surface.form.is_none() || !surface.aperture_shape.is_plain();
}

/// From the frame of surface `to` to that of its neighbour `from`.
inline Affine<double> neighbour(const LensSystem& lens, int from, int to) {
    return to > from ? frame_of_next(lens, from) : inverse_motion(frame_of_next(lens, to));
}

/// -1 where the frame of a crossing's surface looks back, as seen from the surface met before it: light that goes to
/// +z there goes to -z here. A frame at a right angle is taken for one that looks ahead.
inline double turn_before(const LensSystem& lens, const std::vector<Crossing>& way, std::size_t crossing) {
    const int to = way[crossing].surface;
    const Affine<double> frame = crossing == 0 ? lens.surfaces[static_cast<std::size_t>(to)].placement.frame()
                                               : neighbour(lens, way[crossing - 1].surface, to);
    constexpr double kRightAngle = 1e-9;
    return frame.z.z < -kRightAngle ? -1 : 1;
}

template <class T>
FrameChange<T> change_to(const Affine<double>& frame) {
    return {static_cast<Vec3<T>>(frame.origin), static_cast<Vec3<T>>(frame.x), static_cast<Vec3<T>>(frame.y),
            static_cast<Vec3<T>>(frame.z), 1};
}

}  // namespace path_frames_detail

}  // namespace REALCAM_NAMESPACE
