#pragma once
#include <optional>
#include <vector>

#include "camera.hpp"

namespace REALCAM_NAMESPACE {

/// How values go from a key to the next one that has them.
enum class KeyWay {
    linear,  ///< at an even pace
    smooth,  ///< from rest to rest, and through the smooth keys between without a stop (MonotoneCurve)
    step,    ///< they stay, and jump at the next key
};

/// What the rings and dials of a camera say at a time. A value that is left out is that of the keys beside.
///
/// A key with another lens is a cut. The rings of a lens, which are those of focus, zoom and diaphragm, go between its
/// own keys alone. A lens without keys for focus and f-number takes over those of the lens before.
struct CameraKey {
    double time_s = 0;
    std::optional<double> focus_m = {};  ///< object plane to film; between keys even in 1 / distance
    std::optional<double> focal_length_mm =
        {};  ///< of a zoom lens at rest; this and what follows: even in the logarithm
    std::optional<double> f_number = {};
    std::optional<double> exposure_time_s = {};
    std::optional<double> iso = {};
    KeyWay way = KeyWay::linear;  ///< from here on
    std::optional<LensSystem> lens = {};  ///< from here on; none so far: the camera's own
    std::optional<int> blades = {};  ///< from here on; of these and what follows, none: as the lens has it
    std::optional<double> blade_rounding = {}, blade_rotation_deg = {};
    std::optional<double> film_right_mm = {}, film_up_mm = {};  ///< Film::shift_mm

    bool operator==(const CameraKey&) const = default;
};

/// Throws InputError for a key that says nothing, or has a number that is none of its kind.
void validate(const CameraKey& key);

/// Throws InputError for keys that are none, or whose times do not rise.
void validate(const std::vector<CameraKey>& keys);

/// What the keys say at a time, as a key: before the first one that has a value, and after the last, it stays, but that
/// no lens comes before its key. Values that no key has, or only one of another lens that comes later, are left out.
CameraKey key_at(const std::vector<CameraKey>& keys, double time_s);

/// The camera with its rings and dials as a key has them. A zoom lens that does not open as far as the key's f-number
/// at its focal length opens as far as it does. Where the key has a lens, but no focus or f-number, these stay. Throws
/// InputError where the lens cannot.
Camera with_key(Camera camera, const CameraKey& key);

/// Throws InputError where the camera cannot be as the key says, also where the lens does not open so far.
void check_key(const Camera& camera, const CameraKey& key);

}  // namespace REALCAM_NAMESPACE
