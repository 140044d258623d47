#pragma once
#include <string>
#include <vector>

#include "../prescription/lens_system.hpp"

namespace REALCAM_NAMESPACE {

/// Returns the index of a zoom position. Throws InputError, listing the existing ones, if there is no such name.
int zoom_position_named(const LensSystem& lens, const std::string& name);

/// Returns the lens with its zoom ring in another position, counted from 0. The plane in focus is unchanged, a
/// diaphragm that is wide open stays so, and one that is closed keeps its f-number, as far as it opens there. Throws
/// InputError if there is no such position, or the plane cannot be brought into focus there.
LensSystem zoomed(const LensSystem& lens, int position);

/// Zooms to the position of this name.
inline LensSystem zoomed(const LensSystem& lens, const std::string& name) {
    return zoomed(lens, zoom_position_named(lens, name));
}

/// Zooms to a focal length (of the lens at rest) between those of the positions; the nearest position becomes the
/// current one. The thicknesses that the ring changes, and a stop of varying size, follow monotone cubics over the
/// logarithm of the focal length, to where the focal length is the requested one. The film lies where distant light is
/// sharpest, plus the interpolated offset of the positions' films from there. Throws InputError also for a focal length
/// that the lens does not reach, and if the focal lengths of the positions neither rise nor fall.
LensSystem zoomed_to_focal_length(const LensSystem& lens, double focal_length_mm);

/// Focal lengths of the lens at rest in each of its zoom positions, mm.
std::vector<double> zoom_focal_lengths(const LensSystem& lens);

}  // namespace REALCAM_NAMESPACE
