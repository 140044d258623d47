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
    /// Of the scene (SceneCamera), by its name. Empty: where position_m and look_at_m say nothing the first that there
    /// is; kNoCamera: none.
    std::string camera;

    static constexpr const char* kNoCamera = "none";
};

/// Sets camera.pose, where the camera stays, and focuses camera.lens, on the scene as it stands when the shutter opens:
/// as asked for; where the scene brings a camera along, in its place, with its direction and motion; and otherwise so.
/// - subject: the scene without its surroundings (Surroundings): not the wide floor, the sky or what is far away.
/// - look_at: the middle of the subject's bounding box.
/// - position: in front of look_at along +z (along -y where up is the z axis), so far away that the subject's box fills
///   nine tenths of the film; nearer where a surface would be in between; and in a room (is_room) inside, at its front
///   wall.
/// - focus: the first surface on the camera's axis, or the depth of the subject's middle where the axis meets nothing.
/// A
///   camera whose place was chosen steps back where its lens cannot focus that near.
/// Returns the scene's camera whose view was taken; null: none. Throws InputError where the lens cannot focus as asked
/// for, for a scene without triangles, and for a camera that the scene has not.
const SceneCamera* set_view(Camera& camera, const Assembly& assembly, const ViewRequest& request);

}  // namespace REALCAM_NAMESPACE
