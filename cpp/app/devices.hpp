#pragma once
#include <memory>
#include <string>

#include "../render/backend.hpp"

namespace realcam::app {

/// "auto" or "cpu". Throws InputError for another word, and DeviceError where the device does not work.
std::unique_ptr<Backend> make_backend(const std::string& device);

/// Prints the devices of this machine; the first is what "auto" takes.
void list_devices(bool as_json);

}  // namespace realcam::app
