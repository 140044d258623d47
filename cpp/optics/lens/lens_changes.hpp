#pragma once
#include <algorithm>
#include <cstddef>
#include <map>
#include <utility>

#include "../prescription/lens_system.hpp"

namespace REALCAM_NAMESPACE {

/// Throws InputError where the lens has no surface of that number, counted from 0.
void check_surface_exists(const LensSystem& lens, int index);

namespace lens_changes_detail {

/// Brings a changed value into the zoom positions: into all of them where zooming does not change it.
template <class Get>
void change_zoom_value(ZoomRange& zoom, double change, const Get& value) {
    const double first = value(zoom.positions.front());
    const bool same = std::all_of(zoom.positions.begin(), zoom.positions.end(),
                                  [&](ZoomPosition& position) { return value(position) == first; });
    for (std::size_t i = 0; i < zoom.positions.size(); ++i)
        if (same || static_cast<int>(i) == zoom.current) value(zoom.positions[i]) += change;
}

}  // namespace lens_changes_detail

/// The lens with other surfaces in place of some, by their numbers from 0. All else stays, the film's place too:
/// focused() brings the picture into focus again. A thickness that zooming changes, changes in the current position. A
/// diaphragm that is wide open stays so. Throws InputError where there is no such surface, and LensFileError where the
/// lens cannot be built.
LensSystem with_surfaces(LensSystem lens, const std::map<int, Surface>& surfaces);

/// The same for one surface.
inline LensSystem with_surface(LensSystem lens, int index, const Surface& surface) {
    return with_surfaces(std::move(lens), {{index, surface}});
}

/// The lens with other blades, which leave the same area open: its f-number stays. Throws LensFileError.
LensSystem with_iris(LensSystem lens, const IrisShape& iris);

/// The same where what is left out stays. Throws InputError also where a round diaphragm gets no blades.
LensSystem with_iris(LensSystem lens, std::optional<int> blades, std::optional<double> rounding,
                     std::optional<double> rotation_deg);

/// The lens with a coating on all faces that it is for: a mirror's on all mirrors, any other on all faces between air
/// and glass; `unknown` takes what is known of both away. Cemented faces stay as they are. Throws InputError where the
/// lens has no such face.
LensSystem with_coating(LensSystem lens, const Coating& coating);

/// The same on given surfaces, counted from 0. Throws InputError where there is no such surface, and LensFileError
/// where the coating does not fit it.
LensSystem with_coating(LensSystem lens, const Coating& coating, const std::vector<int>& surfaces);

}  // namespace REALCAM_NAMESPACE
