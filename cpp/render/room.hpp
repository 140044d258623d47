#pragma once
#include "surroundings.hpp"

namespace REALCAM_NAMESPACE {

/// Whether what a picture is of is a room, which one looks at from inside: the side of its box towards the camera and
/// at least four of the five others are walls (planes across the box's axes that cover half of the side or more), and
/// either these face inwards, or the scene's only light comes from within.
/// `backward`: unit, from the scene to the camera, along an axis.
bool is_room(const Assembly& assembly, const Surroundings& subject, Vec3d backward);

}  // namespace REALCAM_NAMESPACE
