#pragma once
#include <string>

#include "platform.hpp"

namespace REALCAM_NAMESPACE {

/// A number as people write it: so many significant digits, and all of the whole part: "0.00001", "50.36", "12 346".
/// An exponent stands only for numbers below a millionth and from 1e15 on; "infinity".
std::string number_text(double value, int digits = 4);

/// Rounded to so many significant digits, for numbers that are estimates.
double rounded(double value, int digits);

/// A number and what is counted: "1 sample", "10 000 samples".
std::string counted(double count, const std::string& noun, int digits = 4);

}  // namespace REALCAM_NAMESPACE
