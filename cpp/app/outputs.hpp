#pragma once
#include <string>
#include <vector>

#include "../shot/shot_request.hpp"

namespace realcam::app {

/// True if an output is a video (see film_outputs.hpp), not a picture.
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
