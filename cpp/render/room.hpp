#pragma once
#include "surroundings.hpp"

namespace REALCAM_NAMESPACE {

/// Whether the subject is a room, which is looked at from inside. The side of its box towards the camera and at least
/// four of the five others must be walls: planes across the box's axes that cover half of the side or more. Either
/// these face inwards, or the scene's only light comes from within. `backward`: unit, from the scene to the camera,
/// along an axis.
bool is_room(const Assembly& assembly, const Surroundings& subject, Vec3d backward);

}  // namespace REALCAM_NAMESPACE
