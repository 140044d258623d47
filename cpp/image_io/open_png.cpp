// Reader of PNG through libpng: if OpenImageIO calls it, libpng prints its errors and warnings on stderr.

#include <png.h>

#include <algorithm>
#include <csetjmp>
#include <cstring>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "open_picture.hpp"

namespace realcam::image_io {
namespace {

/// Opened PNG, whose header has been read.
class PngPicture final : public OpenPicture {
public:
    PngPicture(const std::string& path, std::span<const std::uint8_t> bytes) : bytes_(bytes) {
        if (!path.empty()) file_.open(path, std::ios::binary);
        png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, jump_on_error, ignore_warning);
        info_ = png_ ? png_create_info_struct(png_) : nullptr;
        if (!info_) throw std::bad_alloc();
        png_set_read_fn(png_, this, read_bytes);
        // Colour profiles and times are ignored: pixels are assumed to be sRGB. Compressed texts are not read.
        png_set_keep_unknown_chunks(png_, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
        png_set_keep_unknown_chunks(png_, PNG_HANDLE_CHUNK_AS_DEFAULT, reinterpret_cast<png_const_bytep>("tEXt"), 1);
        require(guarded([this] { read_header(); }));
        width = static_cast<int>(png_get_image_width(png_, info_));
        height = static_cast<int>(png_get_image_height(png_, info_));
        channels = png_get_channels(png_, info_);
        bytes_per_value_ = png_get_bit_depth(png_, info_) == 16 ? 2 : 1;
        is_wide = bytes_per_value_ == 2;
        png_textp texts = nullptr;
        const int count = png_get_text(png_, info_, &texts, nullptr);
        for (int i = 0; i < count; ++i)
            if (const std::string_view name = texts[i].key; name.starts_with("realcam:"))
                entries.emplace_back(name, std::string(texts[i].text, texts[i].text_length));
    }

    void read(int count, int stride, std::uint8_t* pixels, const KeepGoing& keep_going) override {
        read_as(count, stride, pixels, keep_going, [](int code, int max_code) {
            return static_cast<std::uint8_t>(max_code == 255 ? code : (code * 255 + max_code / 2) / max_code);
        });
    }
    void read(int count, int stride, float* pixels, const KeepGoing& keep_going) override {
        read_as(count, stride, pixels, keep_going,
                [](int code, int max_code) { return static_cast<float>(code) / static_cast<float>(max_code); });
    }

private:
    /// libpng's error handler: stores the message, and jumps to guarded().
    static void jump_on_error(png_structp png, png_const_charp message) {
        auto& self = *static_cast<PngPicture*>(png_get_error_ptr(png));
        std::strncpy(self.error_, message, sizeof self.error_ - 1);
        std::longjmp(self.after_error_, 1);
    }
    static void ignore_warning(png_structp, png_const_charp) {}

    /// libpng's read function: copies the next encoded bytes from the file or from memory.
    static void read_bytes(png_structp png, png_bytep buffer, png_size_t count) {
        auto& self = *static_cast<PngPicture*>(png_get_io_ptr(png));
        if (self.file_.is_open()) {
            self.file_.read(reinterpret_cast<char*>(buffer), static_cast<std::streamsize>(count));
            if (static_cast<png_size_t>(self.file_.gcount()) != count) png_error(png, "it ends early");
            return;
        }
        if (self.bytes_.size() < count) png_error(png, "it ends early");
        std::memcpy(buffer, self.bytes_.data(), count);
        self.bytes_ = self.bytes_.subspan(count);
    }

    /// Runs `work`, which calls libpng. Returns false if libpng reported an error by longjmp, which skips destructors:
    /// `work` must not own resources.
    template <class Work>
    bool guarded(const Work& work) {
        if (setjmp(after_error_) != 0) return false;
        work();
        return true;
    }
    /// Throws Error with libpng's message unless `succeeded`.
    void require(bool succeeded) const {
        if (!succeeded) throw Error(std::string(kBroken) + " (" + error_ + ")");
    }

    void read_header() {
        png_read_info(png_, info_);
        png_set_expand(png_);  // expands palettes, fewer than 8 bits, and a transparent colour
        png_set_swap(png_);  // 16 bits in the machine's byte order
        passes_ = png_set_interlace_handling(png_);
        png_read_update_info(png_, info_);
    }

    /// Decodes the pixels in chunks of rows, and converts each value by convert(code, max_code). An interlaced picture
    /// is first assembled in memory.
    template <class Value, class Convert>
    void read_as(int count, int stride, Value* pixels, const KeepGoing& keep_going, Convert&& convert) {
        constexpr int kRows = 64;  // between two calls of keep_going
        const std::size_t row_bytes = png_get_rowbytes(png_, info_);
        const int buffered_rows = passes_ > 1 ? height : std::min(kRows, height);
        std::vector<std::uint8_t> rows(row_bytes * static_cast<std::size_t>(buffered_rows));
        for (int pass = 0; pass < passes_; ++pass)
            for (int y = 0; y < height; y += kRows) {
                check(keep_going);
                const int end = std::min(y + kRows, height);
                std::uint8_t* first = rows.data() + (passes_ > 1 ? row_bytes * static_cast<std::size_t>(y) : 0);
                require(guarded([&] {
                    for (int row = y; row < end; ++row)
                        png_read_row(png_, first + row_bytes * static_cast<std::size_t>(row - y), nullptr);
                }));
                if (pass + 1 < passes_) continue;
                for (int row = y; row < end; ++row)
                    convert_row(first + row_bytes * static_cast<std::size_t>(row - y), count, stride,
                                pixels + static_cast<std::size_t>(row) * static_cast<std::size_t>(width) *
                                             static_cast<std::size_t>(stride),
                                convert);
            }
    }

    /// Converts the first `count` channels of a decoded row.
    template <class Value, class Convert>
    void convert_row(const std::uint8_t* row, int count, int stride, Value* pixels, Convert&& convert) const {
        const int max_code = bytes_per_value_ == 2 ? 65535 : 255;
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < count; ++c) {
                const int i = x * channels + c;
                std::uint16_t wide_code = 0;
                if (bytes_per_value_ == 2) std::memcpy(&wide_code, row + 2 * i, sizeof wide_code);
                pixels[x * stride + c] = convert(bytes_per_value_ == 2 ? wide_code : row[i], max_code);
            }
    }

    std::span<const std::uint8_t> bytes_;  ///< encoded bytes not read yet, if there is no file
    std::ifstream file_;
    /// Owns libpng's structures, so that they are freed also if the constructor throws.
    struct Handles {
        png_structp png = nullptr;
        png_infop info = nullptr;
        ~Handles() { png_destroy_read_struct(&png, &info, nullptr); }
    } handles_;
    png_structp& png_ = handles_.png;
    png_infop& info_ = handles_.info;
    int passes_ = 1;  ///< number of interlacing passes
    int bytes_per_value_ = 1;
    std::jmp_buf after_error_;  ///< set by guarded()
    char error_[100] = "";  ///< libpng's last error message
};

}  // namespace

std::unique_ptr<OpenPicture> open_png(const std::string& path, std::span<const std::uint8_t> bytes) {
    return std::make_unique<PngPicture>(path, bytes);
}

}  // namespace realcam::image_io
