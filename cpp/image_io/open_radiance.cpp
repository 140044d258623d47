// Reader of Radiance pictures (.hdr). OpenImageIO's reader supports neither the lines EXPOSURE and COLORCORR, nor
// pictures that start at another corner, nor X, Y and Z, nor the older run-length coding. The format is described in
// Radiance's "File Formats" and in Ward, "Real Pixels" (Graphics Gems II, 1991).

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string>
#include <string_view>

#include "../io/files/regular_file.hpp"
#include "../io/text/printable.hpp"
#include "../io/text/text_lines.hpp"
#include "../io/text/text_number.hpp"
#include "open_picture.hpp"

namespace realcam::image_io {
namespace {

/// Sequential reader of the bytes of a file or of memory.
class Bytes {
public:
    Bytes(const std::string& path, std::span<const std::uint8_t> memory) : memory_(memory) {
        if (!path.empty()) file_ = std::make_unique<io::RegularFile>(path);
    }

    /// Returns the next byte, or -1 at the end.
    int next() {
        if (begin_ == end_ && !read_more()) return -1;
        return buffer_[begin_++];
    }
    /// Returns the next byte. Throws Error at the end.
    std::uint8_t next_or_throw() {
        const int byte = next();
        if (byte < 0) throw Error(std::string(kBroken) + " (it ends early)");
        return static_cast<std::uint8_t>(byte);
    }

private:
    bool read_more() {
        begin_ = 0;
        if (file_) {
            end_ = file_->read(reinterpret_cast<char*>(buffer_.data()), buffer_.size());
        } else {
            end_ = std::min(memory_.size(), buffer_.size());
            std::copy_n(memory_.begin(), end_, buffer_.begin());
            memory_ = memory_.subspan(end_);
        }
        return end_ > 0;
    }

    std::unique_ptr<io::RegularFile> file_;
    std::span<const std::uint8_t> memory_;
    std::array<std::uint8_t, 1 << 16> buffer_;
    std::size_t begin_ = 0, end_ = 0;
};

/// Encoded pixel: the mantissas of red, green and blue, and their common exponent.
using Rgbe = std::array<std::uint8_t, 4>;

/// Opened Radiance picture, whose header has been read.
class RadiancePicture final : public OpenPicture {
public:
    RadiancePicture(const std::string& path, std::span<const std::uint8_t> bytes) : bytes_(path, bytes) {
        channels = 3;
        is_linear = is_wide = true;
        read_header();
        read_resolution();
    }

    void read(int, int, std::uint8_t*, const KeepGoing&) override { throw Error("has no 8-bit values"); }

    void read(int count, int stride, float* pixels, const KeepGoing& keep_going) override {
        constexpr int kLines = 64;  // between two calls of keep_going
        std::vector<Rgbe> line(static_cast<std::size_t>(is_by_columns_ ? height : width));
        const int lines = is_by_columns_ ? width : height;
        for (int i = 0; i < lines; ++i) {
            if (i % kLines == 0) check(keep_going);
            read_line(line);
            for (int k = 0; k < static_cast<int>(line.size()); ++k) {
                const int along_x = is_by_columns_ ? i : k, along_y = is_by_columns_ ? k : i;
                const int column = is_from_right_ ? width - 1 - along_x : along_x,
                          row = is_from_below_ ? height - 1 - along_y : along_y;
                float* pixel = pixels + (static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
                                         static_cast<std::size_t>(column)) *
                                            static_cast<std::size_t>(stride);
                const Rgbe& rgbe = line[static_cast<std::size_t>(k)];
                for (int c = 0; c < std::min(count, 3); ++c)
                    pixel[c] = value_of(rgbe[static_cast<std::size_t>(c)], rgbe[3]) *
                               static_cast<float>(scale_[static_cast<std::size_t>(c)]);
            }
        }
    }

private:
    /// Returns the next header line without its line end. Throws Error if the line does not end.
    std::string next_line() {
        constexpr std::size_t kMaxLength = 1 << 16;
        std::string line;
        for (int byte = bytes_.next(); byte != '\n'; byte = bytes_.next()) {
            if (byte < 0 || line.size() == kMaxLength) throw Error(std::string(kBroken) + " (its header has no end)");
            line += static_cast<char>(byte);
        }
        if (line.ends_with('\r')) line.pop_back();
        return line;
    }

