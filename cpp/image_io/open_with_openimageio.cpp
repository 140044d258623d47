#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cstring>

#include "open_picture.hpp"

namespace realcam::image_io {
namespace {

using OIIO::ImageInput;
using OIIO::ImageSpec;

/// The first line of what OpenImageIO says, unless its own formatting of it failed.
std::string reason(const std::string& said) {
    const std::string line = said.substr(0, said.find('\n'));
    return line.empty() || line.find("fixme") != std::string::npos ? "" : " (" + line + ")";
}

class OpenImageIoPicture final : public OpenPicture {
public:
    OpenImageIoPicture(const std::string& format, const std::string& path, std::span<const std::uint8_t> bytes) {
        ImageSpec wishes, spec;
        wishes.attribute("oiio:UnassociatedAlpha", 1);
        if (path.empty()) {
            memory_ = std::make_unique<OIIO::Filesystem::IOMemReader>(bytes.data(), bytes.size());
            OIIO::Filesystem::IOProxy* proxy = memory_.get();
            wishes.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
        }
        input_ = ImageInput::create(format);
        if (!input_) throw Error("OpenImageIO cannot read " + format + reason(OIIO::geterror()));
        if (!input_->open(path.empty() ? "memory." + format : path, spec, wishes))
            throw Error(kBroken + reason(input_->geterror()));
        const ImageSpec& found = input_->spec();
        if (found.depth > 1 || found.deep) return;  // no picture of flat pixels
        // OpenImageIO decodes all of them, whichever are asked for: a broken file may claim more than memory holds.
        constexpr int kMostChannels = 64;
        if (found.nchannels > kMostChannels)
            throw Error("has " + std::to_string(found.nchannels) + " channels; at most 64 are read");
        width = found.width;
        height = found.height;
        if (format == "openexr") read_openexr_header(found);
        channels = std::min(found.nchannels, 4);
        is_linear = found.format.is_floating_point();
        is_wide = found.format.size() > 1;
        // OpenEXR multiplies colours by alpha, whatever a reader wishes.
        has_associated_alpha = format == "openexr" && found.alpha_channel == 3;
        for (const OIIO::ParamValue& entry : found.extra_attribs) {
            const std::string name = entry.name().string();
            if (name.starts_with("realcam:")) entries.emplace_back(name, entry.get_string());
        }
    }

    void read(int count, int stride, std::uint8_t* pixels, const KeepGoing& keep_going) override {
        read_as(count, stride, pixels, keep_going);
    }
    void read(int count, int stride, float* pixels, const KeepGoing& keep_going) override {
        read_as(count, stride, pixels, keep_going);
    }

private:
    /// The picture is the display window. What of the data window lies outside is cut off, and what it leaves is black.
    /// An environment map, of which a part would mean nothing, is the data window.
    void read_openexr_header(const ImageSpec& found) {
        std::array<float, 8> colours{};
        if (found.getattribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), colours.data())) {
            Chromaticities chromaticities{};
            std::copy(colours.begin(), colours.end(), chromaticities.begin());
            rec709 = rec709_from(chromaticities);
        }
        const std::string kind = found.get_string_attribute("textureformat");
        if (kind == "CubeFace Environment") environment_map = EnvironmentMap::cube;
        if (kind == "LatLong Environment") environment_map = EnvironmentMap::lat_long;
        is_windowed_ = environment_map == EnvironmentMap::none &&
                       (found.x != found.full_x || found.y != found.full_y || found.width != found.full_width ||
                        found.height != found.full_height);
        if (!is_windowed_) return;
        encoded_pixels = pixel_count();
        const auto meet = [](std::int64_t a, std::int64_t a_size, std::int64_t b, std::int64_t b_size) {
            return a < b + b_size && b < a + a_size;
        };
        if (!meet(found.x, found.width, found.full_x, found.full_width) ||
            !meet(found.y, found.height, found.full_y, found.full_height))
            throw Error("has a data window that lies outside of its display window");
        width = found.full_width;
        height = found.full_height;
    }

