#pragma once
#include <functional>
#include <string>

#include "../io/scene_file.hpp"

namespace realcam::shot {

/// How pictures are read: the programs give OpenImageIO's.
struct PictureReaders {
    io::ImageReader texture;
    std::function<Environment(const std::string& path)> environment;
};

}  // namespace realcam::shot
