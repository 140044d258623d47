#pragma once
#include <optional>
#include <string>

#include "../../camera/film/camera.hpp"
#include "../../camera/models/pinhole_camera.hpp"
#include "../../scene/assembly.hpp"
#include "../../scene/scene.hpp"

namespace REALCAM_NAMESPACE {

/// Adds daylight to a scene without light: a slightly warm sun of 80 klux at the upper left behind the camera, 46
/// degrees above its horizon, and a slightly blue sky of 5000 cd/m^2 all around. Together about 95 klux, for which the
/// sunny-16 rule holds.
void add_daylight(Scene& scene, const Pose& pose);

/// Returns the distance from the entrance pupil, which set_view places at the origin of a scene's camera, to the film
/// along the axis, m. An entrance pupil at infinity is replaced by the front vertex.
double pupil_to_film_m(const LensSystem& lens);

/// The user's specification of the camera's position and focus, in the scene frame. Missing values are chosen
/// (set_view).
struct ViewRequest {
    std::optional<Vec3d> position_m, look_at_m;
    Vec3d up = {0, 1, 0};
    std::optional<double> focus_distance_m;  ///< object plane to film; may be infinite
    /// Name of a camera of the scene (SceneCamera). Empty: the first usable one, unless position_m or look_at_m is
    /// given. kNoCamera: ignores the cameras of the scene.
    std::string camera;

    static constexpr const char* kNoCamera = "none";
};

/// Sets camera.pose and camera.motion and focuses camera.lens, for the scene at the time when the shutter opens. Values
/// in the request have precedence. Without them, if the scene has a camera, its position, direction and motion are
/// used. In a scene without camera, the view is chosen by these rules, which docs/scenes.md states for users:
/// - subject: the scene without its surroundings (Subject).
/// - front: +z (-y if up is z), or the first of the right, the left and the back side if the front is a wall that is
///   seen from inside.
/// - an object is seen from its front, slightly above and aside (by half the angles of the diagonals of its box, so
///   that a flat picture is seen from in front), from a distance at which the boxes of its parts fill nine tenths of
///   the film, or nearer if a surface would be in between;
/// - an open room is seen horizontally through its open side, which fills the film;
/// - a closed room is seen from the corner, near half of its height, with the longest view towards its content.
/// - focus: the first surface on the camera's axis, or the depth of the subject's centre if the axis hits nothing. A
///   camera whose position was chosen steps back if its lens cannot focus that near.
/// Returns the scene's camera whose view is used, or null. Throws InputError if the lens cannot focus as requested, if
/// the scene has no triangles, or if it does not have the requested camera.
const SceneCamera* set_view(Camera& camera, const Assembly& assembly, const ViewRequest& request);

}  // namespace REALCAM_NAMESPACE
