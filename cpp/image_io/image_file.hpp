#pragma once
// Pictures in files, through OpenImageIO.

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "../camera/develop.hpp"
#include "../io/files/image_metadata.hpp"
#include "../io/scene_file.hpp"
#include "../keep_going.hpp"
#include "../render/image.hpp"

namespace realcam::image_io {

/// An io::ImageReader: the file `path`, or, where `path` is empty, the bytes of one. Alpha is not multiplied in, and
/// where the file has it multiplied in it is taken out. Of floating-point numbers, negative ones and NaN become 0, and
/// infinite ones the largest that a half float holds. Throws Error with the reason if it cannot be decoded, and
/// Cancelled.
io::DecodedImage read_image(const std::string& path, std::span<const std::uint8_t> encoded_bytes,
                            const KeepGoing& keep_going = {});

/// What a reader put up with, in one line.
using WarnOf = std::function<void(const std::string& message)>;

/// A latitude-longitude picture (row 0 up, the middle column towards -z) as light from infinity. Floating-point values
/// (EXR, HDR) are cd/m^2; 8 and 16 bits are sRGB, with white as 1 cd/m^2. Colours of other primaries, as an EXR or HDR
/// names them, become those of Rec. 709; an EXR that says it is an environment map (attribute `envmap`) has the
/// directions of OpenEXR, and may be a cube map. `layer`: one of an EXR's layers; empty: its beauty or only layer.
/// Negative numbers become 0, with a warning. Throws ImageFileError, also where these are more than a twentieth of the
/// light, or a value is none up to 1e20, and Cancelled.
Environment read_environment(const std::string& path, const std::string& layer = {}, const WarnOf& warn = {},
                             const KeepGoing& keep_going = {});

/// An exposed picture in somebody else's memory.
struct PictureView {
    int width = 0, height = 0;
    const float* exposure = nullptr;  ///< height * width * 3, lux seconds
    const float* depth = nullptr;  ///< height * width, metres

    struct Layer {
        realcam::Layer layer;
        const void* values;  ///< height * width * its channels, float or uint32
    };
    std::vector<Layer> layers;
    IdNames object_names, material_names;  ///< of the ids in the layers; empty: none
};

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

/// Writes a picture; the suffix picks the format. Throws ImageFileError and Cancelled, and then leaves nothing behind:
/// the file appears under its name only when it is whole.
///
/// - .png, .jpg (quality 95), .tif, .webp (lossless): 8-bit sRGB, developed at metadata.iso by the tone curve. PNG has
/// a
///   text for every entry of the metadata, JPEG and TIFF have them as lines of the description, and WebP has none.
/// - .exr: float R, G, B, the exposure of the film in lux seconds, and Z, the depth in metres (infinite where nothing
/// is).
///   Z is a channel beside the colours, under the name that OpenEXR reserves for depth: compositing programs show it as
///   a layer of its own, and readers that know nothing of it leave it out. Many of those would not open a file with a
///   second part. Further layers are channels, too (docs/layers.md), and the names of their ids are in the metadata.
void write_image(const PictureView& picture, const std::string& path, const io::ImageMetadata& metadata,
                 ToneCurve tone = ToneCurve::film, const KeepGoing& keep_going = {});

/// A picture of 8-bit sRGB codes (height * width * 3) in a developed format of write_image. Throws as write_image does.
void write_codes(const std::string& path, int width, int height, const std::uint8_t* codes,
                 const std::vector<std::pair<std::string, std::string>>& entries, const KeepGoing& keep_going = {});

/// What write_image has put into an .exr: the exposure, and the "realcam:..." entries of its metadata.
struct FilmFile {
    int width = 0, height = 0;
    std::vector<float> exposure;  ///< height * width * 3, lux seconds, linear Rec. 709
    std::vector<std::pair<std::string, std::string>> entries;
};

/// Reads such a file. Throws ImageFileError and Cancelled.
FilmFile read_film(const std::string& path, const KeepGoing& keep_going = {});

/// The value of an entry of a picture file whose pixels can all be decoded; std::nullopt if it has no entry of this
/// name, or is no whole picture. Throws Cancelled.
std::optional<std::string> entry_of_whole_file(const std::string& path, const std::string& name,
                                               const KeepGoing& keep_going = {});

/// Throws ImageFileError where write_image could not write this path: to be told before rendering, not after.
void check_image_path(const std::string& path);

}  // namespace realcam::image_io
