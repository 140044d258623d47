#pragma once
#include <memory>

#include "../render/backend.hpp"

namespace realcam {

/// The CPU: Embree for the scene, TBB over tiles, the lens in vector code. Throws DeviceError where there is no Embree.
std::unique_ptr<Backend> make_embree_backend();

/// A lens tracer for Pupil that uses the machine's vector instructions, and its cores (those of the calling thread's
/// TBB arena).
PupilTracer fast_pupil_tracer();

}  // namespace realcam
