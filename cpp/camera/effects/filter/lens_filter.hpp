#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "../dispersion/illuminant.hpp"

namespace REALCAM_NAMESPACE {

/// Absorbing filter in front of the lens: neutral, or a transmittance curve over the wavelength. The same transmittance
/// applies at every angle of incidence, and no light is reflected between filter and lens.
class LensFilter {
public:
    static constexpr const char* kWanted =
        "a neutral density, ND8 (1/8 of the light) or ND0.9 (optical density), a transmittance from 0 to 1, or a table "
        "of wavelengths and transmittances (400:0.05,550:0.1,600:0.9)";

    /// Throws InputError unless 0 < transmittance <= 1.
    static LensFilter neutral(double transmittance);
    /// Linear between its points, constant outside. Throws InputError for fewer than two points, wavelengths that are
    /// not strictly increasing, transmittances outside 0 to 1, and a filter that blocks all visible light.
    static LensFilter table(std::vector<SpectrumPoint> points);
    /// Parses the one-word form that users write. Throws InputError if it is invalid.
    static LensFilter parse(std::string_view text);

    bool is_neutral() const { return points_.empty(); }
    /// Points of the curve; empty for a neutral filter.
    const std::vector<SpectrumPoint>& points() const { return points_; }

    double transmittance(double wavelength_nm) const;
    /// Fraction of the luminous flux of D65 that passes: of the integral of its power times V(lambda), 380 to 780 nm.
    double luminous_transmittance() const { return luminous_; }
    /// The neutral filter that is equally bright.
    LensFilter neutral_equivalent() const { return neutral(luminous_); }

    /// Text from which parse makes this filter.
    std::string text() const;

    bool operator==(const LensFilter&) const = default;

private:
    std::vector<SpectrumPoint> points_;
    double luminous_ = 1;
};

}  // namespace REALCAM_NAMESPACE