    template <class Value>
    void read_as(int count, int stride, Value* pixels, const KeepGoing& keep_going) {
        constexpr int kRows = 64;  // between two looks at keep_going
        const auto step = static_cast<OIIO::stride_t>(static_cast<std::size_t>(stride) * sizeof(Value));
        const auto type = OIIO::BaseTypeFromC<Value>::value;
        const ImageSpec& s = input_->spec();
        const auto require = [&](bool good) {
            const std::string said = input_->geterror();
            if (!good || tells_of_a_cut(said)) throw Error(kBroken + reason(said));
        };
        if (is_windowed_) return read_window(count, stride, pixels, keep_going, require);
        if (s.tile_width > 0) return require(input_->read_image(0, 0, 0, count, type, pixels, step));
        for (int y = 0; y < s.height; y += kRows) {
            check(keep_going);
            const std::size_t offset =
                static_cast<std::size_t>(y) * static_cast<std::size_t>(s.width) * static_cast<std::size_t>(stride);
            require(input_->read_scanlines(0, 0, s.y + y, s.y + std::min(y + kRows, s.height), s.z, 0, count, type,
                                           pixels + offset, step));
        }
    }

    /// Rows of the data window, of which those in the display window are copied.
    template <class Value, class Require>
    void read_window(int count, int stride, Value* pixels, const KeepGoing& keep_going, Require&& require) {
        const ImageSpec& s = input_->spec();
        const auto type = OIIO::BaseTypeFromC<Value>::value;
        for (std::size_t i = 0; i < pixel_count(); ++i)
            std::fill_n(pixels + i * static_cast<std::size_t>(stride), count, Value(0));
        const bool is_tiled = s.tile_width > 0;
        const int rows = is_tiled ? s.height : std::min(s.height, 64);
        std::vector<Value> read(static_cast<std::size_t>(rows) * static_cast<std::size_t>(s.width) *
                                static_cast<std::size_t>(count));
        const int first = std::max(s.x, s.full_x), end = std::min(s.x + s.width, s.full_x + s.full_width);
        for (int y = 0; y < s.height; y += rows) {
            check(keep_going);
            const int below = std::min(y + rows, s.height);
            require(is_tiled ? input_->read_image(0, 0, 0, count, type, read.data())
                             : input_->read_scanlines(0, 0, s.y + y, s.y + below, s.z, 0, count, type, read.data()));
            for (int row = y; row < below; ++row) {
                const int place = s.y + row - s.full_y;
                if (place < 0 || place >= height) continue;
                for (int column = first; column < end; ++column) {
                    const Value* from =
                        read.data() + (static_cast<std::size_t>(row - y) * static_cast<std::size_t>(s.width) +
                                       static_cast<std::size_t>(column - s.x)) *
                                          static_cast<std::size_t>(count);
                    Value* to = pixels + (static_cast<std::size_t>(place) * static_cast<std::size_t>(width) +
                                          static_cast<std::size_t>(column - s.full_x)) *
                                             static_cast<std::size_t>(stride);
                    std::copy_n(from, count, to);
                }
            }
        }
    }

    /// Reading continues behind the end of a TIFF's or JPEG's data, with rows of grey or nothing, and only reports it.
    /// For a JPEG it also reports harmless things, such as a few bytes too many.
    bool tells_of_a_cut(const std::string& said) const {
        if (std::strcmp(input_->format_name(), "jpeg") != 0) return !said.empty();
        return said.find("Premature end") != std::string::npos;
    }

    std::unique_ptr<OIIO::Filesystem::IOMemReader> memory_;  // outlives the input
    std::unique_ptr<ImageInput> input_;
    bool is_windowed_ = false;  // the data window is another than the display window
};

}  // namespace

std::unique_ptr<OpenPicture> open_with_openimageio(const std::string& format, const std::string& path,
                                                   std::span<const std::uint8_t> bytes) {
    return std::make_unique<OpenImageIoPicture>(format, path, bytes);
}

}  // namespace realcam::image_io
