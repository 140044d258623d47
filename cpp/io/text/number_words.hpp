#pragma once
// Parses numbers of a command line. CLI11's own conversion is not suitable: it reads numbers as long double and then
// rounds again, so that an option could differ from the same number in a shot file, and it takes 010 for 8.

#include <optional>
#include <string>
#include <vector>

namespace realcam::io {

/// Parses a text that is one number, or "inf"; std::nullopt for other texts and for NaN.
std::optional<double> number_in(const std::string& text);

/// Parses `count` finite numbers with a separator between them; std::nullopt for other texts.
std::optional<std::vector<double>> numbers_in(const std::string& text, char separator, std::size_t count);

}  // namespace realcam::io
