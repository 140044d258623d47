#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "shot_request.hpp"

namespace realcam::shot {

class ShotTable;

/// Syntax of a key's value if it is written as one text, as on the command line. It also tells the value's type.
enum class Syntax {
    text,               ///< any text
    number,             ///< 0.5, 1/125
    number_or_auto,     ///< a number or "auto"
    distance_or_auto,   ///< a number, inf or auto
    whole,              ///< a whole number
    whole_or_auto,      ///< a whole number or "auto"
    number_or_file,     ///< a number, or else the name of a file
    three_numbers,      ///< 0,1.5,-2
    two_numbers,        ///< 0,-3.5
    size,               ///< 36x24
    names,              ///< dispersion,ghosts
    spectrum,           ///< a text, a number, or points; points have no such text, but the text may hold a table
};

/// Value of a setting of a picture, in the type that its syntax implies. std::monostate stands for "auto", or for no
/// value.
using SettingValue = std::variant<std::monostate, std::int64_t, double, std::string, std::vector<std::string>,
                                  std::vector<SpectrumPoint>>;

struct ShotKey;

/// Sets a value in a request. `shown`: the key's name in messages. Throws InputError if the value is invalid.
using SetSetting = void (*)(const ShotKey& key, const std::string& shown, PictureRequest& request,
                            const SettingValue& value);

/// A setting of a shot: a key of shot files, a keyword of Python's Shot.load, and an option of the command line. A
/// setting of a picture is also a keyword and an attribute of Python's RenderSettings.
struct ShotKey {
    const char* name;
    const char* option;  ///< null if the command line has no such option
    const char* group;   ///< heading of the option in help texts
    const char* placeholder;  ///< for the option's value in help texts; names the unit
    Syntax syntax;
    std::string wanted;  ///< noun phrase for the expected values, after "must be" in messages
    std::string text;    ///< description in help texts
    const char* initial;  ///< description of the default; empty: none
    std::vector<std::string_view> replaces;  ///< keys that a change of this key removes
    void (*read)(const ShotTable&, const ShotKey&,
                 ShotRequest&);  ///< sets the value in a request; called if the table has the key
    /// Sets the value in a keyframe [[key]]; null: keyframes do not have this setting.
    void (*read_keyframe)(const ShotTable&, const ShotKey&, CameraKey&) = nullptr;
    /// True for a setting of the lens in keyframes: the value outside of [[key]] then applies only to the file's first
    /// lens.
    bool is_lens_setting = false;
    SetSetting set = nullptr;  ///< for a setting of a picture; otherwise null
    /// Returns the value of a setting of a picture; null if the setting only stands for values of other settings.
    SettingValue (*get)(const PictureRequest& request) = nullptr;
    const char* details = "";  ///< further sentences of the description, for reference pages and docstrings

    /// Description with the default value, as help texts show it.
    std::string help() const { return *initial ? text + " [" + initial + ']' : text; }
};

/// All keys, in the order in which they are read and listed.
std::span<const ShotKey> shot_keys();

/// Returns the keys of the group "Picture", which shot_keys lists behind the others.
std::vector<ShotKey> picture_keys();

/// Returns the key of this name, which must exist.
const ShotKey& shot_key(std::string_view name);

/// Returns a request that has the noise goal of `settings` as the user would specify it.
PictureRequest request_of(const RenderSettings& settings);

}  // namespace realcam::shot
