#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "../error.hpp"
#include "../keep_going.hpp"
#include "color_primaries.hpp"

namespace realcam::image_io {

/// What the directions of a picture are, where its file says so.
enum class EnvironmentMap {
    none,      ///< it does not: a latitude-longitude picture is as realcam has them
    lat_long,  ///< OpenEXR's latitude-longitude map, whose middle column lies towards +z
    cube,      ///< OpenEXR's cube map: six squares below each other, +x, -x, +y, -y, +z and -z
};

/// A picture file, opened and not yet decoded.
class OpenPicture {
public:
    virtual ~OpenPicture() = default;

    int width = 0, height = 0;
    int channels = 0;  ///< of those that are read: grey, grey and alpha, RGB, or RGB and alpha
    bool is_linear = false;  ///< floating-point numbers, and not codes for a screen
    bool is_wide = false;    ///< more than 8 bits a value
    bool has_associated_alpha = false;  ///< colours are multiplied by alpha
    std::size_t encoded_size = 0;       ///< bytes of the file
    std::size_t encoded_pixels = 0;     ///< where the file has other pixels than those that are read; 0: as many
    std::optional<std::array<double, 9>> rec709;  ///< by rows, to linear Rec. 709, where colours are others
    EnvironmentMap environment_map = EnvironmentMap::none;
    std::vector<std::pair<std::string, std::string>> entries;  ///< of its metadata, those named "realcam:..."

    std::size_t pixel_count() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }

    /// Decodes the first `count` channels of each pixel to the beginning of its `stride` values, whole codes from 0 to
    /// 255, or numbers of which 1 is white. Throws Error, with the reason alone, and Cancelled.
    virtual void read(int count, int stride, std::uint8_t* pixels, const KeepGoing& keep_going) = 0;
    virtual void read(int count, int stride, float* pixels, const KeepGoing& keep_going) = 0;
};

/// Opens the file `path`, or, where it is empty, the bytes of one, which have to outlive the result. Throws Error, with
/// the reason alone. `layer`: of an OpenEXR file (see choose_layer); empty: the layer that holds the picture.
std::unique_ptr<OpenPicture> open_picture(const std::string& path, std::span<const std::uint8_t> bytes,
                                          const std::string& layer = "");

/// The parts of open_picture: a PNG, a Radiance picture, and what OpenImageIO reads as `format`.
std::unique_ptr<OpenPicture> open_png(const std::string& path, std::span<const std::uint8_t> bytes);
std::unique_ptr<OpenPicture> open_radiance(const std::string& path, std::span<const std::uint8_t> bytes);
std::unique_ptr<OpenPicture> open_with_openimageio(const std::string& format, const std::string& path,
                                                   std::span<const std::uint8_t> bytes, const std::string& layer);

/// What a decoder says of data that it cannot decode.
inline constexpr const char* kBroken = "is broken or incomplete";

inline void check(const KeepGoing& keep_going) {
    if (keep_going && !keep_going()) throw Cancelled();
}

}  // namespace realcam::image_io
