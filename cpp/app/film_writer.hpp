#pragma once
#include <string>
#include <vector>

#include "../keep_going.hpp"

namespace realcam::app {

/// Encodes videos from picture files: PyAV, in Python.
class FilmWriter {
public:
    virtual ~FilmWriter() = default;

    /// Throws Error if the video could not be written. Called before the work, not after it.
    virtual void check(const std::string& film) const = 0;

    /// Encodes 8-bit picture files as a video, completely or not at all. Throws Error and Cancelled.
    virtual void write(const std::string& film, const std::vector<std::string>& pictures, double frames_per_second,
                       const KeepGoing& keep_going) const = 0;
};

}  // namespace realcam::app
