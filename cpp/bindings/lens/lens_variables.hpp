#pragma once
#include <string>
#include <tuple>
#include <vector>

#include "../../optics/derivatives/lens_variable.hpp"

namespace realcam::bindings {

/// Variables of a lens as tuples (quantity, surface, number, number_y); see LensVariable.
using Variables = std::vector<std::tuple<std::string, int, int, int>>;

/// Converts variables. Throws InputError for an unknown quantity.
std::vector<LensVariable> variables_from(const Variables& variables);

}  // namespace realcam::bindings
