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
    std::string file;    ///< path or name of the lens file; empty if unknown
    int line;            ///< 1-based line of the file; 0 if unknown
    int surface;         ///< 1-based surface of the lens; 0 if unknown

private:
    /// Returns the beginning of the message: "file:line: surface 3: ", with the parts that are known.
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

/// A long task was stopped by its caller (KeepGoing).
class Cancelled : public Error {
public:
    Cancelled() : Error("stopped") {}
};

/// Failure of a CPU or GPU backend, or of the library that it uses.
class DeviceError : public Error {
    using Error::Error;
};

/// A thread could not be started: the system's limit of threads is reached, or there is no memory for another stack.
class NoThread : public DeviceError {
public:
    NoThread()
        : DeviceError("the system could not start a thread; allow more memory (ulimit -v) or threads (ulimit -u)") {}
};

}  // namespace realcam
