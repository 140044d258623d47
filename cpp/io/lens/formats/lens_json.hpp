#pragma once
#include <string>
#include <string_view>

#include "../../text/json.hpp"

namespace realcam::io {

/// Base of the JSON readers of lenses: access to required members, and error messages with file and surface.
class LensJson {
public:
    /// Parses the text. Throws LensFileError, with the line, for invalid JSON, and Cancelled.
    LensJson(std::string_view text, std::string file, const KeepGoing& keep_going);

    const Json& root() const { return root_; }
    const std::string& file() const { return file_; }
    void set_surface(int surface) { surface_ = surface; }
    [[noreturn]] void fail(const std::string& message) const;
    [[noreturn]] void fail(const InputError& cause) const;

    /// Returns a finite number; otherwise fails with a message that begins with `what`.
    double number(const Json& value, const std::string& what) const;
    /// Returns a finite number, or `otherwise` if it is absent or null.
    double number_or(const Json& value, const std::string& what, double otherwise) const;

private:
    std::string file_;
    Json root_;
    int surface_ = 0;
};

}  // namespace realcam::io
