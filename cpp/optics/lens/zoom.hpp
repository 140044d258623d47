#pragma once
#include <string>

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

}  // namespace REALCAM_NAMESPACE
