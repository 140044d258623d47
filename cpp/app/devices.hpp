#pragma once

namespace realcam::app {

/// Prints the devices of this machine, the CPU first, and on stderr the reason if no GPU can be used.
void list_devices(bool as_json);

}  // namespace realcam::app
