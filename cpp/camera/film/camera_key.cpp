#include "camera_key.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <span>
#include <string>
#include <utility>

#include "../../math/curves.hpp"
#include "../../optics/lens/focus.hpp"
#include "../../optics/lens/rings.hpp"
#include "../../optics/prescription/lens_checks.hpp"

namespace realcam {
namespace {

using Value = std::optional<double> CameraKey::*;

/// Treatment of a setting at a cut to another lens that has no keys for it.
enum class AtCut {
    continues,   ///< is interpolated across the cut: a setting of the camera body
    keeps_last,  ///< keeps the last value of the previous lens
    is_dropped,  ///< has no value: the next lens has its own
};

/// A setting of the camera, and how it is interpolated.
struct Setting {
    Value value;
    const char* name;               ///< in messages
    double (*scale)(double);       ///< from a value to the scale that is interpolated linearly
    double (*from_scale)(double);  ///< inverse of `scale`
    AtCut at_cut;
};

double identity(double x) {
    return x;
}

double inverse(double x) {
    return 1 / x;
}

double logarithm(double x) {
    return std::log(x);
}

double exponential(double x) {
    return std::exp(x);
}

constexpr Setting kSettings[] = {
    {&CameraKey::focus_m, "focus distance", inverse, inverse, AtCut::keeps_last},
    {&CameraKey::focal_length_mm, "focal length", logarithm, exponential, AtCut::is_dropped},
    {&CameraKey::f_number, "f-number", logarithm, exponential, AtCut::keeps_last},
    {&CameraKey::blade_rounding, "rounding of the blades", identity, identity, AtCut::is_dropped},
    {&CameraKey::blade_rotation_deg, "rotation of the blades", identity, identity, AtCut::is_dropped},
    {&CameraKey::exposure_time_s, "exposure time", logarithm, exponential, AtCut::continues},
    {&CameraKey::iso, "ISO number", logarithm, exponential, AtCut::continues},
    {&CameraKey::film_right_mm, "shift of the film", identity, identity, AtCut::continues},
    {&CameraKey::film_up_mm, "shift of the film", identity, identity, AtCut::continues},
};

using Keys = std::span<const CameraKey>;

/// Range of keys of the lens in use at a time: the index of the key that mounts it (0 for the first lens) and that of
/// the next key that mounts another lens.
std::pair<std::size_t, std::size_t> keys_of_lens(Keys keys, double time_s) {
    std::size_t begin = 0;
    const LensSystem* lens = nullptr;
    for (std::size_t i = 0; i < keys.size(); ++i) {
        if (!keys[i].lens || (lens && *keys[i].lens == *lens)) continue;
        if (keys[i].time_s > time_s) return {begin, i};
        begin = i;
        lens = &*keys[i].lens;
    }
    return {begin, keys.size()};
}

/// Keys that have a value for a setting.
std::vector<const CameraKey*> keys_with(Keys keys, Value value) {
    std::vector<const CameraKey*> found;
    for (const CameraKey& key : keys)
        if (key.*value) found.push_back(&key);
    return found;
}

/// Interpolated value of a setting at a time. Returns std::nullopt if no key of the lens in use has one (see AtCut).
std::optional<double> value_at(Keys all, const Setting& setting, double time_s) {
    const auto [begin, end] =
        setting.at_cut == AtCut::continues ? std::pair(std::size_t{0}, all.size()) : keys_of_lens(all, time_s);
    auto keys = keys_with(all.subspan(begin, end - begin), setting.value);
    if (keys.empty() && setting.at_cut == AtCut::keeps_last) {
        keys = keys_with(all.first(begin), setting.value);
        if (!keys.empty()) return keys.back()->*setting.value;
    }
    if (keys.empty()) return std::nullopt;
    const auto value = [&](std::size_t i) { return *(keys[i]->*setting.value); };
    if (!(time_s > keys.front()->time_s)) return value(0);
    const auto above = std::upper_bound(keys.begin(), keys.end(), time_s,
                                        [](double time, const CameraKey* key) { return time < key->time_s; });
    const auto at = static_cast<std::size_t>(above - keys.begin()) - 1;
    // Returned directly: the transform to the scale and back would change the last digits of a constant value.
    if (above == keys.end() || keys[at]->interpolation == CameraKeyInterpolation::step || keys[at]->time_s == time_s ||
        value(at) == value(at + 1))
        return value(at);
    const bool is_smooth = keys[at]->interpolation == CameraKeyInterpolation::smooth;
    std::size_t first = at, last = at + 1;
    while (is_smooth && first > 0 && keys[first - 1]->interpolation == CameraKeyInterpolation::smooth) --first;
    while (is_smooth && last + 1 < keys.size() && keys[last]->interpolation == CameraKeyInterpolation::smooth) ++last;
    std::vector<double> times, scaled;
    for (std::size_t i = first; i <= last; ++i) {
        times.push_back(keys[i]->time_s);
        scaled.push_back(setting.scale(value(i)));
    }
    const CurveEnds ends = is_smooth ? CurveEnds::zero_slope : CurveEnds::free;
    return setting.from_scale(MonotoneCurve(std::move(times), std::move(scaled), ends).at(time_s));
}

/// f-number to set for a key; std::nullopt leaves the diaphragm unchanged, which is wide open on a newly mounted lens.
std::optional<double> requested_f_number(const Camera& camera, const CameraKey& key) {
    if (key.f_number || !key.lens || camera.lens.is_wide_open()) return key.f_number;
    return f_number_at_infinity(camera.lens);
}

}  // namespace

void validate(const CameraKey& key) {
    if (const std::string why = key_time_error(key.time_s, nullptr); !why.empty()) throw InputError(why);
    bool has_value = key.lens || key.blades;
    for (const Setting& setting : kSettings) {
        const std::optional<double> value = key.*setting.value;
        has_value = has_value || value;
        if (!value) continue;
        const bool may_be_infinite = setting.value == &CameraKey::focus_m;
        const bool may_be_negative = setting.scale == identity;
        if (!(*value > 0 || may_be_negative) || !(std::isfinite(*value) || may_be_infinite))
            throw InputError(std::string("the ") + setting.name + " must be a " + (may_be_negative ? "" : "positive ") +
                             "number" + (may_be_infinite ? " of metres, or inf" : ""));
    }
    if (!has_value)
        throw InputError(
            "a key of the camera has no value; expected one of lens, focus, focal length, f-number, blades, exposure "
            "time, ISO or "
            "shift of the film");
    try {
        check_iris({key.blades.value_or(0), key.blade_rounding.value_or(0), 0});
    } catch (const LensFileError& error) {
        throw InputError(error.what());
    }
}

void validate(const std::vector<CameraKey>& keys) {
    check_keys(keys, "the camera", [](const CameraKey& key) { validate(key); });
}

CameraKey key_at(const std::vector<CameraKey>& keys, double time_s) {
    // A frame's time is a sum, which may differ from a key's time in its last digits.
    constexpr double kTimeTolerance_s = 1e-7;
    for (const CameraKey& key : keys)
        if (std::fabs(key.time_s - time_s) <= kTimeTolerance_s) time_s = key.time_s;
    CameraKey found{.time_s = time_s};
    for (const Setting& setting : kSettings) found.*setting.value = value_at(keys, setting, time_s);
    const auto [begin, end] = keys_of_lens(keys, time_s);
    if (begin < end) found.lens = keys[begin].lens;
    for (std::size_t i = begin; i < end; ++i)
        if (keys[i].blades && (keys[i].time_s <= time_s || !found.blades)) found.blades = keys[i].blades;
    return found;
}

Camera with_key(Camera camera, const CameraKey& key) {
    LensSystem& lens = camera.lens;
    const std::optional<double> f_number = requested_f_number(camera, key);
    const double focus_before = lens.focus_distance;
    if (key.lens) lens = wide_open(*key.lens);
    Rings rings{{}, key.blades, key.blade_rounding, key.blade_rotation_deg, f_number, key.focal_length_mm.has_value(),
                {}};
    if (key.focal_length_mm) rings.zoom = *key.focal_length_mm;
    if (key.focus_m || key.lens) rings.focus_distance = key.focus_m ? 1000 * *key.focus_m : focus_before;
    lens = with_rings(std::move(lens), rings);
    camera.exposure_time_s = key.exposure_time_s.value_or(camera.exposure_time_s);
    camera.iso = key.iso.value_or(camera.iso);
    camera.film.shift_mm = {key.film_right_mm.value_or(camera.film.shift_mm.x),
                            key.film_up_mm.value_or(camera.film.shift_mm.y)};
    validate(camera);
    return camera;
}

void check_key(const Camera& camera, const CameraKey& key) {
    const double f_number = f_number_at_infinity(with_key(camera, key).lens);
    const std::optional<double> requested = requested_f_number(camera, key);
    constexpr double kRounding = 1e-6;  // relative error of setting the diaphragm
    // Without a focal length, with_key has thrown already.
    if (!requested || !key.focal_length_mm || *requested > (1 - kEngravingError) * (1 - kRounding) * f_number) return;
    char text[120];
    std::snprintf(text, sizeof text, "f/%.4g is faster than the lens at %.4g mm, which opens to f/%.4g", *requested,
                  *key.focal_length_mm, f_number);
    throw InputError(text);
}

}  // namespace realcam
