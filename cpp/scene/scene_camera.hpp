#pragma once
#include <memory>
#include <string>

#include "../math/motion.hpp"

namespace REALCAM_NAMESPACE {

/// Camera of a scene file: pose and field of view. The lens comes from realcam, not from the file.
struct SceneCamera {
    std::string name;
    /// The camera is at the origin of its frame and looks along -z, with y up; metres. For a moving camera: at time 0.
    Affine<double> scene_from_camera;
    /// Vertical field of view in radians. 0 for an orthographic camera, which no lens can reproduce.
    double vertical_field_rad = 0;
    std::shared_ptr<const Motion> motion = nullptr;  ///< null: not animated

    bool has_pose() const { return vertical_field_rad > 0; }
    Affine<double> transform_at(double time_s) const { return motion ? motion->at(time_s) : scene_from_camera; }
};

}  // namespace REALCAM_NAMESPACE
