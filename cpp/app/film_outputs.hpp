#pragma once
#include <string>
#include <vector>

#include "film_writer.hpp"

namespace realcam::app {

/// The outputs of a command that takes pictures: frames that are numbered, or films, .mp4. The frames of "film.mp4" are
/// pictures in the folder "film.mp4.frames" until the film is whole, so that a command that was stopped goes on where
/// it was.
class FilmOutputs {
public:
    /// writer: null in a program that writes pictures alone. Keeps the pointer.
    FilmOutputs(const std::vector<std::string>& outputs, const FilmWriter* writer);

    /// Throws Error where they cannot be written. frames: empty for a single picture.
    void check(const std::vector<int>& frames) const;

    /// Makes the folders of films. Throws ImageFileError.
    void begin() const;

    /// All pictures and films of these frames.
    std::vector<std::string> all_files(const std::vector<int>& frames) const;

    /// The pictures of a frame.
    std::vector<std::string> files_of(int frame) const;

    /// Makes the films of their frames, and removes these; the films. Throws Error, and Cancelled.
    std::vector<std::string> finish(const std::vector<int>& frames, double frames_per_second,
                                    const KeepGoing& keep_going) const;

private:
    std::vector<std::string> pictures_, films_;
    const FilmWriter* writer_;
};

}  // namespace realcam::app
