#pragma once
#include <stdexcept>
#include <string>

namespace realcam {

/// Base class of all errors of realcam. The message is one line for the user: what is wrong, where, and what is
/// expected.
class Error : public std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Invalid value from the caller.
class InputError : public Error {
    using Error::Error;
};

/// Lens prescription that cannot be built, or lens file that cannot be read.
class LensFileError : public Error {
public:
    /// `line` and `surface` are 1-based, and 0 if they do not apply.
    LensFileError(const std::string& message, std::string file = {}, int line = 0, int surface = 0);

    std::string detail;  ///< the message without file, line and surface
    std::string file;
    int line;
    int surface;

private:
    static std::string location(const std::string& file, int line, int surface);
};

/// Scene that cannot be read, or that contains no geometry.
class SceneFileError : public Error {
    using Error::Error;
};

/// Picture that cannot be read or written.
class ImageFileError : public Error {
    using Error::Error;
};

/// The caller stopped a long task.
class Cancelled : public Error {
public:
    Cancelled() : Error("stopped") {}
};

/// Failure of a device or of its library.
class DeviceError : public Error {
    using Error::Error;
};

/// The system has no more threads to give, or no memory for their stacks.
class NoThread : public DeviceError {
public:
    NoThread() : DeviceError("the system starts no thread; allow more memory (ulimit -v) or threads (ulimit -u)") {}
};

}  // namespace realcam
