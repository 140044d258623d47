#pragma once
#include <memory>
#include <string>

#include "../math/motion.hpp"

namespace REALCAM_NAMESPACE {

/// A camera that a scene's file brings along: where it is and where it looks to. What its lens is, realcam's own says.
struct SceneCamera {
    std::string name;
    /// It stands in the origin and looks along -z, y upwards; metres. Of one that moves, at time 0.
    Affine<double> scene_from_camera;
    /// The angle from the lower edge of its picture to the upper one, radians. It is 0 where rays are parallel
    /// (orthographic), which no lens's are.
    double vertical_field_rad = 0;
    std::shared_ptr<const Motion> motion = nullptr;  ///< null: it stays where it is

    bool has_place() const { return vertical_field_rad > 0; }
    Affine<double> transform_at(double time_s) const { return motion ? motion->at(time_s) : scene_from_camera; }
};

}  // namespace REALCAM_NAMESPACE
