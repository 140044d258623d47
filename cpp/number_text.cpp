#include "number_text.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace realcam {
namespace {

/// Formats a number as printf does with a precision of `digits`, but with a point in every locale.
std::string printed(std::chars_format notation, int digits, double value) {
    char text[64];
    const auto [end, error] = std::to_chars(text, text + sizeof text, value, notation, digits);
    return std::string(text, end);
}

}  // namespace

std::string number_text(double value, int digits) {
    if (std::isinf(value)) return value > 0 ? "infinity" : "-infinity";
    const double magnitude = std::fabs(value);
    if (std::isnan(value) || (0 < magnitude && magnitude < 1e-6) || magnitude >= 1e15)
        return printed(std::chars_format::general, digits, value);
    // The exponent is that of the rounded number: 999.96 has three digits before the point, but is shown as 1000.
    const double shown = rounded(magnitude, digits);
    const int exponent = shown > 0 ? static_cast<int>(std::floor(std::log10(shown))) : 0;
    std::string text = printed(std::chars_format::fixed, std::max(0, digits - 1 - exponent), magnitude);
    if (text.find('.') != std::string::npos) {
        text.erase(text.find_last_not_of('0') + 1);
        if (text.back() == '.') text.pop_back();
    }
    if (exponent >= 4)  // spaces between groups of three digits
        for (std::ptrdiff_t at = static_cast<std::ptrdiff_t>(std::min(text.find('.'), text.size())) - 3; at > 0;
             at -= 3)
            text.insert(static_cast<std::size_t>(at), 1, ' ');
    return (value < 0 ? "-" : "") + text;
}

double rounded(double value, int digits) {
    if (!std::isfinite(value)) return value;
    return number_in(printed(std::chars_format::scientific, digits - 1, value));
}

std::string counted(double count, const std::string& noun, int digits) {
    return number_text(count, digits) + ' ' + noun + (count == 1 ? "" : "s");
}

double number_in(std::string_view text) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size() && !text.empty() && std::isfinite(value)
               ? value
               : std::nan("");
}

std::string shortest_text(double value) {
    char text[32];
    const auto [end, error] = std::to_chars(text, text + sizeof text, value);
    return error == std::errc() ? std::string(text, end) : std::string();
}

}  // namespace realcam
