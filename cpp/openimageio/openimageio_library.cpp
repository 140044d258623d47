// Implementation of image_io/openimageio.hpp by OpenImageIO's C++ library, for the executable.

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

/// Decoder by OpenImageIO's ImageInput.
class LibraryDecoder final : public PictureDecoder {
public:
    LibraryDecoder(const std::string& format, const std::string& path, std::span<const std::uint8_t> bytes) {
        ImageSpec configuration, spec;
        configuration.attribute("oiio:UnassociatedAlpha", 1);
        if (path.empty()) {
            memory_ = std::make_unique<OIIO::Filesystem::IOMemReader>(bytes.data(), bytes.size());
            OIIO::Filesystem::IOProxy* proxy = memory_.get();
            configuration.attribute("oiio:ioproxy", TypeDesc::PTR, &proxy);
        }
        input_ = ImageInput::create(format);
        if (!input_) throw Error("OpenImageIO cannot read " + format + reason(OIIO::geterror()));
        if (!input_->open(path.empty() ? "memory." + format : path, spec, configuration))
            throw Error(kBroken + reason(input_->geterror()));
        // The headers of further parts may be broken; read() reports it if such a part is read.
        const int max_parts = format == "openexr" ? kMaxParts : 1;  // OpenImageIO cannot seek back in a WebP
        opening_message_ = input_->geterror();
        for (int part = 0; part < max_parts && input_->seek_subimage(part, 0); ++part)
            parts.push_back(header_of(input_->spec()));
        if (parts.empty()) throw Error(kBroken + reason(opening_message_ + input_->geterror()));
        input_->geterror();  // discards the message that there is no further part
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
        const int top = s.y + r.first_row, bottom = s.y + r.end_row;
        const bool succeeded = s.tile_height > 0 ? input_->read_tiles(r.part, 0, s.x, s.x + s.width, top, bottom, 0, 1,
                                                                      r.first_channel, r.end_channel, type, pixels)
                                                 : input_->read_scanlines(r.part, 0, top, bottom, 0, r.first_channel,
                                                                          r.end_channel, type, pixels);
        return {succeeded, opening_message_ + input_->geterror()};
    }

    std::unique_ptr<OIIO::Filesystem::IOMemReader> memory_;  // outlives the input
    std::unique_ptr<ImageInput> input_;
    std::string opening_message_;  ///< message about a broken header of a file that could be opened nevertheless
};

/// Stream for OpenImageIO's encoders that reports every write as successful and records failures in the file: encoders
/// that notice a failed write print messages of their own, or ignore it.
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

/// Encoder by OpenImageIO's ImageOutput.
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
        // Channels of several types are passed in the types of the file.
        type_ = is_mixed ? TypeDesc() : spec.format;
        for (const auto& [name, value] : picture.attributes) {
            if (const auto* text = std::get_if<std::string>(&value)) spec.attribute(name, *text);
            if (const auto* number = std::get_if<float>(&value)) spec.attribute(name, *number);
            if (const auto* pair = std::get_if<std::array<float, 2>>(&value))
                spec.attribute(name, TypeDesc(TypeDesc::FLOAT, TypeDesc::VEC2), pair->data());
            if (const auto* numbers = std::get_if<std::array<float, 8>>(&value))
                spec.attribute(name, TypeDesc(TypeDesc::FLOAT, 8), numbers->data());
        }
        output_ = ImageOutput::create(picture.format);
        if (!output_) throw Error("OpenImageIO cannot write ." + picture.format + ": " + first_line(OIIO::geterror()));
        output_->set_ioproxy(&proxy_);
        if (!output_->open("picture." + picture.format, spec)) throw Error(first_line(output_->geterror()));
    }

    Outcome write(int first, int end, const void* pixels) override {
        const bool succeeded = output_->write_scanlines(first, end, 0, type_, pixels);
        return {succeeded, output_->geterror()};
    }
    Outcome close() override {
        const bool succeeded = output_->close();
        return {succeeded, output_->geterror()};
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
