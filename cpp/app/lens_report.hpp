#pragma once
#include <string>

#include "../optics/prescription/lens_system.hpp"

namespace realcam::app {

/// Surface table and first-order data as text.
std::string lens_as_text(const LensSystem& lens);
/// The same data as JSON; null if a value is infinite or does not exist.
std::string lens_as_json(const LensSystem& lens);

}  // namespace realcam::app
