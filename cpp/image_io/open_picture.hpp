#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "../checkpoint.hpp"
#include "../error.hpp"

namespace realcam::image_io {

/// CIE 1931 x and y of red, green, blue and white, in this order, as in OpenEXR's attribute `chromaticities` and
/// Radiance's line PRIMARIES.
using Chromaticities = std::array<double, 8>;

/// Chromaticities of files whose channels are the tristimulus values X, Y and Z.
inline constexpr Chromaticities kXyzChromaticities = {1, 0, 0, 1, 0, 0, 1.0 / 3, 1.0 / 3};

/// Returns the matrix, by rows, from colours with these chromaticities to linear Rec. 709. White is adapted to that of
/// Rec. 709 by the Bradford transform, except for files of X, Y and Z, which are absolute. Returns std::nullopt if the
/// chromaticities are those of Rec. 709. Throws Error if they are degenerate.
std::optional<std::array<double, 9>> rec709_from(const Chromaticities& chromaticities);

/// Chromaticities of ITU-R BT.709, which OpenEXR assumes if a file states none, and of ACEScg: the primaries AP1 and
/// the white of ACES (Academy S-2014-004).
inline constexpr Chromaticities kRec709Chromaticities = {0.64, 0.33, 0.30, 0.60, 0.15, 0.06, 0.3127, 0.3290};
inline constexpr Chromaticities kAcesCgChromaticities = {0.713, 0.293, 0.165, 0.830, 0.128, 0.044, 0.32168, 0.33767};

/// Applies a 3 x 3 matrix to the first three numbers of each pixel. `stride`: distance between pixels, in numbers.
void apply_matrix(const std::array<double, 9>& matrix, float* pixels, std::size_t count, std::size_t stride);

/// Mapping from pixels to directions that a picture file declares.
enum class EnvironmentMap {
    none,  ///< default: a latitude-longitude picture with realcam's directions
    lat_long,  ///< OpenEXR's latitude-longitude map, whose middle column lies towards +z
    cube,  ///< OpenEXR's cube map: six squares below each other, +x, -x, +y, -y, +z and -z
};

/// Opened picture file, whose pixels have not been decoded yet.
class OpenPicture {
public:
    virtual ~OpenPicture() = default;

    int width = 0, height = 0;
    int channels = 0;  ///< number of channels read: grey, grey and alpha, RGB, or RGB and alpha
    bool is_linear = false;  ///< linear floating-point numbers instead of display values
    bool is_wide = false;  ///< values have more than 8 bits
    bool has_associated_alpha = false;  ///< colours are multiplied by alpha
    std::size_t encoded_size = 0;  ///< bytes of the file
    /// Number of pixels in the file if it differs from pixel_count(); 0: no difference.
    std::size_t encoded_pixels = 0;
    std::optional<std::array<double, 9>> rec709;  ///< matrix, by rows, to linear Rec. 709, if the primaries differ
    EnvironmentMap environment_map = EnvironmentMap::none;
    std::vector<std::pair<std::string, std::string>> entries;  ///< metadata entries named "realcam:..."

    std::size_t pixel_count() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }

    /// Decodes all pixels. The first `count` channels of a pixel are written to the beginning of its `stride` values,
    /// as display values from 0 to 255, or as numbers with white = 1. Throws Error, whose message is the reason without
    /// the path, and Cancelled.
    virtual void read(int count, int stride, std::uint8_t* pixels, const KeepGoing& keep_going) = 0;
    virtual void read(int count, int stride, float* pixels, const KeepGoing& keep_going) = 0;
};

/// Opens the file `path`, or, if it is empty, the bytes of a file, which have to outlive the result. `layer`: a layer
/// of an OpenEXR file (see choose_layer); empty: the layer that holds the picture. Throws Error, whose message is the
/// reason without the path.
std::unique_ptr<OpenPicture> open_picture(const std::string& path, std::span<const std::uint8_t> bytes,
                                          const std::string& layer = "");

/// Implementations of open_picture: for PNG, for Radiance pictures, and for the formats that OpenImageIO reads.
std::unique_ptr<OpenPicture> open_png(const std::string& path, std::span<const std::uint8_t> bytes);
std::unique_ptr<OpenPicture> open_radiance(const std::string& path, std::span<const std::uint8_t> bytes);
std::unique_ptr<OpenPicture> open_with_openimageio(const std::string& format, const std::string& path,
                                                   std::span<const std::uint8_t> bytes, const std::string& layer);

/// Beginning of the error message for data that cannot be decoded.
inline constexpr const char* kBroken = "is broken or incomplete";

/// Throws Cancelled if `keep_going` returns false.
inline void check(const KeepGoing& keep_going) {
    if (keep_going && !keep_going()) throw Cancelled();
}

}  // namespace realcam::image_io
