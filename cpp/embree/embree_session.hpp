#pragma once
#include <memory>

#include "../render/session/session.hpp"

namespace realcam {

/// Makes a session on the CPU: Embree for the scene, TBB over tiles, vector code for the lens. One live frame is
/// rendered at a time, on its own thread. Throws DeviceError if Embree cannot be started.
std::unique_ptr<Session> make_embree_session();

}  // namespace realcam
