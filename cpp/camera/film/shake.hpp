#pragma once
#include <cstdint>
#include <vector>

#include "camera.hpp"

namespace REALCAM_NAMESPACE {

/// Displacement of a hand-held camera from its intended pose at a time, in its own axes: right, up and backward.
struct ShakeKey {
    double time_s = 0;
    Vec3d rotation_deg = {0, 0, 0};  ///< about x, then y, then z, right-handed
    Vec3d position_m = {0, 0, 0};

    bool operator==(const ShakeKey&) const = default;
};

/// Shake of a hand-held camera: the sum of a measured curve and a random one.
///
/// Each of the three angles and three shifts is an independent Gaussian process with the one-sided spectrum 4 rms^2 /
/// (pi f_c) / (1 + (f / f_c)^2)^2 over the frequency f: flat up to about the corner frequency f_c, and falling with
/// f^-4. It is a sum of cosines (M. Shinozuka and G. Deodatis, Appl. Mech. Rev. 44 (1991) 191), and so a function of
/// time and seed alone.
struct Shake {
    std::vector<ShakeKey> curve;  ///< measured, in increasing order of time; linear in between, constant before and
                                  ///< after
    double rms_deg = 0;  ///< root mean square of each random angle
    double rms_mm = 0;   ///< root mean square of each random shift
    double corner_hz = 1;  ///< corner frequency f_c
    std::uint32_t seed = 0;  ///< of the random shake

    bool operator==(const Shake&) const = default;

    bool is_still() const { return curve.empty() && rms_deg == 0 && rms_mm == 0; }
};

/// Throws InputError if a parameter is invalid.
void validate(const Shake& shake);

/// Displacements of the camera at these times of the scene, in the same order. The shake must be valid.
std::vector<ShakeKey> shake_at(const Shake& shake, const std::vector<double>& times_s);

/// Returns the camera with the shake added to its motion, as keyframes over its exposure; not valid for other times.
/// Throws InputError if the camera that results is invalid.
Camera shaken(Camera camera, const Shake& shake);

}  // namespace REALCAM_NAMESPACE
