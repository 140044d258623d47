#pragma once
#include "shot_table.hpp"

namespace realcam::shot {

/// Parses the values of a table that are single words, as on the command line. `shot`: the same table, for messages.
/// Throws InputError.
void read_words(toml::table& table, const ShotTable& shot);

}  // namespace realcam::shot
