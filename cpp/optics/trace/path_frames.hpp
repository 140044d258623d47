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

/// True if a surface needs the code for LensKind::any: it is a freeform, or its aperture is not a centred circle.
inline bool is_free(const Surface& surface) {
    return !surface.form.is_none() || !surface.aperture_shape.is_plain();
}

/// Transform from the frame of surface `to` to that of its neighbour `from`.
inline Affine<double> neighbour(const LensSystem& lens, int from, int to) {
    return to > from ? frame_of_next(lens, from) : inverse_motion(frame_of_next(lens, to));
}

/// Returns -1 if the z axis of a crossing's surface points backwards in the frame of the surface crossed before, so
/// that light that travels to +z there travels to -z here; else 1. A frame at a right angle counts as pointing
/// forwards.
inline double turn_before(const LensSystem& lens, const std::vector<Crossing>& crossings, std::size_t crossing) {
    const int to = crossings[crossing].surface;
    const Affine<double> frame = crossing == 0 ? lens.surfaces[static_cast<std::size_t>(to)].placement.frame()
                                               : neighbour(lens, crossings[crossing - 1].surface, to);
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
