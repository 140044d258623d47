#pragma once
#include <string>

#include "../plan/plan.hpp"

namespace realcam::app {

/// Plan as JSON; null if a number is infinite or does not exist.
std::string json_of(const Plan& plan);

}  // namespace realcam::app
