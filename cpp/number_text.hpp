#pragma once
#include <string>

#include "platform.hpp"

namespace REALCAM_NAMESPACE {

/// Formats a number for display, with `digits` significant digits and the whole integer part: "0.00001", "50.36", "12
/// 346", "infinity". Only numbers below a millionth and from 1e15 on have an exponent.
std::string number_text(double value, int digits = 4);

/// Rounds an estimate to `digits` significant digits.
double rounded(double value, int digits);

/// Writes a count with its noun: "1 sample", "10 000 samples".
std::string counted(double count, const std::string& noun, int digits = 4);

}  // namespace REALCAM_NAMESPACE