    /// Reads the header up to an empty line. Indented lines are ignored: Radiance's programs copy them from their input
    /// pictures.
    void read_header() {
        for (std::string line = next_line(); !line.empty(); line = next_line()) {
            const std::string_view text = line;
            const auto value = [&](std::string_view name) -> std::optional<std::string_view> {
                return text.starts_with(name) ? std::optional(io::trimmed(text.substr(name.size()))) : std::nullopt;
            };
            if (const auto format = value("FORMAT=")) read_format(*format);
            if (const auto exposure = value("EXPOSURE=")) divide_by(numbers<1>("EXPOSURE", *exposure));
            if (const auto correction = value("COLORCORR=")) divide_by(numbers<3>("COLORCORR", *correction));
            if (const auto primaries = value("PRIMARIES=")) chromaticities_ = numbers<8>("PRIMARIES", *primaries);
        }
        const auto chromaticities = is_xyz_ ? std::optional(kXyzChromaticities) : chromaticities_;
        if (chromaticities) rec709 = rec709_from(*chromaticities);
    }

    /// Reads the line FORMAT.
    void read_format(std::string_view format) {
        is_xyz_ = format == "32-bit_rle_xyze";
        if (!is_xyz_ && format != "32-bit_rle_rgbe")
            throw Error("is a Radiance picture of the format " + io::in_quotes(format) +
                        "; expected 32-bit_rle_rgbe or 32-bit_rle_xyze");
    }

    /// Parses N numbers of the header line `name`.
    template <std::size_t N>
    static std::array<double, N> numbers(const std::string& name, std::string_view text) {
        std::array<double, N> out{};
        for (double& number : out) {
            std::string_view word = io::consume_word(text);
            const std::optional<double> value = io::consume_number(word);
            if (!value || !word.empty())
                throw Error("has a line " + name + " without its " +
                            (N == 1 ? "number" : std::to_string(N) + " numbers"));
            number = *value;
        }
        return out;
    }

    /// Divides the scale of the pixels by factors with which the file's pixels have been multiplied (one for all
    /// channels, or one per channel). A file can have several such lines, which all apply.
    template <std::size_t N>
    void divide_by(const std::array<double, N>& factors) {
        for (std::size_t c = 0; c < 3; ++c) {
            const double factor = factors[N == 1 ? 0 : c];
            scale_[c] /= factor;
            if (!(factor > 0) || !(scale_[c] > 1e-30 && scale_[c] < 1e30))
                throw Error(std::string("has a line ") + (N == 1 ? "EXPOSURE" : "COLORCORR") +
                            " whose numbers are not positive, or far from 1");
        }
    }

    /// Reads the resolution line. "-Y 8 +X 16": 8 scanlines of 16 pixels from left to right, the topmost first. "+Y" is
    /// upwards, and the first axis is the one along which scanlines follow each other.
    void read_resolution() {
        const std::string line = next_line();
        std::string_view rest = line;
        bool has_x = false, has_y = false;
        for (const bool is_first : {true, false}) {
            const std::string_view axis = io::consume_word(rest);
            std::string_view number = io::consume_word(rest);
            const std::optional<std::int64_t> size = io::consume_integer(number);
            const bool is_axis = axis == "-Y" || axis == "+Y" || axis == "-X" || axis == "+X";
            if (!is_axis || !size || !number.empty() || *size < 1 || *size > kMaxSize)
                throw Error(std::string(kBroken) + " (expected a line of its size such as \"-Y 512 +X 1024\")");
            if (axis[1] == 'X') {
                has_x = true;
                width = static_cast<int>(*size);
                is_from_right_ = axis[0] == '-';
                is_by_columns_ = is_first;
            } else {
                has_y = true;
                height = static_cast<int>(*size);
                is_from_below_ = axis[0] == '+';
            }
        }
        if (!has_x || !has_y) throw Error(std::string(kBroken) + " (its size names one axis twice)");
    }

