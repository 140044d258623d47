#pragma once
// Reads and writes picture files, through OpenImageIO.

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "../checkpoint.hpp"
#include "../io/files/image_metadata.hpp"
#include "../io/scene_file.hpp"
#include "../render/film/image.hpp"
#include "../render/film/view.hpp"

namespace realcam::image_io {

/// Reads a picture (an io::ImageReader) from the file `path`, or, if `path` is empty, from the bytes of a file. The
/// result has unassociated alpha: premultiplied colours in the file are divided by alpha. Negative floating-point
/// numbers and NaN become 0, and large ones are limited to the largest half float. Throws Error with the reason if the
/// picture cannot be decoded, and Cancelled.
io::DecodedImage read_image(const std::string& path, std::span<const std::uint8_t> encoded_bytes,
                            const KeepGoing& keep_going = {});

/// Function that receives a warning of a reader, in one line.
using WarnOf = std::function<void(const std::string& message)>;

/// Reads a latitude-longitude picture (row 0 up, the middle column towards -z) as light from infinity. Floating-point
/// values (EXR, HDR) are cd/m^2; 8 and 16 bits are sRGB, with white as 1 cd/m^2. Colours with other primaries, given in
/// an EXR or HDR, are converted to Rec. 709; an EXR that declares an environment map (attribute `envmap`) has the
/// directions of OpenEXR, and may be a cube map. `layer`: name of an EXR's layer; empty: its beauty or only layer.
/// Negative numbers become 0, with a warning. Throws ImageFileError if the file cannot be read, if negative numbers are
/// more than a twentieth of the light, or if a value is not finite or beyond 1e20; and Cancelled. `to_rec709`:
/// conversion of the file's values, in place of what it states of its colours; empty: none.
Environment read_environment(const std::string& path, const std::string& layer = {}, const WarnOf& warn = {},
                             const KeepGoing& keep_going = {}, const io::ColorConversion& to_rec709 = {});

/// Reads a picture of any projection, with the values that read_environment gives it. Throws the errors of
/// read_environment.
Environment read_picture(const std::string& path, const WarnOf& warn = {}, const KeepGoing& keep_going = {});

/// Non-owning view of a rendered picture, with its layers.
struct PictureView {
    int width = 0, height = 0;
    const float* exposure = nullptr;  ///< height * width * 3, lux seconds, linear Rec. 709
    const float* depth = nullptr;  ///< height * width, metres

    /// Values of a layer of all pixels.
    struct Layer {
        realcam::Layer layer;
        const void* values;  ///< height * width * its channels, float or uint32
    };
    std::vector<Layer> layers;
    IdNames object_names, material_names;  ///< names of the ids in the layers; empty if there are no ids
};

/// Returns a view of an image, which must outlive it.
inline PictureView view_of(const Image& image) {
    PictureView view{image.width, image.height,       image.exposure.data(), image.depth.data(),
                     {},          image.object_names, image.material_names};
    for (const LayerImage& layer : image.layers) {
        const void* const values = info_of(layer.layer).is_number ? static_cast<const void*>(layer.numbers.data())
                                                                  : static_cast<const void*>(layer.values.data());
        view.layers.push_back({layer.layer, values});
    }
    return view;
}

/// Writes a picture; the suffix selects the format. Throws ImageFileError and Cancelled, and then leaves nothing
/// behind: the file appears under its name only when it is complete.
///
/// - .png, .jpg (quality 95), .tif, .webp (lossless): 8-bit display values, developed at metadata.iso by the view. PNG
///   has a text for every entry of the metadata, JPEG and TIFF have them as lines of the description, and WebP has no
///   metadata. Files declare sRGB if the view's values are sRGB.
/// - .exr: float R, G, B, the exposure of the film in lux seconds, and Z, the depth in metres (infinite where nothing
///   is hit). Z is a channel beside the colours, with the name that OpenEXR reserves for depth: compositing programs
///   show it as a layer, and readers that do not support it ignore it; many of them would not open a file with a second
///   part. Further layers are channels, too (docs/layers.md), and the names of object and material ids are in the
///   metadata. Colours have the primaries of `color_space`, which the attribute `chromaticities` states; variances are
///   those of linear Rec. 709.
void write_image(const PictureView& picture, const std::string& path, const io::ImageMetadata& metadata,
                 const View& view = ToneView(ToneCurve::film), ExrColorSpace color_space = ExrColorSpace::rec709,
                 const KeepGoing& keep_going = {});

/// Writes a picture of 8-bit display values `codes` (height * width * 3) in one of the developed formats of
/// write_image. `entries`: metadata. `is_srgb`: true if the file declares sRGB. Throws as write_image does.
void write_codes(const std::string& path, int width, int height, const std::uint8_t* codes,
                 const std::vector<std::pair<std::string, std::string>>& entries, bool is_srgb = true,
                 const KeepGoing& keep_going = {});

/// Content of an .exr written by write_image: the exposure, and the "realcam:..." entries of its metadata.
struct FilmFile {
    int width = 0, height = 0;
    std::vector<float> exposure;  ///< height * width * 3, lux seconds, linear Rec. 709
    std::vector<std::pair<std::string, std::string>> entries;
};

/// Reads an .exr written by write_image. Throws ImageFileError and Cancelled.
FilmFile read_film(const std::string& path, const KeepGoing& keep_going = {});

/// Returns the value of a metadata entry of a picture file whose pixels can all be decoded; std::nullopt if it has no
/// entry of this name, or is not a complete picture. Throws Cancelled.
std::optional<std::string> entry_of_complete_picture(const std::string& path, const std::string& name,
                                                     const KeepGoing& keep_going = {});

/// Throws ImageFileError if write_image could not write this path; called before rendering.
void check_image_path(const std::string& path);

}  // namespace realcam::image_io
