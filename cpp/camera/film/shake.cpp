#include "shake.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "../../math/affine.hpp"
#include "../../math/random.hpp"
#include "../../math/root.hpp"

namespace realcam {
namespace {

constexpr int kCosines = 64;  ///< number of cosines summed for each angle and each shift
/// Highest frequency, in units of the corner frequency: 4e-4 of the spectrum lie above it.
constexpr double kMaxFrequency = 10;
/// Limits of valid parameters.
constexpr double kMaxDegrees = 90, kMaxMetres = 1e6, kMaxHertz = 1e4;

/// Three independent Gaussian processes of variance 1 as functions of time, with the spectrum of Shake.
class RandomCurves {
public:
    /// `first_stream`: index of the first curve's random stream; the other two have the next ones.
    RandomCurves(double corner_hz, std::uint32_t seed, std::uint32_t first_stream) {
        constexpr double kTwoPi = 2 * std::numbers::pi;
        for (std::uint32_t axis = 0; axis < 3; ++axis) {
            for (std::uint32_t k = 0; k < kCosines; ++k) {
                const std::uint32_t stream = hash32((first_stream + axis) * 2 * kCosines + 2 * k, seed);
                // Each cosine has the same share of the spectrum and a random frequency in it, so that the sum does not
                // repeat.
                const double frequency = corner_hz * frequency_quantile((k + unit(stream)) / kCosines);
                cosines_[axis][k] = {kTwoPi * frequency, kTwoPi * unit(hash32(stream))};
            }
        }
    }

    /// Values of the three curves.
    Vec3d at(double time_s) const {
        std::array<double, 3> sums{};
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (const Cosine& cosine : cosines_[axis])
                sums[axis] += std::cos(cosine.radians_per_s * time_s + cosine.phase);
        const double scale = std::sqrt(2.0 / kCosines);
        return {scale * sums[0], scale * sums[1], scale * sums[2]};
    }

private:
    struct Cosine {
        double radians_per_s, phase;
    };

    /// Random number between 0 and 1, exclusive.
    static double unit(std::uint32_t bits) { return (bits + 0.5) * 0x1p-32; }

    /// Frequency, in units of the corner frequency, below which a fraction of the spectrum's power up to kMaxFrequency
    /// lies. The spectrum's integral is 2 / pi (atan x + x / (1 + x^2)).
    static double frequency_quantile(double fraction) {
        const auto integral = [](double x) { return 2 / std::numbers::pi * (std::atan(x) + x / (1 + x * x)); };
        const double all = integral(kMaxFrequency);
        const auto excess = [&](double x) { return integral(x) - fraction * all; };
        return find_root(excess, 0.0, excess(0), kMaxFrequency, excess(kMaxFrequency), 1e-14).at;
    }

    std::array<std::array<Cosine, kCosines>, 3> cosines_;
};

/// Displacement on a measured curve at a time; zero if the curve is empty.
ShakeKey curve_at(const std::vector<ShakeKey>& curve, double time_s) {
    if (curve.empty()) return {time_s, {}, {}};
    const auto next = std::upper_bound(curve.begin(), curve.end(), time_s,
                                       [](double time, const ShakeKey& key) { return time < key.time_s; });
    if (next == curve.begin() || next == curve.end()) {
        const ShakeKey& end = next == curve.begin() ? curve.front() : curve.back();
        return {time_s, end.rotation_deg, end.position_m};
    }
    const ShakeKey& before = next[-1];
    const double fraction = (time_s - before.time_s) / (next->time_s - before.time_s);
    return {time_s, mix(before.rotation_deg, next->rotation_deg, fraction),
            mix(before.position_m, next->position_m, fraction)};
}

bool is_within(Vec3d v, double limit) {
    return std::fabs(v.x) <= limit && std::fabs(v.y) <= limit && std::fabs(v.z) <= limit;
}

}  // namespace

void validate(const Shake& shake) {
    for (std::size_t k = 0; k < shake.curve.size(); ++k) {
        const ShakeKey& key = shake.curve[k];
        std::string why = key_time_error(key.time_s, k > 0 ? &shake.curve[k - 1].time_s : nullptr);
        if (why.empty() && !(is_within(key.rotation_deg, kMaxDegrees) && is_within(key.position_m, kMaxMetres)))
            why = "angles must lie within 90 degrees, and positions within 1e6 m";
        if (!why.empty()) throw InputError("key " + std::to_string(k) + " of the shake: " + why);
    }
    if (!(shake.rms_deg >= 0 && shake.rms_deg <= kMaxDegrees / 10))
        throw InputError("the shake's root mean square must be an angle from 0 to 9 degrees");
    if (!(shake.rms_mm >= 0 && shake.rms_mm <= kMaxMetres))
        throw InputError("the shake's root mean square must be a length from 0 to 1e6 mm");
    if (!(shake.corner_hz > 0 && shake.corner_hz <= kMaxHertz))
        throw InputError("the shake's corner must be a frequency up to 1e4 Hz");
}

std::vector<ShakeKey> shake_at(const Shake& shake, const std::vector<double>& times_s) {
    const RandomCurves angles(shake.corner_hz, shake.seed, 0), shifts(shake.corner_hz, shake.seed, 3);
    std::vector<ShakeKey> found;
    for (const double time_s : times_s) {
        ShakeKey key = curve_at(shake.curve, time_s);
        if (shake.rms_deg > 0) key.rotation_deg = key.rotation_deg + shake.rms_deg * angles.at(time_s);
        if (shake.rms_mm > 0) key.position_m = key.position_m + (0.001 * shake.rms_mm) * shifts.at(time_s);
        found.push_back(key);
    }
    return found;
}

Camera shaken(Camera camera, const Shake& shake) {
    if (shake.is_still()) return camera;
    const TimeInterval exposure = camera.exposure();
    // Uniform steps over which a random curve bends little, and all times at which the measured curve and the camera's
    // own motion may have a kink.
    const double step_s = 0.1 / (kMaxFrequency * shake.corner_hz);
    constexpr int kMaxSteps = 1000;
    const int steps = static_cast<int>(
        std::clamp(std::ceil((exposure.end_s - exposure.begin_s) / step_s), 1.0, static_cast<double>(kMaxSteps)));
    std::vector<double> times;
    for (int i = 0; i <= steps; ++i) times.push_back(exposure.at(static_cast<double>(i) / steps));
    const auto add = [&](double time_s) {
        if (time_s > exposure.begin_s && time_s < exposure.end_s) times.push_back(time_s);
    };
    for (const ShakeKey& key : shake.curve) add(key.time_s);
    for (const PoseKey& key : camera.motion) add(key.time_s);
    times = sorted_unique(std::move(times));
    std::vector<PoseKey> keys;
    for (const ShakeKey& key : shake_at(shake, times)) {
        const Pose pose = pose_at(camera, key.time_s);
        Affine<double> displacement = euler_rotation(key.rotation_deg);
        displacement.origin = key.position_m;
        const Affine<double> map = camera_detail::scene_from_camera(pose) * displacement;
        const double distance = length(pose.look_at_m - pose.position_m);
        keys.push_back({key.time_s, {map.origin, map.origin - distance * map.z, map.y}});
    }
    set_motion(camera, std::move(keys));
    return camera;
}

}  // namespace realcam
