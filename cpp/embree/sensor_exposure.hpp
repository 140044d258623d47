#pragma once
#include "../camera/sensor_request.hpp"
#include "../keep_going.hpp"

namespace realcam {

/// All rows of a request, on all cores or on `threads` of them (0: all). The same numbers for any number of threads.
/// Throws Cancelled.
void expose_sensor(const SensorRequest& request, int threads = 0, const KeepGoing& keep_going = {});

}  // namespace realcam
