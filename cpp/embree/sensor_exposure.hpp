#pragma once
#include "../camera/sensor/sensor_request.hpp"
#include "../checkpoint.hpp"

namespace realcam {

/// Exposes a sensor on the CPU: computes the raw values of all rows of a request. `threads`: number of threads; 0: one
/// for each core. The results do not depend on it. Throws Cancelled.
void expose_sensor(const SensorRequest& request, int threads = 0, const KeepGoing& keep_going = {});

}  // namespace realcam
