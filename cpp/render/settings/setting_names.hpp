#pragma once
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "../../camera/film/develop.hpp"
#include "../../camera/film/pixel_filter.hpp"
#include "../../camera/models/camera_view.hpp"
#include "../../camera/models/pupil_sampling.hpp"
#include "../path/path_settings.hpp"

// Names of the values that a setting chooses from, on the command line, in shot files, in Python and in metadata.

namespace realcam {

template <class Value>
struct NamedValue {
    const char* name;
    Value value;
};

template <class Value, std::size_t count>
using NamedValues = std::array<NamedValue<Value>, count>;

/// Returns the value of a name; std::nullopt if the name is unknown.
template <class Value, std::size_t count>
std::optional<Value> value_named(const NamedValues<Value, count>& names, std::string_view name) {
    for (const NamedValue<Value>& named : names)
        if (name == named.name) return named.value;
    return std::nullopt;
}

/// Returns the name of a value, which must be listed.
template <class Value, std::size_t count>
const char* name_among(const NamedValues<Value, count>& names, const Value& value) {
    for (const NamedValue<Value>& named : names)
        if (value == named.value) return named.name;
    return names.front().name;
}

/// Returns all names, for messages and help texts: "full, thin or pinhole".
template <class Value, std::size_t count>
std::string one_of(const NamedValues<Value, count>& names) {
    std::string text;
    for (std::size_t i = 0; i < count; ++i)
        text += (i == 0 ? "" : i + 1 < count ? ", " : " or ") + std::string(names[i].name);
    return text;
}

inline constexpr NamedValues<CameraModel, 7> kCameraModels = {{
    {"full", CameraModel::full_lens},
    {"full_double", CameraModel::full_lens_double},
    {"polynomial", CameraModel::polynomial_lens},
    {"thick", CameraModel::thick_lens},
    {"mapped", CameraModel::mapped_lens},
    {"thin", CameraModel::thin_lens},
    {"pinhole", CameraModel::pinhole},
}};
inline constexpr NamedValues<ToneCurve, 2> kToneCurves = {{{"film", ToneCurve::film}, {"linear", ToneCurve::linear}}};
inline constexpr NamedValues<LightTransport, 2> kTransports = {
    {{"paths", LightTransport::paths}, {"whitted", LightTransport::whitted}}};
inline constexpr NamedValues<PupilSampling, 4> kPupilSamplings = {{
    {"outline", PupilSampling::outline},
    {"rear_element", PupilSampling::rear_element},
    {"exit_pupil", PupilSampling::exit_pupil},
    {"pixel", PupilSampling::pixel},
}};
inline constexpr NamedValues<LightTracing, 3> kLightTracings = {
    {{"weighted", LightTracing::weighted}, {"off", LightTracing::off}, {"alone", LightTracing::alone}}};

/// Colour space of the colours in OpenEXR files. Its values are linear.
enum class ExrColorSpace {
    rec709,  ///< primaries and white of ITU-R BT.709
    acescg,  ///< primaries AP1 and white of ACES (SMPTE ST 2065-1, S-2014-004)
};
inline constexpr NamedValues<ExrColorSpace, 2> kExrColorSpaces = {
    {{"rec709", ExrColorSpace::rec709}, {"acescg", ExrColorSpace::acescg}}};

inline constexpr NamedValues<PixelFilter, 3> kPixelFilters = {
    {{"box", PixelFilter::box}, {"tent", PixelFilter::tent}, {"gaussian", PixelFilter::gaussian}}};

inline const char* name_of(CameraModel model) {
    return name_among(kCameraModels, model);
}
inline const char* name_of(LightTransport transport) {
    return name_among(kTransports, transport);
}
inline const char* name_of(ToneCurve tone) {
    return name_among(kToneCurves, tone);
}

}  // namespace realcam
