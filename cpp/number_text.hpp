#pragma once
#include <string>
#include <string_view>

#include "platform.hpp"

namespace REALCAM_NAMESPACE {

/// Formats a number for display with `digits` significant digits, but always its whole integer part, in groups of three
/// digits from five digits on. Examples: "0.00001", "50.36", "12 346", "infinity". Only numbers below a millionth and
/// from 1e15 on have an exponent.
std::string number_text(double value, int digits = 4);

/// Rounds a number to `digits` significant digits.
double rounded(double value, int digits);

/// Formats a count with its noun in the singular or plural, which ends in s: "1 sample", "10 000 samples". `digits`:
/// see number_text.
std::string counted(double count, const std::string& noun, int digits = 4);

/// Parses a finite number; NaN if the text is not one.
double number_in(std::string_view text);

/// Returns the shortest decimal text that parses to the same number.
std::string shortest_text(double value);

}  // namespace REALCAM_NAMESPACE
