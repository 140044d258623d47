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

/// Returns the lens `at_rest`, which is in a new zoom position, with the focus and diaphragm settings of `lens`.
LensSystem with_settings_of(const LensSystem& lens, LensSystem at_rest) {
    const ZoomRange& zoom = lens.zoom;
    const double focus_at_rest = zoom.positions[static_cast<std::size_t>(zoom.current)].focus_distance;
    if (lens.focus_distance != focus_at_rest) at_rest = focused(at_rest, lens.focus_distance);
    if (lens.is_wide_open()) return at_rest;
    return stopped_down(at_rest, std::max(f_number_at_infinity(lens), f_number_at_infinity(at_rest)));
}

/// Names the range of focal lengths in a message.
std::string range_text(const std::vector<double>& focal_lengths) {
    const auto [shortest, longest] = std::minmax_element(focal_lengths.begin(), focal_lengths.end());
    char text[80];
    std::snprintf(text, sizeof text, "it zooms from %.5g to %.5g mm", *shortest, *longest);
    return text;
}

/// The lens between its zoom positions, interpolated over the logarithm of the focal length.
class ZoomCurves {
public:
    /// `focal_lengths`: of each zoom position of the lens, mm.
    ZoomCurves(const LensSystem& lens, const std::vector<double>& focal_lengths) : lens_(lens) {
        for (std::size_t i = 0; i < focal_lengths.size(); ++i)
            nodes_.emplace_back(std::log(focal_lengths[i]), static_cast<int>(i));
        std::sort(nodes_.begin(), nodes_.end());
        for (std::size_t i = 0; i < lens.zoom.surfaces.size(); ++i)
            thicknesses_.push_back(curve([&](int position) { return at_position(position).thicknesses[i]; }));
        if (at_position(0).stop_semi_diameter > 0)
            stop_radius_ = curve([&](int position) { return at_position(position).stop_semi_diameter; });
        focus_shift_ = curve([&](int position) {
            const LensSystem at_rest = at_zoom_position(lens_, position);
            return at_rest.film_distance - film_distance_at_infinity(at_rest).value_or(0);
        });
    }

    /// Returns the lens at rest at the coordinate x of the curves, which is close to the logarithm of its focal length.
    /// Its film distance is that of the nearest position.
    LensSystem at(double x) const {
        LensSystem lens = at_zoom_position(lens_, nearest(x));
        for (std::size_t i = 0; i < thicknesses_.size(); ++i)
            lens.surfaces[static_cast<std::size_t>(lens.zoom.surfaces[i])].thickness = thicknesses_[i].at(x);
        if (stop_radius_) {
            Surface& stop = lens.surfaces[static_cast<std::size_t>(lens.stop_index())];
            lens.stop_semi_diameter = stop.clear_semi_diameter = stop_radius_->at(x);
        }
        return lens;
    }

    /// Distance of the film behind the plane in which light from infinity is sharpest, mm.
    double focus_shift(double log_focal_length) const { return focus_shift_->at(log_focal_length); }

private:
    const ZoomPosition& at_position(int position) const {
        return lens_.zoom.positions[static_cast<std::size_t>(position)];
    }

    /// Interpolates value(index of a position) over the logarithm of the focal length.
    template <class Value>
    MonotoneCurve curve(Value&& value) const {
        std::vector<double> x, y;
        for (const auto& [log_focal_length, position] : nodes_) {
            x.push_back(log_focal_length);
            y.push_back(value(position));
        }
        return MonotoneCurve(std::move(x), std::move(y));
    }

    /// Returns the index of the position with the nearest focal length.
    int nearest(double log_focal_length) const {
        const auto distance = [&](const auto& node) { return std::fabs(node.first - log_focal_length); };
        return std::min_element(nodes_.begin(), nodes_.end(),
                                [&](const auto& a, const auto& b) { return distance(a) < distance(b); })
            ->second;
    }

    const LensSystem& lens_;
    std::vector<std::pair<double, int>> nodes_;  ///< logarithm of the focal length, and index, of each position
    std::vector<MonotoneCurve> thicknesses_;
    std::optional<MonotoneCurve> stop_radius_;  ///< empty: zooming does not change the stop
    std::optional<MonotoneCurve> focus_shift_;
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
    return with_settings_of(lens, at_zoom_position(lens, position));
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
    const bool ascends = std::is_sorted(known.begin(), known.end(), std::less_equal<>());
    const bool descends = std::is_sorted(known.begin(), known.end(), std::greater_equal<>());
    if (!(ascends || descends) || !(std::min(known.front(), known.back()) > 0))
        throw InputError(
            name +
            " has no focal lengths between zoom positions, because those of the positions are not positive and in "
            "ascending or descending order");
    // Focal lengths are printed with five digits.
    constexpr double kTolerance = 1e-5;
    const double shortest = std::min(known.front(), known.back()), longest = std::max(known.front(), known.back());
    if (!(focal_length_mm >= shortest * (1 - kTolerance) && focal_length_mm <= longest * (1 + kTolerance))) {
        char text[64];
        std::snprintf(text, sizeof text, " has no focal length of %.6g mm; ", focal_length_mm);
        throw InputError(name + text + range_text(known));
    }
    const double target = std::clamp(focal_length_mm, shortest, longest);
    const auto exact = std::find(known.begin(), known.end(), target);
    if (exact != known.end()) return zoomed(lens, static_cast<int>(exact - known.begin()));
    const ZoomCurves curves(lens, known);
    const auto error = [&](double x) {
        return std::log(first_order(curves.at(x), lens.wavelength_nm).effective_focal_length / target);
    };
    // Errors of the logarithm of the focal length: aimed at, and accepted.
    constexpr double kConverged = 1e-12, kAcceptable = 1e-9;
    const Root found = find_root(error, std::log(shortest), std::log(shortest / target), std::log(longest),
                                 std::log(longest / target), kConverged);
    LensSystem zoomed_lens = curves.at(found.at);
    zoomed_lens.film_distance =
        film_distance_at_infinity(zoomed_lens).value_or(0) + curves.focus_shift(std::log(target));
    if (!(std::fabs(found.value) < kAcceptable) || !(zoomed_lens.film_distance > 0))
        throw InputError(name + " makes no real image at the focal length " + std::to_string(target) +
                         " mm between its zoom positions");
    check_surfaces(zoomed_lens);
    return with_settings_of(lens, std::move(zoomed_lens));
}

}  // namespace realcam
