#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "../../../error.hpp"
#include "spectra.hpp"

namespace REALCAM_NAMESPACE {

/// Point of a tabulated spectrum.
struct SpectrumPoint {
    double wavelength_nm, power;  ///< power per nm, in any unit

    bool operator==(const SpectrumPoint&) const = default;
};

// A table of a spectrum in the one-word form that users write is "400:0.5,550:1,700:0.2": wavelengths in nm with powers
// or transmittances. `subject` begins the messages of errors: "illuminant".

/// Throws InputError for fewer than two points, wavelengths that are not strictly increasing, and values out of range.
void check_spectrum(const std::vector<SpectrumPoint>& points, const std::string& subject);

/// Parses a table. Throws InputError if a pair is not two numbers.
std::vector<SpectrumPoint> spectrum_points(std::string_view text, const std::string& subject);

/// Linear interpolation between the points, at a wavelength that they enclose.
double spectrum_at(const std::vector<SpectrumPoint>& points, double wavelength_nm);

/// Text from which spectrum_points makes these points.
std::string spectrum_text(const std::vector<SpectrumPoint>& points);

/// Spectrum of all light in a picture: a standard illuminant (D65, D50, A, FL2), a single line, or a table.
class Illuminant {
public:
    /// Values that users may give, for messages.
    static constexpr const char* kWanted =
        "D65, D50, A, FL2, a wavelength in nm, or a table of wavelengths and powers (400:0.5,550:1,700:0.2)";

    Illuminant() = default;

    /// Standard illuminant. Throws InputError if the name is unknown.
    static Illuminant named(std::string_view name);
    /// Line of a single wavelength. Throws InputError if the wavelength is not from 380 to 780 nm.
    static Illuminant line(double wavelength_nm);
    /// Tabulated spectrum: linear between its points, 0 outside. Throws what check_spectrum throws.
    static Illuminant table(std::vector<SpectrumPoint> points);
    /// Parses one of the forms of kWanted. Throws InputError if it is invalid.
    static Illuminant parse(std::string_view text);

    bool is_line() const { return points_.size() == 1; }
    /// Points of a table; one point for a line; empty for a standard illuminant.
    const std::vector<SpectrumPoint>& points() const { return points_; }

    /// Relative power at a wavelength from 380 to 780 nm; 0 for a line, which has no density.
    double power(double wavelength_nm) const;

    /// Text from which parse makes this illuminant.
    std::string text() const;

    bool operator==(const Illuminant&) const = default;

    /// Value of a spectrum of spectra.hpp, at a wavelength from 380 to 780 nm.
    static double at(const VisibleSpectrum& spectrum, double wavelength_nm);

private:
    struct Named {
        const char* name;
        const VisibleSpectrum& spectrum;
    };
    static constexpr Named kNamed[] = {
        {"D65", kIlluminantD65}, {"D50", kIlluminantD50}, {"A", kIlluminantA}, {"FL2", kIlluminantFL2}};

    [[noreturn]] static void fail(const std::string& why) { throw InputError("illuminant: " + why); }

    std::string name_ = "D65";
    std::vector<SpectrumPoint> points_;  ///< one point for a line
};

}  // namespace REALCAM_NAMESPACE
