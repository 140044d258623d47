#pragma once

namespace realcam::app {

/// Prints the devices of this machine, the CPU first, and on stderr why there is no GPU.
void list_devices(bool as_json);

}  // namespace realcam::app
