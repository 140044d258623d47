#include "illuminant.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <utility>

namespace realcam {

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
        fail("a line must lie between 380 and 780 nm");
    Illuminant illuminant;
    illuminant.name_.clear();
    illuminant.points_ = {{wavelength_nm, 1}};
    return illuminant;
}

Illuminant Illuminant::table(std::vector<SpectrumPoint> points) {
    if (points.size() < 2) fail("a table needs at least two points, wavelengths in nm with their powers");
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (!(points[i].wavelength_nm > 0) || !(points[i].wavelength_nm < 1e6) || !(points[i].power >= 0) ||
            !(points[i].power < 1e30))
            fail("a table must have wavelengths in nm and powers of at least 0");
        if (i > 0 && !(points[i].wavelength_nm > points[i - 1].wavelength_nm))
            fail("the wavelengths of a table must rise");
    }
    Illuminant illuminant;
    illuminant.name_.clear();
    illuminant.points_ = std::move(points);
    return illuminant;
}

Illuminant Illuminant::parse(std::string_view text) {
    if (text.find(':') == std::string_view::npos) {
        const double number = number_in(text);
        return std::isnan(number) ? named(text) : line(number);
    }
    std::vector<SpectrumPoint> points;
    for (std::size_t start = 0; start <= text.size();) {
        const std::size_t end = std::min(text.find(',', start), text.size());
        const std::string_view pair = text.substr(start, end - start);
        const std::size_t colon = std::min(pair.find(':'), pair.size());
        const double wavelength = number_in(pair.substr(0, colon)),
                     power = number_in(pair.substr(std::min(colon + 1, pair.size())));
        if (std::isnan(wavelength) || std::isnan(power))
            fail("\"" + std::string(pair.substr(0, 60)) +
                 "\" is no wavelength and power; a table is written as 400:0.5,550:1,700:0.2");
        points.push_back({wavelength, power});
        start = end + 1;
    }
    return table(std::move(points));
}

double Illuminant::power(double wavelength_nm) const {
    for (const Named& known : kNamed)
        if (name_ == known.name) return at(known.spectrum, wavelength_nm);
    if (is_line() || wavelength_nm < points_.front().wavelength_nm || wavelength_nm > points_.back().wavelength_nm)
        return 0;
    const auto next =
        std::lower_bound(points_.begin() + 1, points_.end() - 1, wavelength_nm,
                         [](const SpectrumPoint& point, double value) { return point.wavelength_nm < value; });
    const SpectrumPoint &a = *(next - 1), &b = *next;
    return a.power + (wavelength_nm - a.wavelength_nm) / (b.wavelength_nm - a.wavelength_nm) * (b.power - a.power);
}

std::string Illuminant::text() const {
    if (!name_.empty()) return name_;
    if (is_line()) return short_text(points_[0].wavelength_nm);
    std::string text;
    for (const SpectrumPoint& point : points_)
        text += (text.empty() ? "" : ",") + short_text(point.wavelength_nm) + ":" + short_text(point.power);
    return text;
}

double Illuminant::at(const VisibleSpectrum& spectrum, double wavelength_nm) {
    const double position = (wavelength_nm - kFirstWavelength_nm) / kSpectrumStep_nm;
    const auto i = static_cast<std::size_t>(std::clamp(position, 0.0, static_cast<double>(spectrum.size() - 2)));
    const double share = position - static_cast<double>(i);
    return (1 - share) * spectrum[i] + share * spectrum[i + 1];
}

double Illuminant::number_in(std::string_view text) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size() && !text.empty() && std::isfinite(value)
               ? value
               : std::nan("");
}

std::string Illuminant::short_text(double value) {
    char text[32];
    const auto [end, error] = std::to_chars(text, text + sizeof text, value);
    return error == std::errc() ? std::string(text, end) : std::string();
}

}  // namespace realcam
