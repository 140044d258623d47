#pragma once
#include <string>
#include <vector>

#include "film_writer.hpp"

namespace realcam::app {

/// Outputs of a command that takes pictures: numbered frames, or videos (.mp4). The frames of "film.mp4" are pictures
/// in the folder "film.mp4.frames" until the video is complete, so that an interrupted command resumes with the missing
/// frames.
class FilmOutputs {
public:
    /// `writer`: null if this program writes pictures only; the pointer is kept.
    FilmOutputs(const std::vector<std::string>& outputs, const FilmWriter* writer);

    /// Throws Error if an output cannot be written. `frames`: empty for a single picture.
    void check(const std::vector<int>& frames) const;

    /// Creates the frame folders of the videos. Throws ImageFileError.
    void begin() const;

    /// All picture and video files of these frames.
    std::vector<std::string> all_files(const std::vector<int>& frames) const;

    /// The picture files of a frame.
    std::vector<std::string> files_of(int frame) const;

    /// Encodes the videos from their frames, removes the frames, and returns the video files. Throws Error and
    /// Cancelled.
    std::vector<std::string> finish(const std::vector<int>& frames, double frames_per_second,
                                    const KeepGoing& keep_going) const;

private:
    std::vector<std::string> pictures_, films_;
    const FilmWriter* writer_;
};

}  // namespace realcam::app
