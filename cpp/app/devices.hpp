#pragma once

namespace realcam::app {

/// Prints the devices of this machine, the CPU first.
void list_devices(bool as_json);

}  // namespace realcam::app
