#pragma once
#include <string_view>

namespace realcam::io {

/// File of the repository that is compiled into the library.
struct BundledFile {
    std::string_view name;  ///< file name without its suffix: "double-gauss-50mm"
    std::string_view text;
};

}  // namespace realcam::io
