#pragma once
#include <cstdint>
#include <vector>

#include "camera.hpp"

namespace REALCAM_NAMESPACE {

/// How far a camera that is held is from where it should be, at a time, in its own axes: right, up and backward.
struct ShakeKey {
    double time_s = 0;
    Vec3d rotation_deg = {0, 0, 0};  ///< about x, then y, then z, right-handed
    Vec3d position_m = {0, 0, 0};

    bool operator==(const ShakeKey&) const = default;
};

/// The shake of a camera in the hand: a curve that was measured, and one that is drawn. They are added.
///
/// Each of the three angles, and of the three shifts, is drawn as a Gaussian process of its own with the one-sided
/// spectrum 4 rms^2 / (pi f_c) / (1 + (f / f_c)^2)^2 over the frequency f: even up to about the corner f_c, and falling
/// with f^-4. It is a sum of cosines (M. Shinozuka and G. Deodatis, Appl. Mech. Rev. 44 (1991) 191), and so a function
/// of the time and the seed alone.
struct Shake {
    std::vector<ShakeKey> curve;  ///< in rising order of time, even between; before and after, its ends
    double rms_deg = 0;
    double rms_mm = 0;
    double corner_hz = 1;
    std::uint32_t seed = 0;

    bool operator==(const Shake&) const = default;

    bool is_still() const { return curve.empty() && rms_deg == 0 && rms_mm == 0; }
};

/// Throws InputError.
void validate(const Shake& shake);

/// Where the shake has the camera at these times.
std::vector<ShakeKey> shake_at(const Shake& shake, const std::vector<double>& times_s);

/// The camera with the shake of its exposure added to how it moves. For other times it is wrong. Throws InputError.
Camera shaken(Camera camera, const Shake& shake);

}  // namespace REALCAM_NAMESPACE
