#pragma once
#include <functional>
#include <string>

#include "../io/scene_file.hpp"

namespace realcam::shot {

/// How pictures are read: the programs give OpenImageIO's.
struct PictureReaders {
    io::ImageReader texture;
    /// `warn` takes what was put up with.
    std::function<Environment(const std::string& path, const std::function<void(const std::string&)>& warn)>
        environment;
};

}  // namespace realcam::shot
