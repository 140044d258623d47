#pragma once
#include <string>
#include <vector>

#include "../prescription/lens_system.hpp"

namespace REALCAM_NAMESPACE {

/// Returns the index of the zoom position of this name. Throws InputError, listing the existing names, if there is
/// none.
int zoom_position_named(const LensSystem& lens, const std::string& name);

/// Returns the lens with its zoom ring in another position, counted from 0. The plane in focus is unchanged. A
/// diaphragm that is wide open remains wide open, and one that is closed keeps its f-number if the lens is fast enough
/// in the new position. Throws InputError if there is no such position, or the plane cannot be brought into focus
/// there.
LensSystem zoomed(const LensSystem& lens, int position);

/// Returns the lens with its zoom ring in the position of this name.
inline LensSystem zoomed(const LensSystem& lens, const std::string& name) {
    return zoomed(lens, zoom_position_named(lens, name));
}

/// Returns the lens zoomed to a focal length (of the lens at rest) between those of the positions; the nearest position
/// becomes the current one. The thicknesses that the ring changes, and a stop of varying size, follow monotone cubics
/// over the logarithm of the focal length, to where the focal length is the requested one. The film lies where distant
/// light is sharpest, plus an offset that is interpolated from those of the positions. Throws InputError also for a
/// focal length that the lens does not reach, and if the focal lengths of the positions are not in ascending or
/// descending order.
LensSystem zoomed_to_focal_length(const LensSystem& lens, double focal_length_mm);

/// Returns the focal lengths of the lens at rest in each of its zoom positions, mm.
std::vector<double> zoom_focal_lengths(const LensSystem& lens);

}  // namespace REALCAM_NAMESPACE
