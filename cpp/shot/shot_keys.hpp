#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "shot_request.hpp"

namespace realcam::shot {

class ShotTable;

/// How the value of a key is written where it is one word, as on the command line.
enum class Syntax {
    text,
    number,             ///< 0.5, 1/125
    number_or_auto,
    distance_or_auto,   ///< also inf
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
    const char* option;  ///< null where the command line has none
    const char* group;   ///< the heading of the option in help texts
    const char* placeholder;  ///< of its value there, which names the unit
    Syntax syntax;
    const char* wanted;  ///< values, as messages name them
    std::string text;    ///< what it says
    const char* initial;  ///< what holds where it is left out, in words
    std::vector<std::string_view> replaces;  ///< keys that say the same in another way, or of something else
    void (*read)(const ShotTable&, const ShotKey&, ShotRequest&);  ///< called where the table has the key
};

/// In the order in which they are read and listed.
std::span<const ShotKey> shot_keys();

}  // namespace realcam::shot
