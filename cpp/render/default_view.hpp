#pragma once
#include <optional>
#include <string>

#include "../camera/camera.hpp"
#include "../camera/field_of_view.hpp"
#include "../scene/assembly.hpp"

namespace REALCAM_NAMESPACE {

/// What the user says of the camera's position; the rest is chosen.
struct ViewRequest {
    std::optional<Vec3d> position_m, look_at_m;
    Vec3d up = {0, 1, 0};
    std::optional<double> focus_distance_m;  ///< object plane to film; infinity allowed
    /// The name of a camera of the scene (SceneCamera). Empty: the first that exists, if position_m and look_at_m are
    /// not given. kNoCamera: none.
    std::string camera;

    static constexpr const char* kNoCamera = "none";
};

/// Sets camera.pose and focuses camera.lens, for the scene when the shutter opens. What the request gives is taken.
/// Else, where the scene has a camera, its place, direction and motion are taken. Else the view is chosen by these
/// rules, which docs/scenes.md states for users:
/// - subject: the scene without its surroundings (Subject).
/// - front: +z (-y where up is z), or the first of the right, the left and the back side where the front is a wall that
///   is seen from inside.
/// - an object is seen from its front and slightly above (half of the elevation of its diagonal), so far away that its
///   box fills nine tenths of the film, or nearer where a surface would be in between;
/// - an open room is seen level through its open side, which fills the film;
/// - a closed room is seen from that corner, near half of its height, from which the view to its content is longest.
/// - focus: the first surface on the camera's axis, or the depth of the subject's middle where the axis meets nothing.
///   A camera whose position was chosen steps back where its lens cannot focus that near.
/// Returns the scene's camera whose view was taken; null: none. Throws InputError where the lens cannot focus as asked
/// for, for a scene without triangles, and for a camera that the scene has not.
const SceneCamera* set_view(Camera& camera, const Assembly& assembly, const ViewRequest& request);

}  // namespace REALCAM_NAMESPACE