    /// Reads a scanline, in one of the two codings.
    void read_line(std::vector<Rgbe>& line) {
        constexpr std::size_t kMinLength = 8, kMaxLength = 0x7fff;  // length of scanlines with run lengths per channel
        Rgbe first;
        for (std::uint8_t& byte : first) byte = bytes_.next_or_throw();
        const bool has_channel_runs =
            line.size() >= kMinLength && line.size() <= kMaxLength && first[0] == 2 && first[1] == 2 && first[2] < 128;
        if (!has_channel_runs) return read_old_coding(line, first);
        if (std::size_t{256} * first[2] + first[3] != line.size())
            throw Error(std::string(kBroken) + " (a line has another length than the picture)");
        for (std::size_t channel = 0; channel < 4; ++channel) read_channel_runs(line, channel);
    }

    /// Reads one channel of a scanline as run lengths: a code above 128 repeats a byte, any other one copies bytes.
    void read_channel_runs(std::vector<Rgbe>& line, std::size_t channel) {
        for (std::size_t i = 0; i < line.size();) {
            const std::uint8_t code = bytes_.next_or_throw();
            const bool is_run = code > 128;
            const std::size_t count = is_run ? code & 127u : code;
            if (count > line.size() - i) throw Error(std::string(kBroken) + " (a run is longer than its line)");
            const std::uint8_t repeated = is_run ? bytes_.next_or_throw() : std::uint8_t{0};
            for (const std::size_t end = i + count; i < end; ++i)
                line[i][channel] = is_run ? repeated : bytes_.next_or_throw();
        }
    }

    /// Reads the older coding, pixel by pixel. A pixel with the mantissas 1, 1 and 1 repeats the one before it, as
    /// often as its exponent says; the next such pixel in a row counts 256 times as much.
    void read_old_coding(std::vector<Rgbe>& line, Rgbe next) {
        std::uint64_t repeat_unit = 1;
        for (std::size_t i = 0;;) {
            if (next[0] == 1 && next[1] == 1 && next[2] == 1) {
                const std::uint64_t count = repeat_unit * next[3];
                if (i == 0 || count > line.size() - i)
                    throw Error(std::string(kBroken) + " (a run is longer than its line)");
                std::fill_n(line.begin() + static_cast<std::ptrdiff_t>(i), count, line[i - 1]);
                i += count;
                repeat_unit = std::min<std::uint64_t>(256 * repeat_unit, std::uint64_t{1} << 40);
            } else {
                line[i++] = next;
                repeat_unit = 1;
            }
            if (i == line.size()) return;
            for (std::uint8_t& byte : next) byte = bytes_.next_or_throw();
        }
    }

    /// Value of a mantissa: (mantissa / 256) 2^(exponent - 128); 0 for exponent 0.
    static float value_of(std::uint8_t mantissa, std::uint8_t exponent) {
        return exponent == 0 ? 0.0f : std::ldexp(static_cast<float>(mantissa), exponent - 136);
    }

    static constexpr std::int64_t kMaxSize = 1 << 24;

    Bytes bytes_;
    bool is_xyz_ = false;  ///< true for X, Y and Z, false for red, green and blue
    bool is_by_columns_ = false, is_from_right_ = false, is_from_below_ = false;  ///< order of the pixels
    std::array<double, 3> scale_{1, 1, 1};  ///< factors of the channels, from EXPOSURE and COLORCORR
    std::optional<Chromaticities> chromaticities_;
};

}  // namespace

std::unique_ptr<OpenPicture> open_radiance(const std::string& path, std::span<const std::uint8_t> bytes) {
    return std::make_unique<RadiancePicture>(path, bytes);
}

}  // namespace realcam::image_io
