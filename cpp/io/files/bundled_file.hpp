#pragma once
#include <string_view>

namespace realcam::io {

/// A file of the repository as it was when the library was built.
struct BundledFile {
    std::string_view name;  ///< of the file, without its suffix: "double-gauss-50mm"
    std::string_view text;
};

}  // namespace realcam::io
