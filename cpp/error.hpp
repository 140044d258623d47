#pragma once
#include <stdexcept>
#include <string>

namespace realcam {

/// Base of all errors that realcam raises. The message is one line for a person: what, where, and what is wanted.
class Error : public std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// A value that the caller gave does not make sense.
class InputError : public Error {
    using Error::Error;
};

/// A lens prescription that cannot be built, or its file cannot be read.
class LensFileError : public Error {
public:
    /// line and surface are 1-based; 0 where they do not apply.
    LensFileError(const std::string& message, std::string file = {}, int line = 0, int surface = 0);

    std::string detail;  ///< the message without its place
    std::string file;
    int line;
    int surface;

private:
    static std::string place(const std::string& file, int line, int surface);
};

/// A scene that cannot be read, or that holds no geometry.
class SceneFileError : public Error {
    using Error::Error;
};

/// A picture that cannot be read or written.
class ImageFileError : public Error {
    using Error::Error;
};

/// The caller asked long work to stop.
class Cancelled : public Error {
public:
    Cancelled() : Error("stopped") {}
};

/// A device or its library that fails.
class DeviceError : public Error {
    using Error::Error;
};

/// The system has no more threads to give, or no memory for their stacks.
class NoThread : public DeviceError {
public:
    NoThread()
        : DeviceError("the system starts no thread; more memory (ulimit -v) or threads (ulimit -u) are wanted") {}
};

}  // namespace realcam
