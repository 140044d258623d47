#include "known_wavelengths.hpp"

#include <cmath>

namespace realcam {

namespace known_wavelengths_detail {

std::string nm_text(double wavelength_nm) {
    std::string text = std::to_string(std::round(10 * wavelength_nm) / 10);
    text.erase(text.find_last_not_of('0') + 1);
    return text.back() == '.' ? text.substr(0, text.size() - 1) : text;
}

std::string glass_text(const LensSystem& lens, std::size_t surface) {
    const std::string& label = lens.surfaces[surface].material.label;
    return "the glass of surface " + std::to_string(surface + 1) + (label.empty() ? "" : " (" + label + ")") + " of " +
           lens.name;
}

namespace {

/// Formats a range for the message "... requested", with its verb.
std::string range_text(WavelengthRange range) {
    return range.first == range.last ? nm_text(range.first) + " nm is"
                                     : nm_text(range.first) + " to " + nm_text(range.last) + " nm are";
}

}  // namespace

}  // namespace known_wavelengths_detail

void check_glasses_known(const LensSystem& lens, WavelengthRange range, const std::string& purpose) {
    using namespace known_wavelengths_detail;
    for (std::size_t i = 0; i < lens.surfaces.size(); ++i) {
        if (lens.surfaces[i].type != SurfaceType::refracting) continue;
        const Glass& glass = lens.surfaces[i].material;
        const auto [first_known, last_known] = glass.known_nm();
        // Tolerance of 0.05 nm: a table that ends at 656.3 is meant for the line at 656.27.
        if (range.first < first_known - 0.05 || range.last > last_known + 0.05)
            throw InputError(purpose + ": " + glass_text(lens, i) + " is known from " + nm_text(first_known) + " to " +
                             nm_text(last_known) + " nm; " + range_text(range) + " requested");
    }
}

}  // namespace realcam
