#pragma once
#include <string>
#include <string_view>

#include "../../text/json.hpp"

namespace realcam::io {

/// What the JSON readers of lenses share: parts that have to be there, and complaints that name file and surface.
class LensJson {
public:
    /// Throws LensFileError, with the line, for what is no JSON, and Cancelled.
    LensJson(std::string_view text, std::string file, const KeepGoing& keep_going);

    const Json& root() const { return root_; }
    const std::string& file() const { return file_; }
    void set_surface(int surface) { surface_ = surface; }
    [[noreturn]] void fail(const std::string& message) const;
    [[noreturn]] void fail(const InputError& cause) const;

    /// A finite number, in millimetres or whatever. `what` begins the message.
    double number(const Json& value, const std::string& what) const;
    /// The same; `otherwise` where it is absent or null.
    double number_or(const Json& value, const std::string& what, double otherwise) const;

private:
    std::string file_;
    Json root_;
    int surface_ = 0;
};

}  // namespace realcam::io
