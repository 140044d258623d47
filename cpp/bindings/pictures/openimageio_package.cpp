// Decoding and encoding of image files by OpenImageIO's Python package, which is called through
// realcam.openimageio_package. Implements the functions of image_io/openimageio.hpp for the extension module.

#include <fcntl.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "../../image_io/open_picture.hpp"
#include "../../image_io/openimageio.hpp"
#include "../bindings.hpp"

namespace realcam::image_io {
namespace {

namespace py = pybind11;
using namespace py::literals;

/// Open file descriptor. The package opens it by a name in /dev/fd, because the file's own name need not be UTF-8, and
/// a file in memory has none.
class Descriptor {
public:
    explicit Descriptor(int number) : number_(number) {
        if (number_ < 0) throw Error(std::strerror(errno));
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    ~Descriptor() { close(number_); }

    int number() const { return number_; }
    std::string name() const { return "/dev/fd/" + std::to_string(number_); }

private:
    int number_;
};

/// Returns a descriptor of a new, empty file in memory; -1 with errno set if that fails.
int memory_file() {
    return memfd_create("realcam", MFD_CLOEXEC);
}

/// Returns false, with errno set, if a write fails.
bool write_all(int descriptor, const char* data, std::size_t size) {
    while (size > 0) {
        const ssize_t written = write(descriptor, data, size);
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) return false;
        data += written;
        size -= static_cast<std::size_t>(written);
    }
    return true;
}

/// Object of the Python module. The constructor and the destructor acquire the GIL; callers must not hold it.
class PackageObject {
public:
    /// Calls the class `type` of the module with these arguments. Throws Error if the file cannot be opened or is
    /// broken.
    template <class... Arguments>
    explicit PackageObject(const char* type, const Arguments&... arguments) {
        const py::gil_scoped_acquire acquire;
        try {
            object_ = py::module_::import("realcam.openimageio_package").attr(type)(arguments...);
        } catch (py::error_already_set& error) {
            const auto message = [&] { return py::str(error.value()).cast<std::string>(); };
            if (error.matches(PyExc_ValueError)) throw Error(kBroken + reason(message()));
            if (error.matches(PyExc_OSError) || error.matches(PyExc_ImportError)) throw Error(first_line(message()));
            throw;
        }
    }
    PackageObject(const PackageObject&) = delete;
    PackageObject& operator=(const PackageObject&) = delete;
    ~PackageObject() {
        const py::gil_scoped_acquire acquire;
        object_ = py::object();
    }

    /// Returns an attribute of the object. Requires the GIL.
    py::object attr(const char* name) const { return object_.attr(name); }

private:
    py::object object_;
};

class PackageDecoder final : public PictureDecoder {
public:
    PackageDecoder(const std::string& format, const std::string& path, std::span<const std::uint8_t> bytes)
        : file_(path.empty() ? memory_file() : open(path.c_str(), O_RDONLY | O_CLOEXEC)),
          decoder_("Decoder", format, file_name(bytes)) {
        const py::gil_scoped_acquire acquire;
        for (const py::handle header : decoder_.attr("headers")) parts.push_back(header_of(header.cast<py::dict>()));
    }

    Outcome read(const EncodedRegion& region, std::uint8_t* pixels) override {
        return read_as(region, "uint8", pixels);
    }
    Outcome read(const EncodedRegion& region, float* pixels) override { return read_as(region, "float", pixels); }

private:
    /// Converts a header of the Python module.
    static EncodedHeader header_of(const py::dict& dict) {
        EncodedHeader header;
        const auto number = [&](const char* name) { return dict[name].cast<int>(); };
        header.x = number("x"), header.y = number("y");
        header.width = number("width"), header.height = number("height"), header.depth = number("depth");
        header.full_x = number("full_x"), header.full_y = number("full_y");
        header.full_width = number("full_width"), header.full_height = number("full_height");
        header.part_name = dict["part_name"].cast<std::string>();
        for (const auto& [name, is_number] : dict["channels"].cast<std::vector<std::pair<std::string, bool>>>())
            header.channel_names.push_back({name, is_number});
        header.bytes_per_value = number("bytes_per_value");
        header.tile_height = number("tile_height");
        header.is_floating_point = dict["is_floating_point"].cast<bool>();
        header.is_deep = dict["deep"].cast<bool>();
        header.chromaticities = dict["chromaticities"].cast<std::optional<std::array<float, 8>>>();
        header.texture_format = dict["textureformat"].cast<std::string>();
        header.entries = dict["entries"].cast<decltype(header.entries)>();
        return header;
    }

