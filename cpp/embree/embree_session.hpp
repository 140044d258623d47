#pragma once
#include <memory>

#include "../render/session.hpp"

namespace realcam {

/// The CPU: Embree for the scene, TBB over tiles, the lens in vector code. One frame is under way at a time, on a
/// thread of its own. Throws DeviceError where there is no Embree.
std::unique_ptr<Session> make_embree_session();

}  // namespace realcam
