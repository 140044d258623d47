#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "../../camera/pinhole_camera.hpp"
#include "../../render/render_settings.hpp"

namespace realcam::io {

/// What a picture was taken with, as its file tells it.
struct ImageMetadata {
    std::string lens;
    std::string model;
    double focal_length_mm = 0;
    double f_number = 0;
    IrisShape iris;
    double focus_distance_m = 0;  ///< object plane to film; may be infinite
    double film_width_mm = 0, film_height_mm = 0;
    Vec2<double> film_shift_mm = {0, 0};
    double pixel_width_um = 0, pixel_height_um = 0;
    std::optional<PinholeCamera> pinhole;  ///< to first order, in the middle of the exposure
    double exposure_time_s = 0;
    double shutter_opens_s = 0, readout_time_s = 0;
    double iso = 100;
    std::uint32_t seed = 0;
    int spp = 0;
    LightTransport transport = LightTransport::paths;
    double clamp_cd_m2 = 0;
    std::string effects, illuminant;  ///< names with commas, and as it was written; empty: none
    std::string coatings;  ///< of the effects coatings and ghosts: coating_summary; empty: without
    std::string plan;  ///< what a planner has decided, and by which sizes; empty: there was none
    std::string film;      ///< of a frame: digest of all settings of its film and of its number; empty: a still
    std::string denoiser;  ///< what has changed the exposure since it was taken; empty: nothing

    /// Names "realcam:..." and values, as they go into every format.
    std::vector<std::pair<std::string, std::string>> entries() const;
};

/// Names as on the command line: "full", "thick", "thin", "pinhole".
std::string name_of(CameraModel model);
/// "paths" or "whitted".
std::string name_of(LightTransport transport);

ImageMetadata metadata_of(const Camera& camera, const RenderSettings& settings);

}  // namespace realcam::io
