// OpenImageIO's C++ library.

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cerrno>

#include "../image_io/open_picture.hpp"
#include "../image_io/openimageio.hpp"

namespace realcam::image_io {
namespace {

using OIIO::ImageInput;
using OIIO::ImageOutput;
using OIIO::ImageSpec;
using OIIO::TypeDesc;

class LibraryDecoder final : public PictureDecoder {
public:
    LibraryDecoder(const std::string& format, const std::string& path, std::span<const std::uint8_t> bytes) {
        ImageSpec wishes, spec;
        wishes.attribute("oiio:UnassociatedAlpha", 1);
        if (path.empty()) {
            memory_ = std::make_unique<OIIO::Filesystem::IOMemReader>(bytes.data(), bytes.size());
            OIIO::Filesystem::IOProxy* proxy = memory_.get();
            wishes.attribute("oiio:ioproxy", TypeDesc::PTR, &proxy);
        }
        input_ = ImageInput::create(format);
        if (!input_) throw Error("OpenImageIO cannot read " + format + reason(OIIO::geterror()));
        if (!input_->open(path.empty() ? "memory." + format : path, spec, wishes))
            throw Error(kBroken + reason(input_->geterror()));
        // The headers of further parts may be broken: the decoder says so where one of them is read.
        const int most = format == "openexr" ? kMostParts : 1;  // WebP cannot go back
        opening_ = input_->geterror();
        for (int part = 0; part < most && input_->seek_subimage(part, 0); ++part)
            parts.push_back(header_of(input_->spec()));
        if (parts.empty()) throw Error(kBroken + reason(opening_ + input_->geterror()));
        input_->geterror();  // that there is no further part
    }

    Outcome read(const EncodedRegion& region, std::uint8_t* pixels) override {
        return read(region, TypeDesc::UINT8, pixels);
    }
    Outcome read(const EncodedRegion& region, float* pixels) override { return read(region, TypeDesc::FLOAT, pixels); }

private:
    static EncodedHeader header_of(const ImageSpec& s) {
        EncodedHeader header;
        header.x = s.x, header.y = s.y, header.width = s.width, header.height = s.height, header.depth = s.depth;
        header.full_x = s.full_x, header.full_y = s.full_y;
        header.full_width = s.full_width, header.full_height = s.full_height;
        header.part_name = s.get_string_attribute("oiio:subimagename");
        for (int c = 0; c < s.nchannels; ++c)
            header.channel_names.push_back({std::string(s.channel_name(c)), s.channelformat(c) == TypeDesc::UINT32});
        header.bytes_per_value = static_cast<int>(s.format.size());
        header.tile_height = s.tile_width > 0 ? s.tile_height : 0;
        header.is_floating_point = s.format.is_floating_point();
        header.is_deep = s.deep;
        std::array<float, 8> colours{};
        if (s.getattribute("chromaticities", TypeDesc(TypeDesc::FLOAT, 8), colours.data()))
            header.chromaticities = colours;
        header.texture_format = s.get_string_attribute("textureformat");
        for (const OIIO::ParamValue& entry : s.extra_attribs) {
            const std::string name = entry.name().string();
            if (name.starts_with("realcam:")) header.entries.emplace_back(name, entry.get_string());
        }
        return header;
    }

    Outcome read(const EncodedRegion& r, TypeDesc type, void* pixels) {
        const EncodedHeader& s = parts[static_cast<std::size_t>(r.part)];
        const int top = s.y + r.first_row, below = s.y + r.end_row;
        const bool good = s.tile_height > 0 ? input_->read_tiles(r.part, 0, s.x, s.x + s.width, top, below, 0, 1,
                                                                 r.first_channel, r.end_channel, type, pixels)
                                            : input_->read_scanlines(r.part, 0, top, below, 0, r.first_channel,
                                                                     r.end_channel, type, pixels);
        return {good, opening_ + input_->geterror()};
    }

    std::unique_ptr<OIIO::Filesystem::IOMemReader> memory_;  // outlives the input
    std::unique_ptr<ImageInput> input_;
    std::string opening_;  ///< message about the header of a broken file that was opened all the same
};

/// Encoders that notice a failed write print lines of their own, or let it pass: the file remembers it instead.
class FileProxy final : public OIIO::Filesystem::IOFile {
public:
    explicit FileProxy(UnfinishedFile& file) : IOFile(file.stream(), Write), file_(file) {}

    std::size_t write(const void* data, std::size_t size) override {
        errno = 0;
        if (IOFile::write(data, size) != size) file_.remember_failure(errno);
        return size;
    }

private:
    UnfinishedFile& file_;
};

class LibraryEncoder final : public PictureEncoder {
public:
    LibraryEncoder(const EncodedPicture& picture, UnfinishedFile& file) : proxy_(file) {
        const auto& channels = picture.channels;
        ImageSpec spec(picture.width, picture.height, channels.empty() ? 3 : static_cast<int>(channels.size()),
                       channels.empty() ? TypeDesc::UINT8 : TypeDesc::FLOAT);
        if (!channels.empty()) spec.channelnames.clear();
        for (const EncodedPicture::Channel& channel : channels) {
            if (channel.name == "Z") spec.z_channel = static_cast<int>(spec.channelnames.size());
            spec.channelnames.push_back(channel.name);
            spec.channelformats.push_back(channel.is_number ? TypeDesc::UINT32 : TypeDesc::FLOAT);
        }
        const bool is_mixed = std::ranges::any_of(channels, &EncodedPicture::Channel::is_number);
        if (!is_mixed) spec.channelformats.clear();
        // Channels of several types are handed over as the file has them.
        type_ = is_mixed ? TypeDesc() : spec.format;
        for (const auto& [name, value] : picture.attributes) {
            if (const auto* text = std::get_if<std::string>(&value)) spec.attribute(name, *text);
            if (const auto* number = std::get_if<float>(&value)) spec.attribute(name, *number);
            if (const auto* pair = std::get_if<std::array<float, 2>>(&value))
                spec.attribute(name, TypeDesc(TypeDesc::FLOAT, TypeDesc::VEC2), pair->data());
        }
        output_ = ImageOutput::create(picture.format);
        if (!output_) throw Error("OpenImageIO cannot write ." + picture.format + ": " + first_line(OIIO::geterror()));
        output_->set_ioproxy(&proxy_);
        if (!output_->open("picture." + picture.format, spec)) throw Error(first_line(output_->geterror()));
    }

    Outcome write(int first, int end, const void* pixels) override {
        const bool good = output_->write_scanlines(first, end, 0, type_, pixels);
        return {good, output_->geterror()};
    }
    Outcome close() override {
        const bool good = output_->close();
        return {good, output_->geterror()};
    }

private:
    FileProxy proxy_;  // outlives the output
    TypeDesc type_;
    std::unique_ptr<ImageOutput> output_;
};

}  // namespace

std::unique_ptr<PictureDecoder> open_decoder(const std::string& format, const std::string& path,
                                             std::span<const std::uint8_t> bytes) {
    return std::make_unique<LibraryDecoder>(format, path, bytes);
}

std::unique_ptr<PictureEncoder> open_encoder(const EncodedPicture& picture, UnfinishedFile& file) {
    return std::make_unique<LibraryEncoder>(picture, file);
}

}  // namespace realcam::image_io
