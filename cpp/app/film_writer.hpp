#pragma once
#include <string>
#include <vector>

#include "../keep_going.hpp"

namespace realcam::app {

/// What makes films of pictures: PyAV, in Python.
class FilmWriter {
public:
    virtual ~FilmWriter() = default;

    /// Throws Error where the film could not be written: before the work, not after it.
    virtual void check(const std::string& film) const = 0;

    /// Writes the film of pictures of 8 bits in files, as a whole or not at all. Throws Error, and Cancelled.
    virtual void write(const std::string& film, const std::vector<std::string>& pictures, double frames_per_second,
                       const KeepGoing& keep_going) const = 0;
};

}  // namespace realcam::app
