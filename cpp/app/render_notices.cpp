#include "render_notices.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "../optics/coating/coated_surface.hpp"
#include "../render/session/metering.hpp"
#include "../render/settings/effect_names.hpp"
#include "../render/settings/setting_names.hpp"
#include "values.hpp"

namespace realcam::app {
namespace {

std::string percent(double part, double whole) {
    char text[32];
    std::snprintf(text, sizeof text, "%.1f%%", whole > 0 ? 100 * part / whole : 0.0);
    return text;
}

/// Formats the rate count / seconds in millions: "12.3 M".
std::string millions_per_second(double count, double seconds) {
    char text[32];
    std::snprintf(text, sizeof text, "%.1f M", seconds > 0 ? 1e-6 * count / seconds : 0.0);
    return text;
}

}  // namespace

std::string summary(const shot::Shot& shot, const RenderSettings& settings, const Image& image,
                    const std::vector<std::string>& pictures, const std::string& denoiser, double seconds,
                    bool verbose) {
    const Camera& camera = shot.camera;
    const LensSystem& lens = camera.lens;
    const Film& film = camera.film;
    const RenderStats& stats = image.stats;
    const FirstOrder data = first_order(lens, lens.wavelength_nm);
    std::string text;
    const auto line = [&](std::string what, const std::string& value) {
        what.resize(12, ' ');
        text += what + value + '\n';
    };
    const std::string model = name_of(camera.model);
    line("lens", (lens.title.empty() ? lens.name : lens.title) + (model == "full" ? "" : ", as " + model + " model"));
    line("", "focal length " + number_text(data.effective_focal_length) + " mm, f/" + number_text(data.f_number, 3) +
                 (lens.iris.blades > 0 && !lens.is_wide_open() ? " with " + std::to_string(lens.iris.blades) + " blades"
                                                               : "") +
                 ", focus " + distance_text(lens.focus_distance / 1000));
    const Vec3d from = camera.pose.position_m, to = camera.pose.look_at_m;
    const auto point = [](Vec3d p) { return number_text(p.x) + "," + number_text(p.y) + "," + number_text(p.z); };
    line("camera", "at " + point(from) + ", looks at " + point(to));
    line("film", number_text(film.width_mm) + " x " + number_text(film.height_mm) + " mm, " +
                     std::to_string(film.width) + " x " + std::to_string(film.height) + " pixels of " +
                     std::to_string(image.spp) + (image.spp == 1 ? " sample" : " samples"));
    line("exposure", exposure_text(camera.exposure_time_s) + ", ISO " + number_text(camera.iso) +
                         (shot.is_metered ? " (metered: the average becomes middle grey)" : ""));
    const std::vector<std::string> effects = names_of(settings.effects);
    if (!effects.empty()) {
        std::string names;
        for (const std::string& name : effects) names += (names.empty() ? "" : ", ") + name;
        const auto light = settings.spectral_light();
        line("effects", names + (light ? ", illuminant " + light->text() : ""));
        if (any_active_has(settings.effects, &EffectInfo::needs_coatings)) line("coatings", coating_summary(lens));
    }
    if (verbose) {
        const double busy = stats.lens_seconds + stats.scene_seconds + stats.other_seconds;
        const auto count = [](std::uint64_t n) { return static_cast<double>(n); };
        line("lens rays", millions_per_second(count(stats.sampled_rays), stats.seconds) + "/s; " +
                              millions_per_second(count(stats.sampled_rays), stats.lens_seconds) +
                              "/s a core while in the lens, " + percent(stats.lens_seconds, busy) + " of the time; " +
                              percent(count(stats.passed_rays), count(stats.sampled_rays)) +
                              " of the sampled rays pass");
        line("scene rays", millions_per_second(count(stats.scene_rays), stats.seconds) + "/s; " +
                               millions_per_second(count(stats.scene_rays), stats.scene_seconds) +
                               "/s a core while in the scene, " + percent(stats.scene_seconds, busy) + " of the time");
    }
    line("time", number_text(seconds, 3) + " s" +
                     (verbose ? ", of which " + number_text(stats.seconds, 3) + " s for the picture (set-up " +
                                    number_text(stats.setup_seconds, 2) + " s)"
                              : "") +
                     " on " + stats.device);
    if (!denoiser.empty()) line("denoised", "by " + denoiser);
    for (const std::string& path : pictures) line("picture", path);
    return text;
}

std::string frame_summary(int frame, const Camera& camera, const std::vector<std::string>& pictures) {
    const FirstOrder data = first_order(camera.lens, camera.lens.wavelength_nm);
    std::string text = "frame " + std::to_string(frame) + ": " + number_text(data.effective_focal_length) + " mm, f/" +
                       number_text(data.f_number, 3) + ", focus " + distance_text(camera.lens.focus_distance / 1000) +
                       ", " + exposure_text(camera.exposure_time_s) + ", ISO " + number_text(camera.iso);
    for (const std::string& path : pictures) text += ", " + path;
    return text + '\n';
}

namespace {

/// Least fraction of the pixels that must be black, or white, for a notice.
constexpr double kMinFraction = 0.75;
// 8-bit luminance codes: values below kBlackCode are two stops or more below middle grey; from kWhiteCode on, hardly
// any tonal detail is left.
constexpr int kBlackCode = 64, kWhiteCode = 235;
/// Least error of the exposure for a notice. Smaller errors may be intended: night scenes are darker than middle grey,
/// and snow is brighter.
constexpr double kMinError_stops = 3;

/// Fractions of the pixels that are black and white.
struct ExtremeFractions {
    double black = 0, white = 0;
};

ExtremeFractions extreme_fractions(const Image& image, double iso, const View& view) {
    std::size_t black = 0, white = 0;
    const std::size_t count = image.exposure.size() / 3;
    constexpr std::size_t kPart = 1 << 16;  // pixels developed at a time
    std::vector<float> grey(3 * kPart);
    std::vector<std::uint8_t> codes(grey.size());
    for (std::size_t first = 0; first < count; first += kPart) {
        const std::size_t size = std::min(kPart, count - first);
        for (std::size_t i = 0; i < size; ++i) {
            const float* rgb = &image.exposure[3 * (first + i)];
            std::fill_n(&grey[3 * i], 3, 0.2126f * rgb[0] + 0.7152f * rgb[1] + 0.0722f * rgb[2]);
        }
        view.develop(grey.data(), size, iso, codes.data());
        for (std::size_t i = 0; i < size; ++i) {
            black += codes[3 * i + 1] < kBlackCode;
            white += codes[3 * i + 1] >= kWhiteCode;
        }
    }
    const auto pixels = static_cast<double>(std::max<std::size_t>(count, 1));
    return {static_cast<double>(black) / pixels, static_cast<double>(white) / pixels};
}

}  // namespace

double stops_above_grey(const Image& image, double iso) {
    constexpr double kGrey = 10;  // lux seconds times ISO (ISO 12232)
    return std::log2(metered_exposure(image) * iso / kGrey);
}

std::string exposure_notice(const Image& image, const Camera& camera, const View& view) {
    const double stops = stops_above_grey(image, camera.iso);
    if (std::isinf(stops)) return "the picture is black: no light reaches the film";
    if (std::fabs(stops) <= kMinError_stops) return "";
    const ExtremeFractions extremes = extreme_fractions(image, camera.iso, view);
    const bool is_dark = stops < -kMinError_stops && extremes.black >= kMinFraction;
    const bool is_bright = stops > kMinError_stops && extremes.white >= kMinFraction;
    if (!is_dark && !is_bright) return "";
    const std::string time = exposure_text(camera.exposure_time_s / std::exp2(stops));
    const std::string head = std::string("the picture is nearly all ") + (is_dark ? "black" : "white") + ", " +
                             number_text(std::fabs(stops), 2) + " stops " + (is_dark ? "below" : "above") +
                             " middle grey at " + exposure_text(camera.exposure_time_s) + ", ISO " +
                             number_text(camera.iso) + "; ";
    return head + "try --exposure-time auto or about " + time.substr(0, time.size() - 2) +
           (is_dark ? ", a higher --iso or a smaller --f-number" : ", a lower --iso or a larger --f-number");
}

namespace {

std::string duration_text(double seconds) {
    if (seconds < 100) return number_text(std::max(1.0, std::round(seconds)), 2) + " s";
    if (seconds < 6000) return number_text(seconds / 60, 2) + " minutes";
    return number_text(seconds / 3600, 2) + " hours";
}

/// Shorter durations are not announced.
constexpr double kMinAnnounced_s = 3;

}  // namespace

std::string SamplingNotice::goal_text() const {
    const bool is_in_codes = goal_.unit == NoiseUnit::codes;
    std::string text =
        "samples are taken until the noise is " +
        (is_in_codes ? counted(goal_.noise, "code") + " of 255" : number_text(100 * goal_.noise) + "% of the light");
    if (std::isfinite(goal_.seconds)) text += ", for " + number_text(goal_.seconds) + " s at most";
    if (sampling_ == shot::Sampling::unspecified) text += "; --noise-codes, --seconds or --spp change this";
    return text;
}

double SamplingNotice::update(double fraction) {
    fraction_ = fraction;
    elapsed_s_ = std::chrono::duration<double>(Clock::now() - start_).count();
    return std::min(1.0, std::max(fraction, elapsed_s_ / goal_.seconds));
}

std::string SamplingNotice::duration_notice() {
    if (has_reported_ || !(fraction_ > 0) || fraction_ >= 1) return "";
    has_reported_ = true;
    const double expected_s = elapsed_s_ / fraction_;
    if (expected_s < kMinAnnounced_s) return "";
    const std::string duration = "about " + duration_text(expected_s);
    if (expected_s <= goal_.seconds) return "this is expected to take " + duration;
    return "that would take " + duration + "; the picture ends after " + duration_text(goal_.seconds);
}

}  // namespace realcam::app
