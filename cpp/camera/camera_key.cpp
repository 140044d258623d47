#include "camera_key.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "../math/monotone_curve.hpp"
#include "../optics/lens/focus.hpp"
#include "../optics/lens/zoom.hpp"

namespace realcam {
namespace {

using Value = std::optional<double> CameraKey::*;

/// A value and the scale on which it changes evenly.
struct Ring {
    Value value;
    const char* name;
    double (*scale)(double);
    double (*from_scale)(double);
};

double inverse(double x) {
    return 1 / x;
}

double logarithm(double x) {
    return std::log(x);
}

double exponential(double x) {
    return std::exp(x);
}

constexpr Ring kRings[] = {
    {&CameraKey::focus_m, "focus distance", inverse, inverse},
    {&CameraKey::focal_length_mm, "focal length", logarithm, exponential},
    {&CameraKey::f_number, "f-number", logarithm, exponential},
    {&CameraKey::exposure_time_s, "exposure time", logarithm, exponential},
    {&CameraKey::iso, "ISO number", logarithm, exponential},
};

/// The keys that have a value of a ring.
std::vector<const CameraKey*> keys_with(const std::vector<CameraKey>& keys, Value value) {
    std::vector<const CameraKey*> found;
    for (const CameraKey& key : keys)
        if (key.*value) found.push_back(&key);
    return found;
}

std::optional<double> value_at(const std::vector<CameraKey>& all, const Ring& ring, double time_s) {
    const auto keys = keys_with(all, ring.value);
    if (keys.empty()) return std::nullopt;
    const auto value = [&](std::size_t i) { return *(keys[i]->*ring.value); };
    if (!(time_s > keys.front()->time_s)) return value(0);
    const auto above = std::upper_bound(keys.begin(), keys.end(), time_s,
                                        [](double time, const CameraKey* key) { return time < key->time_s; });
    const auto at = static_cast<std::size_t>(above - keys.begin()) - 1;
    // Without the way through the scale and back, which would change the last digits of what stays.
    if (above == keys.end() || keys[at]->way == KeyWay::step || keys[at]->time_s == time_s ||
        value(at) == value(at + 1))
        return value(at);
    const bool is_smooth = keys[at]->way == KeyWay::smooth;
    std::size_t first = at, last = at + 1;
    while (is_smooth && first > 0 && keys[first - 1]->way == KeyWay::smooth) --first;
    while (is_smooth && last + 1 < keys.size() && keys[last]->way == KeyWay::smooth) ++last;
    std::vector<double> times, scaled;
    for (std::size_t i = first; i <= last; ++i) {
        times.push_back(keys[i]->time_s);
        scaled.push_back(ring.scale(value(i)));
    }
    const CurveEnds ends = is_smooth ? CurveEnds::rest : CurveEnds::free;
    return ring.from_scale(MonotoneCurve(std::move(times), std::move(scaled), ends).at(time_s));
}

}  // namespace

void validate(const CameraKey& key) {
    if (const std::string why = key_time_error(key.time_s, nullptr); !why.empty()) throw InputError(why);
    bool says_something = false;
    for (const Ring& ring : kRings) {
        const std::optional<double> value = key.*ring.value;
        says_something = says_something || value;
        const bool may_be_infinite = ring.value == &CameraKey::focus_m;
        if (value && (!(*value > 0) || (std::isinf(*value) && !may_be_infinite)))
            throw InputError(std::string("the ") + ring.name + " must be a positive number" +
                             (may_be_infinite ? " of metres, or inf" : ""));
    }
    if (!says_something)
        throw InputError("a key of the camera has no value: focus, focal length, f-number, exposure time or ISO");
}

void validate(const std::vector<CameraKey>& keys) {
    for (std::size_t k = 0; k < keys.size(); ++k) {
        const std::string key = "key " + std::to_string(k) + " of the camera: ";
        const std::string time = key_time_error(keys[k].time_s, k > 0 ? &keys[k - 1].time_s : nullptr);
        if (!time.empty()) throw InputError(key + time);
        try {
            validate(keys[k]);
        } catch (const InputError& error) {
            throw InputError(key + error.what());
        }
    }
}

CameraKey key_at(const std::vector<CameraKey>& keys, double time_s) {
    CameraKey key{.time_s = time_s};
    for (const Ring& ring : kRings) key.*ring.value = value_at(keys, ring, time_s);
    return key;
}

Camera with_key(Camera camera, const CameraKey& key) {
    LensSystem& lens = camera.lens;
    if (key.focal_length_mm) lens = zoomed_to_focal_length(lens, *key.focal_length_mm);
    if (key.f_number) {
        double wanted = *key.f_number;
        if (key.focal_length_mm) {
            LensSystem open = lens;
            open.stop_semi_diameter = open.stop().clear_semi_diameter;
            wanted = std::max(wanted, f_number_at_infinity(open));
        }
        lens = stopped_down(std::move(lens), wanted);
    }
    if (key.focus_m) lens = focused(lens, 1000 * *key.focus_m);
    camera.exposure_time_s = key.exposure_time_s.value_or(camera.exposure_time_s);
    camera.iso = key.iso.value_or(camera.iso);
    validate(camera);
    return camera;
}

void check_key(const Camera& camera, const CameraKey& key) {
    const double f_number = f_number_at_infinity(with_key(camera, key).lens);
    constexpr double kEngraved = 0.006;  // a little more than stopped_down takes for wide open
    if (!key.f_number || *key.f_number > (1 - kEngraved) * f_number) return;
    char text[120];
    std::snprintf(text, sizeof text, "f/%.4g is faster than the lens at %.4g mm, which opens to f/%.4g", *key.f_number,
                  *key.focal_length_mm, f_number);
    throw InputError(text);
}

}  // namespace realcam
