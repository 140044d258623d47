#include "zoom.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <optional>
#include <utility>

#include "../../math/curves.hpp"
#include "../../math/root.hpp"
#include "../prescription/lens_checks.hpp"
#include "focus.hpp"
#include "paraxial.hpp"

namespace realcam {
namespace {

/// Returns a lens at rest in a zoom position with the focus and diaphragm settings of `before`.
LensSystem with_rings_of(const LensSystem& before, LensSystem at_rest) {
    const ZoomRange& zoom = before.zoom;
    const double rest = zoom.positions[static_cast<std::size_t>(zoom.current)].focus_distance;
    if (before.focus_distance != rest) at_rest = focused(at_rest, before.focus_distance);
    if (before.is_wide_open()) return at_rest;
    return stopped_down(at_rest, std::max(f_number_at_infinity(before), f_number_at_infinity(at_rest)));
}

std::string zooms_from(const std::vector<double>& focal_lengths) {
    const auto [least, most] = std::minmax_element(focal_lengths.begin(), focal_lengths.end());
    char text[80];
    std::snprintf(text, sizeof text, "it zooms from %.5g to %.5g mm", *least, *most);
    return text;
}

/// The lens between its zoom positions, interpolated over the logarithm of the focal length.
class ZoomCurves {
public:
    ZoomCurves(const LensSystem& lens, const std::vector<double>& focal_lengths) : lens_(lens) {
        for (std::size_t i = 0; i < focal_lengths.size(); ++i)
            stops_.emplace_back(std::log(focal_lengths[i]), static_cast<int>(i));
        std::sort(stops_.begin(), stops_.end());
        for (std::size_t i = 0; i < lens.zoom.surfaces.size(); ++i)
            thicknesses_.push_back(curve([&](int position) { return at_position(position).thicknesses[i]; }));
        if (at_position(0).stop_semi_diameter > 0)
            stop_ = curve([&](int position) { return at_position(position).stop_semi_diameter; });
        focus_shift_ = curve([&](int position) {
            const LensSystem there = at_zoom_position(lens_, position);
            return there.film_distance - film_distance_at_infinity(there).value_or(0);
        });
    }

    /// Returns the lens at rest at the coordinate `position`, which is near the logarithm of its focal length. The film
    /// is not positioned yet.
    LensSystem at(double position) const {
        LensSystem lens = at_zoom_position(lens_, nearest(position));
        for (std::size_t i = 0; i < thicknesses_.size(); ++i)
            lens.surfaces[static_cast<std::size_t>(lens.zoom.surfaces[i])].thickness = thicknesses_[i].at(position);
        if (stop_) {
            Surface& stop = lens.surfaces[static_cast<std::size_t>(lens.stop_index())];
            lens.stop_semi_diameter = stop.clear_semi_diameter = stop_->at(position);
        }
        return lens;
    }

    double focus_shift(double log_focal_length) const { return focus_shift_->at(log_focal_length); }

private:
    const ZoomPosition& at_position(int position) const {
        return lens_.zoom.positions[static_cast<std::size_t>(position)];
    }

    template <class Value>
    MonotoneCurve curve(Value&& value) const {
        std::vector<double> x, y;
        for (const auto& [log_focal_length, position] : stops_) {
            x.push_back(log_focal_length);
            y.push_back(value(position));
        }
        return MonotoneCurve(std::move(x), std::move(y));
    }

    int nearest(double log_focal_length) const {
        const auto off = [&](const auto& stop) { return std::fabs(stop.first - log_focal_length); };
        return std::min_element(stops_.begin(), stops_.end(),
                                [&](const auto& a, const auto& b) { return off(a) < off(b); })
            ->second;
    }

    const LensSystem& lens_;
    std::vector<std::pair<double, int>> stops_;  ///< logarithm of the focal length, and index, of each position
    std::vector<MonotoneCurve> thicknesses_;
    std::optional<MonotoneCurve> stop_, focus_shift_;
};

}  // namespace

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
    return with_rings_of(lens, at_zoom_position(lens, position));
}

std::vector<double> zoom_focal_lengths(const LensSystem& lens) {
    std::vector<double> lengths;
    for (std::size_t i = 0; i < lens.zoom.positions.size(); ++i)
        lengths.push_back(
            first_order(at_zoom_position(lens, static_cast<int>(i)), lens.wavelength_nm).effective_focal_length);
    return lengths;
}

LensSystem zoomed_to_focal_length(const LensSystem& lens, double focal_length_mm) {
    const std::vector<double> known = zoom_focal_lengths(lens);
    const std::string name = "lens \"" + lens.name + '"';
    if (known.size() < 2)
        throw InputError(name + " has no focal lengths between zoom positions; it has fewer than two");
    const bool rises = std::is_sorted(known.begin(), known.end(), std::less_equal<>());
    const bool falls = std::is_sorted(known.begin(), known.end(), std::greater_equal<>());
    if (!(rises || falls) || !(std::min(known.front(), known.back()) > 0))
        throw InputError(name + " has no focal lengths between zoom positions, whose own neither rise nor fall");
    // Tolerance of 1e-5: focal lengths are printed with five digits.
    const double least = std::min(known.front(), known.back()), most = std::max(known.front(), known.back());
    if (!(focal_length_mm >= least * (1 - 1e-5) && focal_length_mm <= most * (1 + 1e-5))) {
        char text[64];
        std::snprintf(text, sizeof text, " has no focal length of %.6g mm; ", focal_length_mm);
        throw InputError(name + text + zooms_from(known));
    }
    const double wanted = std::clamp(focal_length_mm, least, most);
    const auto same = std::find(known.begin(), known.end(), wanted);
    if (same != known.end()) return zoomed(lens, static_cast<int>(same - known.begin()));
    const ZoomCurves curves(lens, known);
    const auto error = [&](double x) {
        return std::log(first_order(curves.at(x), lens.wavelength_nm).effective_focal_length / wanted);
    };
    const double begin = std::log(least), end = std::log(most);
    constexpr double kClose = 1e-12;
    const Root found = find_root(error, begin, std::log(least / wanted), end, std::log(most / wanted), kClose);
    LensSystem there = curves.at(found.at);
    there.film_distance = film_distance_at_infinity(there).value_or(0) + curves.focus_shift(std::log(wanted));
    if (!(std::fabs(found.value) < 1e-9) || !(there.film_distance > 0))
        throw InputError(name + " makes no picture between its zoom positions where its focal length should be " +
                         std::to_string(wanted) + " mm");
    check_surfaces(there);
    return with_rings_of(lens, std::move(there));
}

}  // namespace realcam
