#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "../../camera/models/pinhole_camera.hpp"
#include "../../render/settings/render_settings.hpp"

namespace realcam::io {

/// Metadata of a picture file: the camera and the settings with which the picture was taken.
struct ImageMetadata {
    std::string lens;   ///< name
    std::string model;  ///< camera model, see name_of
    double focal_length_mm = 0;
    double f_number = 0;
    IrisShape iris;
    double focus_distance_m = 0;  ///< from the object plane to the film; may be infinite
    double film_width_mm = 0, film_height_mm = 0;
    Vec2<double> film_shift_mm = {0, 0};
    double pixel_width_um = 0, pixel_height_um = 0;
    std::optional<PinholeCamera> pinhole;  ///< paraxial model, at the middle of the exposure
    double exposure_time_s = 0;
    double shutter_opens_s = 0, readout_time_s = 0;
    double iso = 100;
    std::uint32_t seed = 0;
    int spp = 0;  ///< samples per pixel
    PixelFilter filter = PixelFilter::box;
    LightTransport transport = LightTransport::paths;
    double clamp_cd_m2 = 0;  ///< largest radiance of indirect light; 0: no limit
    /// Names of effects, separated by commas, and the illuminant as text; may be empty.
    std::string effects, illuminant;
    std::string lens_filter;  ///< LensFilter::text(); empty: no filter in front of the lens
    std::string coatings;  ///< coating_summary if an effect needs coatings; otherwise empty
    std::string plan;  ///< summary of the planner's decisions; empty without a plan
    std::string film;  ///< digest of the settings, and the number of the video frame; empty for a single picture
    std::string denoiser;  ///< name of the denoiser that changed the exposure; empty without one

    /// Returns names "realcam:..." and their values, as stored in every format.
    std::vector<std::pair<std::string, std::string>> entries() const;
};

/// Returns the metadata of a picture that is taken by a camera with these settings. plan, film and denoiser are empty.
ImageMetadata metadata_of(const Camera& camera, const RenderSettings& settings);

}  // namespace realcam::io
