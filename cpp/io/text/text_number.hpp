#pragma once
#include <charconv>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace realcam::io {

// Parsers of numbers. number_in and numbers_in are for the command line: CLI11's own conversion reads numbers as long
// double and then rounds again, so that an option could differ from the same number in a shot file, and it reads 010
// as 8.

/// Parses a text that is one number, or "inf"; std::nullopt for other texts and for NaN.
std::optional<double> number_in(const std::string& text);

/// Parses exactly `count` finite numbers with a separator between them, such as 36x24; std::nullopt for other texts.
std::optional<std::vector<double>> numbers_in(const std::string& text, char separator, std::size_t count);

/// Parses a number at the beginning of a text, and removes it from the text. Accepts also "nan", "inf", ".5" and a
/// leading
/// "+". Returns std::nullopt, and leaves the text unchanged, if there is no number. Numbers too large for a double
/// become infinite, and those too small become 0.
inline std::optional<double> consume_number(std::string_view& text) {
    std::string_view rest = text;
    if (rest.starts_with('+') && !rest.substr(1).starts_with('-')) rest.remove_prefix(1);
    double value = 0;
    auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
    if (error == std::errc::invalid_argument) return std::nullopt;
    const auto length = static_cast<std::size_t>(end - rest.data());
    if (error == std::errc::result_out_of_range) {
        // A long double has a larger range. Beyond it, the sign of the exponent tells overflow from underflow.
        long double wide = 0;
        const bool known = std::from_chars(rest.data(), rest.data() + rest.size(), wide).ec == std::errc();
        const std::string_view token = rest.substr(0, length);
        const bool tiny =
            known ? wide < 1 && wide > -1
                  : token.find("e-") != std::string_view::npos || token.find("E-") != std::string_view::npos;
        const double infinite =
            token.starts_with('-') ? -std::numeric_limits<double>::infinity() : std::numeric_limits<double>::infinity();
        value = tiny ? 0 : infinite;
    }
    text = rest.substr(length);
    return value;
}

/// Parses a whole number at the beginning of a text, as consume_number does. Numbers beyond 64 bits become the largest
/// or the least std::int64_t.
inline std::optional<std::int64_t> consume_integer(std::string_view& text) {
    std::string_view rest = text;
    if (rest.starts_with('+') && !rest.substr(1).starts_with('-')) rest.remove_prefix(1);
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
    if (error == std::errc::invalid_argument) return std::nullopt;
    using Limits = std::numeric_limits<std::int64_t>;
    if (error == std::errc::result_out_of_range) value = rest.starts_with('-') ? Limits::min() : Limits::max();
    text = rest.substr(static_cast<std::size_t>(end - rest.data()));
    return value;
}

}  // namespace realcam::io
