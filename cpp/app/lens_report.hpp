#pragma once
#include <string>

#include "../optics/prescription/lens_system.hpp"

namespace realcam::app {

/// The table of surfaces and the first-order data, for people.
std::string lens_as_text(const LensSystem& lens);
/// The same, for programs; null where a value is infinite or does not exist.
std::string lens_as_json(const LensSystem& lens);

}  // namespace realcam::app
