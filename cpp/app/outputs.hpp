#pragma once
#include <string>
#include <vector>

#include "../checkpoint.hpp"
#include "../shot/shot_request.hpp"

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

/// True if an output is a video (see outputs.hpp), not a picture.
bool is_film(const std::string& output);

/// Throws ImageFileError if one of the pictures could not be written, and InputError if two outputs are the same file.
/// Called before the work, not after it.
void check_outputs(const std::vector<std::string>& outputs);

/// Digest of a picture's settings, for the metadata entry "realcam:film" of a frame. Covers the settings of the
/// request, the posed but not yet metered camera, the contents of all recorded inputs, and `more`. Throws FileError.
std::string film_digest(const shot::ShotRequest& request, const Camera& camera, const std::string& more);

/// Parses the frame numbers that a user specifies: "7", "1-240" or "1-240x10". Throws InputError.
std::vector<int> frame_numbers(const std::string& text);

/// File name of a frame: the number replaces the last "####" in the file's name, zero-padded to as many digits as there
/// are #. Without a #, it is inserted before the suffix, with four digits.
std::string frame_file(const std::string& output, int number);

}  // namespace realcam::app