    /// Writes the bytes, if there are any, to the file in memory, and returns the name under which to open the file.
    std::string file_name(std::span<const std::uint8_t> bytes) const {
        if (!write_all(file_.number(), reinterpret_cast<const char*>(bytes.data()), bytes.size()))
            throw Error(std::strerror(errno));
        return file_.name();
    }

    template <class Value>
    Outcome read_as(const EncodedRegion& r, const char* type, Value* pixels) {
        const py::gil_scoped_acquire acquire;
        const auto [rows, message] =
            decoder_.attr("read")(r.part, r.first_row, r.end_row, r.first_channel, r.end_channel, type)
                .cast<std::pair<py::object, std::string>>();
        if (rows.is_none()) return {false, message};
        const auto values = rows.cast<py::array_t<Value, py::array::c_style>>();
        const auto expected_size = py::ssize_t{r.end_row - r.first_row} *
                                   parts[static_cast<std::size_t>(r.part)].width * (r.end_channel - r.first_channel);
        if (values.size() != expected_size) return {false, message};
        std::memcpy(pixels, values.data(), static_cast<std::size_t>(expected_size) * sizeof(Value));
        return {true, message};
    }

    Descriptor file_;
    PackageObject decoder_;
};

/// Encodes the file in memory and then copies it, because the package does not report a full disk.
class PackageEncoder final : public PictureEncoder {
public:
    PackageEncoder(const EncodedPicture& picture, UnfinishedFile& file)
        : file_(file),
          memory_(memory_file()),
          row_bytes_(static_cast<std::size_t>(picture.width) *
                     (picture.channels.empty() ? 3 : 4 * picture.channels.size())),
          encoder_("Encoder", picture.format, memory_.name(), picture.width, picture.height, channels_of(picture),
                   picture.attributes) {}

    Outcome write(int first, int end, const void* pixels) override {
        if (is_full_) return {true, ""};  // after an error OpenEXR would block for ever in further writes
        const py::gil_scoped_acquire acquire;
        const auto size = static_cast<py::ssize_t>(static_cast<std::size_t>(end - first) * row_bytes_);
        return outcome_of(encoder_.attr("write")(first, end, py::memoryview::from_memory(pixels, size)));
    }

    Outcome close() override {
        if (is_full_) return {true, ""};
        Outcome outcome;
        {
            const py::gil_scoped_acquire acquire;
            outcome = outcome_of(encoder_.attr("close")());
        }
        if (outcome.is_good && outcome.said.empty() && !is_full_) copy();
        return outcome;
    }

private:
    static std::vector<std::pair<std::string, bool>> channels_of(const EncodedPicture& picture) {
        std::vector<std::pair<std::string, bool>> channels;
        for (const EncodedPicture::Channel& channel : picture.channels)
            channels.emplace_back(channel.name, channel.is_number);
        return channels;
    }

    /// Converts the result of a call, a pair (success, message). If the file in memory has reached the process's limit
    /// on file sizes, the failure is left to the UnfinishedFile, which reports it like a full disk, and the call
    /// succeeds.
    Outcome outcome_of(const py::object& result) {
        const auto [good, message] = result.cast<std::pair<bool, std::string>>();
        struct stat status{};
        struct rlimit limit{};
        if ((!good || !message.empty()) && fstat(memory_.number(), &status) == 0 &&
            getrlimit(RLIMIT_FSIZE, &limit) == 0 && static_cast<rlim_t>(status.st_size) >= limit.rlim_cur) {
            file_.remember_failure(EFBIG);
            is_full_ = true;
            return {true, ""};
        }
        return {good, message};
    }

    /// Copies the file in memory to the UnfinishedFile, which remembers a failure.
    void copy() {
        std::vector<char> part(1 << 20);
        for (off_t offset = 0;;) {
            const ssize_t read = pread(memory_.number(), part.data(), part.size(), offset);
            if (read < 0 && errno == EINTR) continue;
            if (read == 0) return;
            if (read < 0 || !write_all(fileno(file_.stream()), part.data(), static_cast<std::size_t>(read)))
                return file_.remember_failure(errno);
            offset += read;
        }
    }

    UnfinishedFile& file_;
    Descriptor memory_;
    std::size_t row_bytes_;
    bool is_full_ = false;  ///< true after the limit on file sizes was reached
    PackageObject encoder_;
};

}  // namespace

std::unique_ptr<PictureDecoder> open_decoder(const std::string& format, const std::string& path,
                                             std::span<const std::uint8_t> bytes) {
    return std::make_unique<PackageDecoder>(format, path, bytes);
}

std::unique_ptr<PictureEncoder> open_encoder(const EncodedPicture& picture, UnfinishedFile& file) {
    return std::make_unique<PackageEncoder>(picture, file);
}

}  // namespace realcam::image_io
