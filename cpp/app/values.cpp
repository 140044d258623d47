#include "values.hpp"

#include <cmath>

#include "../error.hpp"
#include "../io/text/text_number.hpp"

namespace realcam::app {

double parse_number(const std::string& option, const std::string& text) {
    const auto value = io::number_in(text);
    if (!value || std::isinf(*value)) throw InputError(option + ": \"" + text + "\" is not a number");
    return *value;
}

double parse_distance(const std::string& option, const std::string& text) {
    const auto value = io::number_in(text);
    if (!value) throw InputError(option + ": \"" + text + "\" is not a number of metres or inf");
    return *value;
}

std::string distance_text(double metres) {
    return number_text(metres) + (std::isfinite(metres) ? " m" : "");
}

std::string exposure_text(double seconds) {
    const double inverse = 1 / seconds;
    constexpr double kMinDenominator = 2.5;  // longer times are not written as fractions
    if (inverse < kMinDenominator) return number_text(seconds) + " s";
    constexpr double kMaxInFull = 1e6;  // larger denominators get two significant digits: no shutter is faster
    const bool in_full = inverse >= 10 && inverse <= kMaxInFull;
    return "1/" + (in_full ? std::to_string(std::llround(inverse)) : number_text(inverse, 2)) + " s";
}

}  // namespace realcam::app
