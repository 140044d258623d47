#pragma once
#include "shot_table.hpp"

namespace realcam::shot {

/// Reads the values of a table that are one word, as the command line has them. `shot`: the same table, for messages.
/// Throws InputError.
void read_words(toml::table& table, const ShotTable& shot);

}  // namespace realcam::shot
