#include "exposure_notice.hpp"

#include <algorithm>
#include <cmath>

#include "../camera/code_table.hpp"
#include "../render/metering.hpp"
#include "values.hpp"

namespace realcam::app {
namespace {

constexpr double kNearlyAll = 0.75;  // fraction of the pixels
// 8-bit luminance codes: values below kBlack are two stops or more below middle grey; from kWhite on, hardly any tonal
// detail is left.
constexpr int kBlack = 64, kWhite = 235;
constexpr double kOffBy_stops = 3;  // night scenes are meant to be darker than middle grey, and snow brighter

/// Fractions of the pixels that are black and white.
struct Ends {
    double black = 0, white = 0;
};

Ends ends_of(const Image& image, double iso, ToneCurve tone) {
    const CodeTable code(iso, tone);
    std::size_t black = 0, white = 0;
    const std::size_t count = image.exposure.size() / 3;
    for (std::size_t i = 0; i < count; ++i) {
        const float* rgb = &image.exposure[3 * i];
        const int grey = code(0.2126f * rgb[0] + 0.7152f * rgb[1] + 0.0722f * rgb[2]);
        black += grey < kBlack;
        white += grey >= kWhite;
    }
    const auto pixels = static_cast<double>(std::max<std::size_t>(count, 1));
    return {static_cast<double>(black) / pixels, static_cast<double>(white) / pixels};
}

}  // namespace

double stops_above_grey(const Image& image, double iso) {
    constexpr double kGrey = 10;  // lux seconds times ISO (ISO 12232)
    return std::log2(metered_exposure(image) * iso / kGrey);
}

std::string exposure_notice(const Image& image, const Camera& camera, ToneCurve tone) {
    const double stops = stops_above_grey(image, camera.iso);
    if (std::isinf(stops)) return "the picture is black: no light reaches the film";
    const Ends ends = ends_of(image, camera.iso, tone);
    const bool is_dark = stops < -kOffBy_stops && ends.black >= kNearlyAll;
    const bool is_bright = stops > kOffBy_stops && ends.white >= kNearlyAll;
    if (!is_dark && !is_bright) return "";
    const std::string time = exposure_text(camera.exposure_time_s / std::exp2(stops));
    const std::string head = std::string("the picture is nearly all ") + (is_dark ? "black" : "white") + ", " +
                             number_text(std::fabs(stops), 2) + " stops " + (is_dark ? "below" : "above") +
                             " middle grey at " + exposure_text(camera.exposure_time_s) + ", ISO " +
                             number_text(camera.iso) + "; ";
    return head + "--exposure-time auto or about " + time.substr(0, time.size() - 2) +
           (is_dark ? ", a higher --iso or a smaller --f-number is wanted"
                    : ", a lower --iso or a larger --f-number is wanted");
}

}  // namespace realcam::app
