#include "picture_readers.hpp"

#include "../bindings.hpp"
#if REALCAM_HAS_PICTURES
#include "../../image_io/image_file.hpp"
#endif

namespace realcam::bindings {

shot::PictureReaders picture_readers() {
#if REALCAM_HAS_PICTURES
    return {[](const std::string& path, std::span<const std::uint8_t> bytes) {
                return image_io::read_image(path, bytes, heed_signals);
            },
            [](const std::string& path, const std::string& layer, const io::ColorConversion& to_rec709,
               const image_io::WarnOf& warn) {
                return image_io::read_environment(path, layer, warn, heed_signals, to_rec709);
            }};
#else
    const auto refuse = [] { throw ImageFileError("this build of realcam cannot read image files"); };
    return {[refuse](const std::string&, std::span<const std::uint8_t>) -> std::optional<io::DecodedImage> {
                refuse();
                return std::nullopt;
            },
            [refuse](const std::string&, const std::string&, const io::ColorConversion&,
                     const std::function<void(const std::string&)>&) -> Environment {
                refuse();
                return {};
            }};
#endif
}

}  // namespace realcam::bindings
