#pragma once
#include <string>
#include <vector>

#include "../prescription/lens_system.hpp"

namespace REALCAM_NAMESPACE {

/// The index of a zoom position. Throws InputError, naming those that there are.
int zoom_position_named(const LensSystem& lens, const std::string& name);

/// The lens with its zoom ring in another position, counted from 0. The plane in focus stays where it is, a diaphragm
/// that is wide open stays so, and one that is closed keeps its f-number, as far as it opens there.
/// Throws InputError where there is no such position, or the plane cannot be brought into focus there.
LensSystem zoomed(const LensSystem& lens, int position);

/// The same by name.
inline LensSystem zoomed(const LensSystem& lens, const std::string& name) {
    return zoomed(lens, zoom_position_named(lens, name));
}

/// The same at a focal length (of the lens at rest) between those of its positions, of which the nearest is then the
/// current one. What the ring moves, and a stop whose size changes, go from position to position on monotone cubics
/// over the logarithm of the focal length, to where the focal length is the one asked for. The film stands where
/// distant light is sharpest, plus what the positions differ from that. Throws InputError also for a focal length that
/// the lens does not reach, and for positions whose focal lengths neither rise nor fall.
LensSystem zoomed_to_focal_length(const LensSystem& lens, double focal_length_mm);

/// Of the lens at rest in each of its zoom positions, mm.
std::vector<double> zoom_focal_lengths(const LensSystem& lens);

}  // namespace REALCAM_NAMESPACE
