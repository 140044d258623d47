#include <algorithm>

#include "exr_layer.hpp"
#include "open_picture.hpp"
#include "openimageio.hpp"

namespace realcam::image_io {
namespace {

class OpenImageIoPicture final : public OpenPicture {
public:
    OpenImageIoPicture(const std::string& format, const std::string& path, std::span<const std::uint8_t> bytes,
                       const std::string& layer)
        : is_jpeg_(format == "jpeg"), decoder_(open_decoder(format, path, bytes)) {
        const auto is_flat = [](const EncodedHeader& part) { return part.depth <= 1 && !part.is_deep; };
        if (std::ranges::none_of(decoder_->parts, is_flat)) return;
        if (format == "openexr") chosen_ = choose_layer(decoder_->parts, layer);
        const EncodedHeader& found = part();
        // OpenImageIO decodes all channels, whichever are requested: a broken file may claim more than memory holds.
        constexpr std::size_t kMostChannels = 64;
        if (found.channel_names.size() > kMostChannels)
            throw Error("has " + std::to_string(found.channel_names.size()) + " channels; at most 64 are read");
        width = found.width;
        height = found.height;
        if (format == "openexr")
            read_openexr_header(found);
        else
            for (int c = 0; c < static_cast<int>(std::min<std::size_t>(found.channel_names.size(), 4)); ++c)
                chosen_.channels.push_back(c);
        channels = static_cast<int>(chosen_.channels.size());
        is_linear = found.is_floating_point;
        is_wide = found.bytes_per_value > 1;
        // OpenEXR colours are always premultiplied by alpha.
        has_associated_alpha = format == "openexr" && channels == 4;
        entries = found.entries;
    }

    void read(int count, int stride, std::uint8_t* pixels, const KeepGoing& keep_going) override {
        read_as(count, stride, pixels, keep_going);
    }
    void read(int count, int stride, float* pixels, const KeepGoing& keep_going) override {
        read_as(count, stride, pixels, keep_going);
    }

private:
    /// The picture is the display window: pixels of the data window outside of it are cropped, and pixels without data
    /// are black. For an environment map, which has no meaningful crop, the picture is the data window.
    void read_openexr_header(const EncodedHeader& found) {
        if (found.chromaticities) {
            Chromaticities chromaticities{};
            std::copy(found.chromaticities->begin(), found.chromaticities->end(), chromaticities.begin());
            rec709 = rec709_from(chromaticities);
        }
        if (found.texture_format == "CubeFace Environment") environment_map = EnvironmentMap::cube;
        if (found.texture_format == "LatLong Environment") environment_map = EnvironmentMap::lat_long;
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

    /// Reads the rows of the data window and copies the part inside the picture to the beginning of its pixels.
    template <class Value>
    void read_as(int count, int stride, Value* pixels, const KeepGoing& keep_going) {
        constexpr std::int64_t kRows = 64;  // between two calls of keep_going
        const EncodedHeader& s = part();
        const auto used = std::ranges::minmax(std::span(chosen_.channels).first(static_cast<std::size_t>(count)));
        const int read_channels = used.max + 1 - used.min;
        const auto size = [](std::int64_t number) { return static_cast<std::size_t>(number); };
        if (is_windowed_)
            for (std::size_t i = 0; i < pixel_count(); ++i) std::fill_n(pixels + i * size(stride), count, Value(0));
        const std::int64_t tile = s.tile_height,
                           rows = std::min<std::int64_t>(tile > 0 ? (kRows + tile - 1) / tile * tile : kRows, s.height);
        const int left = is_windowed_ ? s.x - s.full_x : 0, top = is_windowed_ ? s.y - s.full_y : 0;
        const int first = std::max(0, -left), end = std::min(s.width, width - left);
        std::vector<Value> read(size(rows) * size(s.width) * size(read_channels));
        for (std::int64_t y = 0; y < s.height; y += rows) {
            check(keep_going);
            const auto below = static_cast<int>(std::min<std::int64_t>(y + rows, s.height));
            const Outcome outcome = decoder_->read(
                {static_cast<int>(chosen_.part), static_cast<int>(y), below, used.min, used.max + 1}, read.data());
            if (!outcome.is_good || tells_of_a_cut(outcome.said)) throw Error(kBroken + reason(outcome.said));
            for (auto row = static_cast<int>(y); row < below; ++row) {
                if (top + row < 0 || top + row >= height) continue;
                const Value* from = read.data() + (size(row - y) * size(s.width) + size(first)) * size(read_channels);
                Value* to = pixels + (size(top + row) * size(width) + size(left + first)) * size(stride);
                for (int column = first; column < end; ++column, from += read_channels, to += stride)
                    for (int c = 0; c < count; ++c) to[c] = from[chosen_.channels[size(c)] - used.min];
            }
        }
    }

    /// True if OpenImageIO's message tells of truncated data. It decodes a truncated TIFF or JPEG to the end, with rows
    /// of grey or nothing, and only reports it. For a JPEG it also reports harmless things, such as a few excess bytes.
    bool tells_of_a_cut(const std::string& said) const {
        return is_jpeg_ ? said.find("Premature end") != std::string::npos : !said.empty();
    }

    const EncodedHeader& part() const { return decoder_->parts[chosen_.part]; }

    bool is_jpeg_;
    std::unique_ptr<PictureDecoder> decoder_;
    ExrLayer chosen_;
    bool is_windowed_ = false;  // the data window differs from the display window
};

}  // namespace

std::unique_ptr<OpenPicture> open_with_openimageio(const std::string& format, const std::string& path,
                                                   std::span<const std::uint8_t> bytes, const std::string& layer) {
    return std::make_unique<OpenImageIoPicture>(format, path, bytes, layer);
}

}  // namespace realcam::image_io
