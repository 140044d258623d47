#include "illuminant.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "../../../number_text.hpp"

namespace realcam {

void check_spectrum(const std::vector<SpectrumPoint>& points, const std::string& subject) {
    const auto fail = [&](const char* why) { throw InputError(subject + ": " + why); };
    if (points.size() < 2) fail("a table needs at least two points, wavelengths in nm with their values");
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (!(points[i].wavelength_nm > 0) || !(points[i].wavelength_nm < 1e6) || !(points[i].power >= 0) ||
            !(points[i].power < 1e30))
            fail("a table must have wavelengths in nm and values of at least 0");
        if (i > 0 && !(points[i].wavelength_nm > points[i - 1].wavelength_nm))
            fail("the wavelengths of a table must be strictly increasing");
    }
}

std::vector<SpectrumPoint> spectrum_points(std::string_view text, const std::string& subject) {
    std::vector<SpectrumPoint> points;
    for (std::size_t start = 0; start <= text.size();) {
        const std::size_t end = std::min(text.find(',', start), text.size());
        const std::string_view pair = text.substr(start, end - start);
        const std::size_t colon = std::min(pair.find(':'), pair.size());
        const double wavelength = number_in(pair.substr(0, colon)),
                     value = number_in(pair.substr(std::min(colon + 1, pair.size())));
        if (std::isnan(wavelength) || std::isnan(value))
            throw InputError(subject + ": \"" + std::string(pair.substr(0, 60)) +
                             "\" is not a wavelength and a value; a table is written as 400:0.5,550:1,700:0.2");
        points.push_back({wavelength, value});
        start = end + 1;
    }
    return points;
}

double spectrum_at(const std::vector<SpectrumPoint>& points, double wavelength_nm) {
    const auto next =
        std::lower_bound(points.begin() + 1, points.end() - 1, wavelength_nm,
                         [](const SpectrumPoint& point, double value) { return point.wavelength_nm < value; });
    const SpectrumPoint &a = *(next - 1), &b = *next;
    return a.power + (wavelength_nm - a.wavelength_nm) / (b.wavelength_nm - a.wavelength_nm) * (b.power - a.power);
}

std::string spectrum_text(const std::vector<SpectrumPoint>& points) {
    std::string text;
    for (const SpectrumPoint& point : points)
        text += (text.empty() ? "" : ",") + shortest_text(point.wavelength_nm) + ":" + shortest_text(point.power);
    return text;
}

Illuminant Illuminant::named(std::string_view name) {
    for (const Named& known : kNamed)
        if (name == known.name) {
            Illuminant illuminant;
            illuminant.name_ = known.name;
            return illuminant;
        }
    fail("\"" + std::string(name.substr(0, 60)) + "\" is unknown; expected " + kWanted);
}

Illuminant Illuminant::line(double wavelength_nm) {
    if (!(wavelength_nm >= kFirstWavelength_nm && wavelength_nm <= kLastWavelength_nm))
        fail("a wavelength must lie between 380 and 780 nm");
    Illuminant illuminant;
    illuminant.name_.clear();
    illuminant.points_ = {{wavelength_nm, 1}};
    return illuminant;
}

Illuminant Illuminant::table(std::vector<SpectrumPoint> points) {
    check_spectrum(points, "illuminant");
    Illuminant illuminant;
    illuminant.name_.clear();
    illuminant.points_ = std::move(points);
    return illuminant;
}

Illuminant Illuminant::parse(std::string_view text) {
    if (text.find(':') != std::string_view::npos) return table(spectrum_points(text, "illuminant"));
    const double number = number_in(text);
    return std::isnan(number) ? named(text) : line(number);
}

double Illuminant::power(double wavelength_nm) const {
    for (const Named& known : kNamed)
        if (name_ == known.name) return at(known.spectrum, wavelength_nm);
    if (is_line() || wavelength_nm < points_.front().wavelength_nm || wavelength_nm > points_.back().wavelength_nm)
        return 0;
    return spectrum_at(points_, wavelength_nm);
}

std::string Illuminant::text() const {
    if (!name_.empty()) return name_;
    return is_line() ? shortest_text(points_[0].wavelength_nm) : spectrum_text(points_);
}

double Illuminant::at(const VisibleSpectrum& spectrum, double wavelength_nm) {
    const double position = (wavelength_nm - kFirstWavelength_nm) / kSpectrumStep_nm;
    const auto i = static_cast<std::size_t>(std::clamp(position, 0.0, static_cast<double>(spectrum.size() - 2)));
    const double share = position - static_cast<double>(i);
    return (1 - share) * spectrum[i] + share * spectrum[i + 1];
}

}  // namespace realcam
