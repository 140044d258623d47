#include "zoom.hpp"

#include <algorithm>

#include "focus.hpp"

namespace realcam {

int zoom_position_named(const LensSystem& lens, const std::string& name) {
    std::string names;
    for (std::size_t i = 0; i < lens.zoom.positions.size(); ++i) {
        if (lens.zoom.positions[i].name == name) return static_cast<int>(i);
        names += (i == 0 ? "\"" : ", \"") + lens.zoom.positions[i].name + '"';
    }
    throw InputError("lens \"" + lens.name + "\" has no zoom position \"" + name + "\"; " +
                     (names.empty() ? "it does not zoom" : "it has " + names));
}

LensSystem zoomed(const LensSystem& lens, int position) {
    const int count = static_cast<int>(lens.zoom.positions.size());
    if (position < 0 || position >= count)
        throw InputError("lens \"" + lens.name + "\" has no zoom position " + std::to_string(position) + "; " +
                         (count == 0 ? "it does not zoom" : "it has " + std::to_string(count) + ", counted from 0"));
    const double rest = lens.zoom.positions[static_cast<std::size_t>(lens.zoom.current)].focus_distance;
    LensSystem result = at_zoom_position(lens, position);
    if (lens.focus_distance != rest) result = focused(result, lens.focus_distance);
    if (lens.is_wide_open()) return result;
    return stopped_down(result, std::max(f_number_at_infinity(lens), f_number_at_infinity(result)));
}

}  // namespace realcam
