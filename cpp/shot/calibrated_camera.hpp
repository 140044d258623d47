#pragma once
#include <functional>
#include <optional>
#include <string>

#include "../camera/film/camera.hpp"

namespace realcam::shot {

/// Calibration of a shot's camera, in place of the lens's own geometry.
struct CalibrationRequest {
    std::string file;        ///< empty: the camera is not calibrated
    std::string camera;      ///< name of one of several cameras of the file; empty: the only one
    std::string vignetting;  ///< flat field, or lensfun database; empty: the lens's own falloff
};

/// Makes a camera whose lens, film and geometry are those of a calibration. `lens`: std::nullopt for the bundled lens
/// that resembles the calibration most, at `f_number`. `film_width_mm`: see Calibration.camera of the Python package.
/// Throws InputError.
using CalibratedCameraMaker =
    std::function<Camera(const CalibrationRequest& request, const std::optional<LensSystem>& lens,
                         std::optional<double> film_width_mm, std::optional<double> f_number)>;

/// The function that the Python package provides, which reads the formats of calibrations; empty in the executable.
CalibratedCameraMaker& calibrated_camera_maker();

}  // namespace realcam::shot
