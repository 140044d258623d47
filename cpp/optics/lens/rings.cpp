#include "rings.hpp"

#include <algorithm>
#include <utility>

#include "focus.hpp"
#include "lens_changes.hpp"
#include "zoom.hpp"

namespace realcam {

LensSystem with_rings(LensSystem lens, const Rings& rings) {
    if (const auto* position = std::get_if<std::string>(&rings.zoom)) lens = zoomed(lens, *position);
    if (const auto* focal_length_mm = std::get_if<double>(&rings.zoom))
        lens = zoomed_to_focal_length(lens, *focal_length_mm);
    if (rings.blades || rings.blade_rounding || rings.blade_rotation_deg)
        lens = with_iris(std::move(lens), rings.blades, rings.blade_rounding, rings.blade_rotation_deg);
    if (rings.f_number) {
        double f_number = *rings.f_number;
        if (rings.opens_as_far_as_it_can) f_number = std::max(f_number, f_number_at_infinity(wide_open(lens)));
        lens = stopped_down(std::move(lens), f_number);
    }
    if (rings.focus_distance) lens = focused(lens, *rings.focus_distance);
    return lens;
}

LensSystem wide_open(LensSystem lens) {
    lens.stop_semi_diameter = lens.stop().clear_semi_diameter;
    return lens;
}

}  // namespace realcam
