#include <algorithm>

#include "exr_layer.hpp"
#include "open_picture.hpp"
#include "openimageio.hpp"

namespace realcam::image_io {
namespace {

/// Picture of a format that OpenImageIO decodes.
class OpenImageIoPicture final : public OpenPicture {
public:
    OpenImageIoPicture(const std::string& format, const std::string& path, std::span<const std::uint8_t> bytes,
                       const std::string& layer)
        : is_jpeg_(format == "jpeg"), decoder_(open_decoder(format, path, bytes)) {
        const auto is_flat = [](const EncodedHeader& part) { return part.depth <= 1 && !part.is_deep; };
        if (std::ranges::none_of(decoder_->parts, is_flat)) return;
        if (format == "openexr") chosen_ = choose_layer(decoder_->parts, layer);
        const EncodedHeader& header = part();
        // OpenImageIO decodes all channels, whichever are requested: a broken file may claim more than memory holds.
        constexpr std::size_t kMaxChannels = 64;
        if (header.channel_names.size() > kMaxChannels)
            throw Error("has " + std::to_string(header.channel_names.size()) + " channels; at most 64 are read");
        width = header.width;
        height = header.height;
        if (format == "openexr")
            read_openexr_header(header);
        else
            for (int c = 0; c < static_cast<int>(std::min<std::size_t>(header.channel_names.size(), 4)); ++c)
                chosen_.channels.push_back(c);
        channels = static_cast<int>(chosen_.channels.size());
        is_linear = header.is_floating_point;
        is_wide = header.bytes_per_value > 1;
        // OpenEXR colours are always premultiplied by alpha.
        has_associated_alpha = format == "openexr" && channels == 4;
        entries = header.entries;
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
    void read_openexr_header(const EncodedHeader& header) {
        if (header.chromaticities) {
            Chromaticities chromaticities{};
            std::copy(header.chromaticities->begin(), header.chromaticities->end(), chromaticities.begin());
            rec709 = rec709_from(chromaticities);
        }
        if (header.texture_format == "CubeFace Environment") environment_map = EnvironmentMap::cube;
        if (header.texture_format == "LatLong Environment") environment_map = EnvironmentMap::lat_long;
        is_windowed_ = environment_map == EnvironmentMap::none &&
                       (header.x != header.full_x || header.y != header.full_y || header.width != header.full_width ||
                        header.height != header.full_height);
        if (!is_windowed_) return;
        encoded_pixels = pixel_count();
        const auto overlap = [](std::int64_t a, std::int64_t a_size, std::int64_t b, std::int64_t b_size) {
            return a < b + b_size && b < a + a_size;
        };
        if (!overlap(header.x, header.width, header.full_x, header.full_width) ||
            !overlap(header.y, header.height, header.full_y, header.full_height))
            throw Error("has a data window that lies outside of its display window");
        width = header.full_width;
        height = header.full_height;
    }

    /// Decodes the rows of the data window, and copies the part of them inside the picture (see OpenPicture::read).
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
            const auto end_row = static_cast<int>(std::min<std::int64_t>(y + rows, s.height));
            const Outcome outcome = decoder_->read(
                {static_cast<int>(chosen_.part), static_cast<int>(y), end_row, used.min, used.max + 1}, read.data());
            if (!outcome.is_good || reports_truncation(outcome.said)) throw Error(kBroken + reason(outcome.said));
            for (auto row = static_cast<int>(y); row < end_row; ++row) {
                if (top + row < 0 || top + row >= height) continue;
                const Value* source = read.data() + (size(row - y) * size(s.width) + size(first)) * size(read_channels);
                Value* target = pixels + (size(top + row) * size(width) + size(left + first)) * size(stride);
                for (int column = first; column < end; ++column, source += read_channels, target += stride)
                    for (int c = 0; c < count; ++c) target[c] = source[chosen_.channels[size(c)] - used.min];
            }
        }
    }

    /// True if OpenImageIO's message reports truncated data: it decodes a truncated TIFF or JPEG to the end, filling
    /// the missing rows. For a JPEG it also reports harmless defects, such as excess bytes.
    bool reports_truncation(const std::string& said) const {
        return is_jpeg_ ? said.find("Premature end") != std::string::npos : !said.empty();
    }

    const EncodedHeader& part() const { return decoder_->parts[chosen_.part]; }

    bool is_jpeg_;
    std::unique_ptr<PictureDecoder> decoder_;
    ExrLayer chosen_;  // part and channels that are read
    bool is_windowed_ = false;  // the data window differs from the display window
};

}  // namespace

std::unique_ptr<OpenPicture> open_with_openimageio(const std::string& format, const std::string& path,
                                                   std::span<const std::uint8_t> bytes, const std::string& layer) {
    return std::make_unique<OpenImageIoPicture>(format, path, bytes, layer);
}

}  // namespace realcam::image_io
