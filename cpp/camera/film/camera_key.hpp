#pragma once
#include <optional>
#include <vector>

#include "camera.hpp"

namespace REALCAM_NAMESPACE {

/// Interpolation between consecutive keyframes of a parameter.
enum class CameraKeyInterpolation {
    linear,  ///< linear in the parameter's scale (see CameraKey)
    smooth,  ///< MonotoneCurve through a run of smooth keys, with slope 0 at both ends of the run
    step,    ///< constant, with a jump at the next key
};

/// Keyframe of the camera's settings. A setting without a value is interpolated between the neighbouring keys that have
/// one.
///
/// A key with another lens is a cut. Focus, zoom and diaphragm are interpolated between keys of the same lens only. A
/// lens without keys for focus or f-number takes over the last values of the lens before.
struct CameraKey {
    double time_s = 0;
    std::optional<double> focus_m = {};  ///< distance from object plane to film; interpolated in 1 / distance
    /// Zoom setting: focal length without refocusing. This and the next three are interpolated in the logarithm.
    std::optional<double> focal_length_mm = {};
    std::optional<double> f_number = {};
    std::optional<double> exposure_time_s = {};
    std::optional<double> iso = {};
    CameraKeyInterpolation interpolation = CameraKeyInterpolation::linear;  ///< interpolation from this key on
    std::optional<LensSystem> lens = {};  ///< lens from this key on; before the first key with a lens: the camera's own
    std::optional<int> blades = {};  ///< number of blades from this key on. Without keys for this and the following
                                     ///< settings, those of the lens and the camera apply
    std::optional<double> blade_rounding = {}, blade_rotation_deg = {};
    std::optional<double> film_right_mm = {}, film_up_mm = {};  ///< x and y of Film::shift_mm

    bool operator==(const CameraKey&) const = default;
};

/// Throws InputError if the key has no value, or one that is out of range.
void validate(const CameraKey& key);

/// Throws InputError if a key is invalid or the key times are not strictly increasing.
void validate(const std::vector<CameraKey>& keys);

/// Settings at a time, interpolated between the keys. A setting is constant before the first key that has a value and
/// after the last one; but a lens is not used before its own key. A setting that no key has, or only keys of a later
/// lens, is left out.
CameraKey key_at(const std::vector<CameraKey>& keys, double time_s);

/// The camera with the settings of a key. If a zoom lens does not open to the key's f-number at its focal length, it is
/// opened as far as possible. A key with a lens, but without a focus or f-number, keeps the camera's. Throws InputError
/// if the lens cannot be set so.
Camera with_key(Camera camera, const CameraKey& key);

/// Throws InputError if with_key does, or if the lens does not open to the key's f-number at its focal length.
void check_key(const Camera& camera, const CameraKey& key);

}  // namespace REALCAM_NAMESPACE
