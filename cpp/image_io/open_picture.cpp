#include "open_picture.hpp"

#include <filesystem>
#include <fstream>
#include <vector>

#include "../io/files/readable_file.hpp"
#include "../io/text/printable.hpp"
#include "image_format.hpp"

namespace realcam::image_io {

std::unique_ptr<OpenPicture> open_picture(const std::string& path, std::span<const std::uint8_t> bytes,
                                          const std::string& layer) {
    std::vector<std::uint8_t> beginning(bytes.begin(), bytes.begin() + std::min(bytes.size(), kFormatBytes));
    if (!path.empty()) {
        const std::string why = io::why_unreadable(path);
        if (!why.empty()) throw Error(why);
        beginning.resize(kFormatBytes);
        std::ifstream file(path, std::ios::binary);
        file.read(reinterpret_cast<char*>(beginning.data()), kFormatBytes);
        beginning.resize(static_cast<std::size_t>(file.gcount()));
    }
    const std::string format = image_format(beginning, path);
    if (format.empty()) throw Error(std::string("is no picture; ") + kReadFormats + " is wanted");
    if (!layer.empty() && format != "openexr")
        throw Error("has no layers, and layer " + io::in_quotes(layer) + " is wanted; only OpenEXR files have them");
    auto picture = format == "png"   ? open_png(path, bytes)
                   : format == "hdr" ? open_radiance(path, bytes)
                                     : open_with_openimageio(format, path, bytes, layer);
    picture->encoded_size = path.empty() ? bytes.size() : std::filesystem::file_size(path);
    if (picture->width < 1 || picture->height < 1 || picture->channels < 1)
        throw Error("is no flat picture with colours");
    return picture;
}

}  // namespace realcam::image_io
