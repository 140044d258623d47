#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "../camera/film/develop.hpp"
#include "../camera/models/camera_view.hpp"
#include "../camera/models/pupil_sampling.hpp"
#include "../render/path/path_settings.hpp"
#include "shot_request.hpp"

namespace realcam::shot {

// Names of camera models, tone curves, light transport, pupil sampling and light tracing on the command line and in
// shot files: lists for help texts, and functions that return std::nullopt for other names.

inline constexpr const char* kModelNames = "full, full_double, polynomial, thick, mapped, thin or pinhole";
inline constexpr const char* kToneNames = "film or linear";
inline constexpr const char* kTransportNames = "paths or whitted";
inline constexpr const char* kPupilSamplingNames = "outline, rear_element, exit_pupil or pixel";
inline constexpr const char* kLightTracingNames = "weighted, off or alone";

inline std::optional<CameraModel> model_named(std::string_view name) {
    if (name == "full") return CameraModel::full_lens;
    if (name == "full_double") return CameraModel::full_lens_double;
    if (name == "polynomial") return CameraModel::polynomial_lens;
    if (name == "thick") return CameraModel::thick_lens;
    if (name == "mapped") return CameraModel::mapped_lens;
    if (name == "thin") return CameraModel::thin_lens;
    if (name == "pinhole") return CameraModel::pinhole;
    return std::nullopt;
}

inline std::optional<PupilSampling> pupil_sampling_named(std::string_view name) {
    if (name == "outline") return PupilSampling::outline;
    if (name == "rear_element") return PupilSampling::rear_element;
    if (name == "exit_pupil") return PupilSampling::exit_pupil;
    if (name == "pixel") return PupilSampling::pixel;
    return std::nullopt;
}

inline std::optional<LightTracing> light_tracing_named(std::string_view name) {
    if (name == "weighted") return LightTracing::weighted;
    if (name == "off") return LightTracing::off;
    if (name == "alone") return LightTracing::alone;
    return std::nullopt;
}

inline std::optional<LightTransport> transport_named(std::string_view name) {
    if (name == "paths") return LightTransport::paths;
    if (name == "whitted") return LightTransport::whitted;
    return std::nullopt;
}

inline std::optional<ToneCurve> tone_named(std::string_view name) {
    if (name == "film") return ToneCurve::film;
    if (name == "linear") return ToneCurve::linear;
    return std::nullopt;
}

class ShotTable;

/// Syntax of a key's value if it is written as one text, as on the command line.
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
};

/// A setting of a shot: a key of shot files, a keyword of Python's Shot.load, and an option of the command line.
struct ShotKey {
    const char* name;
    const char* option;  ///< null if the command line has no such option
    const char* group;   ///< heading of the option in help texts
    const char* placeholder;  ///< for the option's value in help texts; names the unit
    Syntax syntax;
    const char* wanted;  ///< noun phrase for the expected values, after "must be" in messages
    std::string text;    ///< description in help texts
    const char* initial;  ///< description of the default; empty: none
    std::vector<std::string_view> replaces;  ///< keys that a change of this key removes
    void (*read)(const ShotTable&, const ShotKey&,
                 ShotRequest&);  ///< sets the value in a request; called if the table has the key

    /// Description with the default value, as help texts show it.
    std::string help() const { return *initial ? text + " [" + initial + ']' : text; }
};

/// All keys, in the order in which they are read and listed.
std::span<const ShotKey> shot_keys();

}  // namespace realcam::shot
