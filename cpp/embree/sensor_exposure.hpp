#pragma once
#include "../camera/sensor/sensor_request.hpp"
#include "../checkpoint.hpp"

namespace realcam {

/// Computes all rows of a request, on all cores or on `threads` of them (0: all). The results do not depend on the
/// number of threads. Throws Cancelled.
void expose_sensor(const SensorRequest& request, int threads = 0, const KeepGoing& keep_going = {});

}  // namespace realcam
