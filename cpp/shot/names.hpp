#pragma once
#include <optional>
#include <string_view>

#include "../camera/camera_view.hpp"
#include "../camera/develop.hpp"
#include "../camera/pupil_sampling.hpp"
#include "../render/path_settings.hpp"

namespace realcam::shot {

// Names of camera models, tone curves, light transport, pupil sampling and light tracing on the command line and in
// shot files.

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

}  // namespace realcam::shot
