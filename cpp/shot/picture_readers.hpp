#pragma once
#include <functional>
#include <string>

#include "../io/scene_file.hpp"

namespace realcam::shot {

/// How pictures are read: the programs give OpenImageIO's.
struct PictureReaders {
    io::ImageReader texture;
    /// `layer`: one of an OpenEXR's layers, or empty. `warn` takes what was put up with.
    std::function<Environment(const std::string& path, const std::string& layer,
                              const std::function<void(const std::string&)>& warn)>
        environment;
};

}  // namespace realcam::shot
