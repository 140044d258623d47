// Fuzz target: a picture, mutated from one that can be read, becomes pixels or an error, as a texture in a file and in
// memory, and as an environment.

#include <OpenImageIO/imageio.h>

#include <cmath>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "error.hpp"
#include "fuzz_folder.hpp"
#include "image_io/image_file.hpp"
#include "mutate_bytes.hpp"
#include "target.hpp"

namespace realcam::fuzz {
namespace {

struct Kind {
    const char* suffix;
    int channels;
    OIIO::TypeDesc::BASETYPE type;
    const char* compression;  ///< empty: the format's own
    int tile;                 ///< 0: rows
    bool has_windows = false;  ///< of OpenEXR, another display window than that of the data, and colours in XYZ
};
constexpr Kind kKinds[] = {{"png", 4, OIIO::TypeDesc::UINT8, "", 0},
                           {"png", 1, OIIO::TypeDesc::UINT16, "", 0},
                           {"png", 3, OIIO::TypeDesc::UINT8, "", 0},
                           {"jpg", 3, OIIO::TypeDesc::UINT8, "", 0},
                           {"jpg", 1, OIIO::TypeDesc::UINT8, "", 0},
                           {"exr", 3, OIIO::TypeDesc::HALF, "zip", 0},
                           {"exr", 4, OIIO::TypeDesc::FLOAT, "none", 0},
                           {"exr", 3, OIIO::TypeDesc::HALF, "piz", 0},
                           {"exr", 3, OIIO::TypeDesc::HALF, "pxr24", 16},
                           {"exr", 3, OIIO::TypeDesc::HALF, "b44", 0},
                           {"exr", 3, OIIO::TypeDesc::HALF, "dwaa", 0},
                           {"exr", 1, OIIO::TypeDesc::FLOAT, "rle", 0},
                           {"hdr", 3, OIIO::TypeDesc::FLOAT, "", 0},
                           {"tif", 3, OIIO::TypeDesc::UINT8, "zip", 0},
                           {"tif", 4, OIIO::TypeDesc::FLOAT, "lzw", 16},
                           {"tif", 1, OIIO::TypeDesc::UINT16, "none", 0},
                           {"bmp", 3, OIIO::TypeDesc::UINT8, "", 0},
                           {"exr", 3, OIIO::TypeDesc::HALF, "zip", 0, true},
                           {"exr", 3, OIIO::TypeDesc::FLOAT, "none", 16, true},
                           {"tga", 4, OIIO::TypeDesc::UINT8, "rle", 0}};

struct Seed {
    std::string suffix, bytes;
};

Seed make_seed(const Kind& kind) {
    constexpr int width = 24, height = 18;
    OIIO::ImageSpec spec(width, height, kind.channels, kind.type);
    if (*kind.compression) spec.attribute("compression", kind.compression);
    spec.tile_width = spec.tile_height = kind.tile;
    std::vector<float> pixels;
    for (int i = 0; i < width * height * kind.channels; ++i)
        pixels.push_back(0.5f + 0.4f * std::sin(0.1f * static_cast<float>(i)));
    if (kind.has_windows) {
        const float xyz[8] = {1, 0, 0, 1, 0, 0, 1 / 3.f, 1 / 3.f};
        spec.attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), xyz);
        spec.x = 3, spec.full_y = -5, spec.full_width = 20, spec.full_height = 30;
    }
    const std::string path = FuzzFolder::get().path(std::string("made.") + kind.suffix);
    const auto output = OIIO::ImageOutput::create(path);
    if (!output || !output->open(path, spec) || !output->write_image(OIIO::TypeDesc::FLOAT, pixels.data())) return {};
    output->close();
    std::ifstream file(path, std::ios::binary);
    return {kind.suffix, {std::istreambuf_iterator<char>(file), {}}};
}

/// Radiance's pictures as OpenImageIO does not write them: colours in XYZ, another corner first, exposures, and the
/// older run lengths.
Seed radiance_seed() {
    std::string bytes =
        "#?RADIANCE\n# made\nFORMAT=32-bit_rle_xyze\nEXPOSURE=2\nEXPOSURE= 0.5\nCOLORCORR=1 2 1\n"
        "PRIMARIES=.64 .33 .29 .6 .15 .06 .33 .33\n\n+X 12 -Y 8\n";
    for (char column = 0; column < 12; ++column)
        bytes += std::string("\x80\x40\x10\x81\x01\x01\x01\x03\x7f\x20\x01", 11) + column +
                 std::string("\x01\x01\x01\x03", 4);
    return {"hdr", bytes};
}

const std::vector<Seed>& seeds() {
    static const std::vector<Seed> all = [] {
        std::vector<Seed> made;
        for (const Kind& kind : kKinds) {
            made.push_back(make_seed(kind));
            if (made.back().bytes.empty()) report("a seed cannot be written", "%s", kind.suffix);
        }
        made.push_back(radiance_seed());
        return made;
    }();
    return all;
}

bool is_read(const Seed& seed, const std::string& path, std::span<const std::uint8_t> encoded_bytes) {
    try {
        image_io::read_image(path, encoded_bytes);
        return true;
    } catch (const Error& error) {
        if (std::strchr(error.what(), '\n')) report("a message of several lines", "%s", error.what());
    } catch (const std::exception& error) {
        report("a picture raises something else", "%s: %s", seed.suffix.c_str(), error.what());
    }
    return false;
}

}  // namespace

int fuzz_picture(const std::uint8_t* data, std::size_t size) {
    Bytes in(data, size);
    const Seed& seed = seeds()[in.word() % seeds().size()];
    std::string bytes = seed.bytes;
    for (int i = in.below(8); i >= 0; --i) mutate_bytes(in, bytes);
    const std::string path = FuzzFolder::get().write("seed." + seed.suffix, bytes);
    ++findings().files;
    const auto* first = reinterpret_cast<const std::uint8_t*>(bytes.data());
    const bool in_memory = is_read(seed, "", {first, bytes.size()});
    const bool in_file = is_read(seed, path, {});
    findings().files_read += in_memory || in_file;
    try {
        const Environment light = image_io::read_environment(path);
        for (const Color& p : light.pixels)
            if (!(p.r >= 0 && p.r <= 1e20f && p.g >= 0 && p.g <= 1e20f && p.b >= 0 && p.b <= 1e20f))
                return report("an environment has light that is none", "%s", seed.suffix.c_str()), 0;
    } catch (const ImageFileError& error) {
        if (std::strchr(error.what(), '\n')) report("a message of several lines", "%s", error.what());
    } catch (const std::exception& error) {
        report("an environment raises something else", "%s: %s", seed.suffix.c_str(), error.what());
    }
    return 0;
}

}  // namespace realcam::fuzz

REALCAM_FUZZ_TARGET(fuzz_picture)
