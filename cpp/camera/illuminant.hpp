#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "../error.hpp"
#include "spectra.hpp"

namespace REALCAM_NAMESPACE {

struct SpectrumPoint {
    double wavelength_nm, power;

    bool operator==(const SpectrumPoint&) const = default;
};

/// The spectrum of all light in a picture: of a name (D65, D50, A, FL2), one line, or a table. A value.
class Illuminant {
public:
    static constexpr const char* kWanted =
        "D65, D50, A, FL2, a wavelength in nm, or a table of wavelengths and powers (400:0.5,550:1,700:0.2)";

    Illuminant() = default;

    /// Throws InputError for another name.
    static Illuminant named(std::string_view name);
    /// Throws InputError outside the visible wavelengths.
    static Illuminant line(double wavelength_nm);
    /// Linear between its points, and 0 before the first and after the last. Throws InputError for one that has no
    /// light where it is visible.
    static Illuminant table(std::vector<SpectrumPoint> points);
    /// As users write it in one word. Throws InputError.
    static Illuminant parse(std::string_view text);

    bool is_line() const { return points_.size() == 1; }
    const std::vector<SpectrumPoint>& points() const { return points_; }

    /// Relative power at a wavelength from 380 to 780 nm. A line has none.
    double power(double wavelength_nm) const;

    /// What parse reads.
    std::string text() const;

    bool operator==(const Illuminant&) const = default;

    /// Value of a table of this library, at a wavelength from 380 to 780 nm.
    static double at(const VisibleSpectrum& spectrum, double wavelength_nm);

private:
    struct Named {
        const char* name;
        const VisibleSpectrum& spectrum;
    };
    static constexpr Named kNamed[] = {
        {"D65", kIlluminantD65}, {"D50", kIlluminantD50}, {"A", kIlluminantA}, {"FL2", kIlluminantFL2}};

    [[noreturn]] static void fail(const std::string& why) { throw InputError("illuminant: " + why); }

    /// NaN where the text is none.
    static double number_in(std::string_view text);
    static std::string short_text(double value);

    std::string name_ = "D65";
    std::vector<SpectrumPoint> points_;  ///< of a line, one
};

}  // namespace REALCAM_NAMESPACE
