#pragma once
#include <string>
#include <vector>

#include "../shot/shot_request.hpp"

namespace realcam::app {

/// Whether an output is a film (see film_outputs.hpp), and no picture.
bool is_film(const std::string& output);

/// Throws ImageFileError where one of the pictures could not be written, and InputError where two outputs are the same
/// file: before the work, not after it.
void check_outputs(const std::vector<std::string>& outputs);

/// Digest of a picture's settings for the entry "realcam:film" of a frame: of the settings of a request, of the placed
/// but not yet metered camera, of the contents of all recorded inputs, and of `more`. Throws FileError.
std::string film_digest(const shot::ShotRequest& request, const Camera& camera, const std::string& more);

/// The numbers of frames that a user names: "7", "1-240" or "1-240x10". Throws InputError.
std::vector<int> frame_numbers(const std::string& text);

/// The file of a frame: the number stands in place of the last "####" in the file's name, with so many digits, or else,
/// with four, before its suffix.
std::string frame_file(const std::string& output, int number);

}  // namespace realcam::app
