#pragma once
#include <functional>
#include <string>

#include "../io/scene_file.hpp"

namespace realcam::shot {

/// Functions that read pictures; the programs supply those of OpenImageIO.
struct PictureReaders {
    io::ImageReader texture;
    /// `layer`: name of an OpenEXR layer, or empty. `warn`: receives what was tolerated in the file.
    std::function<Environment(const std::string& path, const std::string& layer,
                              const std::function<void(const std::string&)>& warn)>
        environment;
};

}  // namespace realcam::shot
