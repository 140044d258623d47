#pragma once
#include <string>

#include "../optics/prescription/lens_system.hpp"

namespace realcam::app {

/// Surface table and first-order data of a lens at its design wavelength, as text.
std::string lens_as_text(const LensSystem& lens);
/// The same data as a JSON object; null stands for a value that is infinite or does not exist.
std::string lens_as_json(const LensSystem& lens);

}  // namespace realcam::app
