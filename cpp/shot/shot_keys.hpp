#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "shot_request.hpp"

namespace realcam::shot {

class ShotTable;

/// Syntax of a key's value if it is a single word, as on the command line.
enum class Syntax {
    text,
    number,             ///< 0.5, 1/125
    number_or_auto,
    distance_or_auto,   ///< a number, inf or auto
    whole,
    whole_or_auto,
    number_or_file,
    three_numbers,      ///< 0,1.5,-2
    two_numbers,        ///< 0,-3.5
    size,               ///< 36x24
    names,              ///< dispersion,ghosts
};

/// A setting of a shot: a key of shot files, a keyword of Python's Shot.load, and an option of the command line.
struct ShotKey {
    const char* name;
    const char* option;  ///< null if the command line has no such option
    const char* group;   ///< heading of the option in help texts
    const char* placeholder;  ///< for the option's value in help texts; names the unit
    Syntax syntax;
    const char* wanted;  ///< expected values, as messages name them
    std::string text;    ///< description in help texts
    const char* initial;  ///< default value, in words
    std::vector<std::string_view> replaces;  ///< keys that a change of this key removes
    void (*read)(const ShotTable&, const ShotKey&, ShotRequest&);  ///< called if the table has the key

    /// Description with the default value, as help texts show it.
    std::string help() const { return *initial ? text + " [" + initial + ']' : text; }
};

/// All keys, in the order in which they are read and listed.
std::span<const ShotKey> shot_keys();

}  // namespace realcam::shot
