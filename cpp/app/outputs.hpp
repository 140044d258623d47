#pragma once
#include <string>
#include <vector>

namespace realcam::app {

/// Throws ImageFileError where one of the pictures could not be written, and InputError where two are the same file:
/// before the work, not after it.
void check_outputs(const std::vector<std::string>& outputs);

/// Throws InputError where a picture would take the place of a file that it is made from.
void check_apart(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs);

}  // namespace realcam::app
