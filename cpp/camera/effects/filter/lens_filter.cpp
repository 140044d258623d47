#include "lens_filter.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "../../../error.hpp"
#include "../../../number_text.hpp"

namespace realcam {

namespace {

[[noreturn]] void fail(const std::string& why) {
    throw InputError("lens_filter: " + why);
}

/// Transmittance of "ND8" (filter factor) or "ND0.9" (optical density), which are told apart by the decimal point;
/// NaN if the text is neither.
double neutral_density(std::string_view text) {
    const std::string_view number = text.substr(2);
    const double value = number_in(number);
    if (number.find('.') == std::string_view::npos) return value >= 1 ? 1 / value : std::nan("");
    return value >= 0 ? std::pow(10, -value) : std::nan("");
}

}  // namespace

LensFilter LensFilter::neutral(double transmittance) {
    if (!(transmittance > 0 && transmittance <= 1)) fail("the transmittance must lie above 0 and be at most 1");
    LensFilter filter;
    filter.luminous_ = transmittance;
    return filter;
}

LensFilter LensFilter::table(std::vector<SpectrumPoint> points) {
    check_spectrum(points, "lens_filter");
    for (const SpectrumPoint& point : points)
        if (point.power > 1) fail("a transmittance must lie between 0 and 1");
    LensFilter filter;
    filter.points_ = std::move(points);
    const Illuminant daylight;
    double passed = 0, all = 0;
    for (double nm = kFirstWavelength_nm; nm <= kLastWavelength_nm; nm += 1) {
        const double light = daylight.power(nm) * Illuminant::at(kObserverY, nm);
        passed += light * filter.transmittance(nm);
        all += light;
    }
    filter.luminous_ = passed / all;
    if (!(filter.luminous_ > 0)) fail("no visible light passes");
    return filter;
}

LensFilter LensFilter::parse(std::string_view text) {
    if (text.find(':') != std::string_view::npos) return table(spectrum_points(text, "lens_filter"));
    const bool is_density = text.starts_with("ND") || text.starts_with("nd");
    const double transmittance = is_density ? neutral_density(text) : number_in(text);
    if (std::isnan(transmittance)) fail("\"" + std::string(text.substr(0, 60)) + "\": expected " + kWanted);
    return neutral(transmittance);
}

double LensFilter::transmittance(double wavelength_nm) const {
    if (is_neutral()) return luminous_;
    return spectrum_at(points_, std::clamp(wavelength_nm, points_.front().wavelength_nm, points_.back().wavelength_nm));
}

std::string LensFilter::text() const {
    return is_neutral() ? shortest_text(luminous_) : spectrum_text(points_);
}

}  // namespace realcam
