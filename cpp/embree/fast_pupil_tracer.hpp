#pragma once
#include "../optics/pupil/pupil_tracer.hpp"

namespace realcam {

/// Returns a lens tracer for Pupil that uses the machine's vector instructions and its cores (those of the calling
/// thread's TBB arena).
PupilTracer fast_pupil_tracer();

}  // namespace realcam
