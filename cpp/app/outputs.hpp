#pragma once
#include <string>
#include <vector>

#include "../checkpoint.hpp"
#include "../shot/shot_request.hpp"

namespace realcam::app {

/// Encoder of videos from picture files. The Python package implements it with PyAV; the executable has none.
class VideoWriter {
public:
    virtual ~VideoWriter() = default;

    /// Throws Error if the video file `video` could not be written. Called before the first frame is rendered.
    virtual void check(const std::string& video) const = 0;

    /// Encodes 8-bit picture files, in their order, as the video file `video`, completely or not at all. Throws Error,
    /// and Cancelled if `keep_going` returns false.
    virtual void write(const std::string& video, const std::vector<std::string>& pictures, double frames_per_second,
                       const KeepGoing& keep_going) const = 0;
};

/// Output files of a command that takes pictures: single pictures, numbered frames, or videos (.mp4). The frames of
/// "film.mp4" are pictures in the folder "film.mp4.frames" until the video is complete, so that an interrupted command
/// resumes with the missing frames.
class OutputFiles {
public:
    /// `writer`: null if this program writes pictures only; the pointer is kept.
    OutputFiles(const std::vector<std::string>& outputs, const VideoWriter* writer);

    /// Throws Error if an output cannot be written. `frames`: empty for a single picture.
    void check(const std::vector<int>& frames) const;

    /// Creates the frame folders of the videos. Throws ImageFileError.
    void create_frame_folders() const;

    /// All picture and video files of these frames.
    std::vector<std::string> all_files(const std::vector<int>& frames) const;

    /// The picture files of a frame.
    std::vector<std::string> files_of(int frame) const;

    /// Encodes the videos from their frames, removes the frames, and returns the video files. Throws Error and
    /// Cancelled.
    std::vector<std::string> encode_videos(const std::vector<int>& frames, double frames_per_second,
                                           const KeepGoing& keep_going) const;

private:
    std::vector<std::string> pictures_, videos_;  ///< the outputs as specified: names of frames still hold their ####
    const VideoWriter* writer_;
};

/// True if an output is a video (see outputs.hpp), not a picture.
bool is_video(const std::string& output);

/// Throws ImageFileError if one of the pictures could not be written, and InputError if two outputs are the same file.
/// Called before rendering.
void check_outputs(const std::vector<std::string>& outputs);

/// Digest of a picture's settings, 16 hexadecimal digits, for the metadata entry "realcam:film" of a frame: a later run
/// takes a frame again if its digest differs. Covers the settings of the
/// request, the posed but not yet metered camera, the contents of all recorded inputs, and `further_settings`. Throws
/// FileError.
std::string settings_digest(const shot::ShotRequest& request, const Camera& camera,
                            const std::string& further_settings);

/// Parses the frame numbers that a user specifies: "7", "1-240" or "1-240x10". Throws InputError.
std::vector<int> frame_numbers(const std::string& text);

/// File name of a frame: the number replaces the last "####" in the file's name, zero-padded to as many digits as there
/// are #. Without a #, it is inserted before the suffix, with four digits.
std::string frame_file(const std::string& output, int number);

}  // namespace realcam::app
