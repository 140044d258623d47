#pragma once
// Numbers of a command line. CLI11's own conversion would not do: it reads numbers as long double and then rounds once
// more, so that an option could differ from the same number in a shot file, and it takes 010 for 8.

#include <optional>
#include <string>
#include <vector>

namespace realcam::io {

/// The whole text as a number, "inf" too; nothing where it is none, and for NaN.
std::optional<double> number_in(const std::string& text);

/// Finite numbers with a separator between them; nothing where the text is not so many.
std::optional<std::vector<double>> numbers_in(const std::string& text, char separator, std::size_t count);

}  // namespace realcam::io
