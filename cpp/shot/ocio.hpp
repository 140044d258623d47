#pragma once
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "../io/scene/decoded_image.hpp"
#include "../render/film/view.hpp"

namespace realcam::shot {

/// Colour management of a shot by a configuration of OpenColorIO.
struct OcioRequest {
    /// File, or the name of a built-in configuration, which begins with kBuiltInConfig; empty: there is none.
    std::string config;
    std::string display, view;  ///< empty: the configuration's default
    /// Colour spaces of input pictures, or kFileRules; empty: as the files state.
    std::string environment_color_space, texture_color_space;
};

/// Beginning of the names of OpenColorIO's built-in configurations.
inline constexpr std::string_view kBuiltInConfig = "ocio://";

/// Colour space of an input picture that stands for the configuration's rule for its file name.
inline constexpr std::string_view kFileRules = "file_rules";

/// Open configuration. Its functions throw InputError.
class OcioConfig {
public:
    virtual ~OcioConfig() = default;

    /// Returns a view; empty names stand for the defaults.
    virtual std::shared_ptr<const View> view(const std::string& display, const std::string& view) const = 0;

    /// Returns the conversion of a picture from a colour space, or from that of the configuration's rule for the file
    /// `path` (kFileRules).
    virtual io::ColorConversion to_rec709(const std::string& color_space, const std::string& path) const = 0;
};

/// Opens a configuration. Throws InputError.
using OcioReader = std::function<std::shared_ptr<const OcioConfig>(const std::string& config)>;

/// The function of the Python package, which has OpenColorIO; empty in the executable.
OcioReader& ocio_reader();

}  // namespace realcam::shot
