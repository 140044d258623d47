#pragma once
#include "doctest/doctest.h"

namespace realcam::test {

/// Equal within a share of the value. doctest's own Approx adds 1 to the value: small numbers always pass.
inline doctest::Approx about(double value, double relative) {
    return doctest::Approx(value).epsilon(relative).scale(0);
}

}  // namespace realcam::test
