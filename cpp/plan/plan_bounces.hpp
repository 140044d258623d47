#pragma once
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "../camera/picture_codes.hpp"
#include "../render/take_picture.hpp"
#include "plan.hpp"
#include "plan_text.hpp"
#include "small_film.hpp"

namespace REALCAM_NAMESPACE {

namespace plan_bounces_detail {

/// Pixels of the longer side, pixels of the side of a square, and samples per pixel. Pictures are compared by means
/// over squares, because roulette lets few paths continue, which light up single pixels.
inline constexpr int kLongSide = 48, kSquare = 4, kSamples = 32;
/// Fraction of the threshold that the small picture may lack. It underestimates light that few samples find, such as
/// that of many reflections in glass. Superfluous bounces cost little, because few paths take them.
inline constexpr double kMargin = 0.5;

/// Renders a small picture; returns linear 8-bit codes of its squares, three channels each. With another number of
/// bounces the same paths are followed as far as they go, so that two pictures differ only by the light of the
/// additional bounces.
inline std::vector<double> small_picture(Session& session, const Assembly& scene, const Camera& camera,
                                         RenderSettings settings, int max_bounces, const Progress& progress) {
    settings.max_bounces = max_bounces;
    const Image image = take_picture(session, scene, camera, settings, progress);
    std::vector<double> codes;
    for (int top = 0; top < image.height; top += kSquare)
        for (int left = 0; left < image.width; left += kSquare)
            for (int channel = 0; channel < 3; ++channel) {
                const int bottom = std::min(top + kSquare, image.height), right = std::min(left + kSquare, image.width);
                double sum = 0;
                for (int y = top; y < bottom; ++y)
                    for (int x = left; x < right; ++x)
                        sum += static_cast<double>(
                            image.exposure[static_cast<std::size_t>(3 * (y * image.width + x) + channel)]);
                codes.push_back(code_of(sensor_value(sum / ((bottom - top) * (right - left)), camera.iso)));
            }
    return codes;
}

inline double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
    double largest = 0;
    for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::fabs(a[i] - b[i]));
    return largest;
}

}  // namespace plan_bounces_detail

/// Decides on the number of bounces: the least with which every square of a small picture lacks less than kMargin times
/// the threshold of codes. `settings`: those of the picture. Throws what take_picture throws.
inline void plan_bounces(Session& session, const Assembly& scene, Camera camera, RenderSettings settings, Plan& plan,
                         const Progress& progress) {
    using namespace plan_bounces_detail;
    if (settings.max_bounces) {
        plan.max_bounces = *settings.max_bounces;
        return;
    }
    const double threshold = settings.thresholds.codes;
    camera.film = with_long_side(camera.film, kLongSide);
    // A pinhole camera shows the differences faster, if the lens has an axis.
    if (const LensSystem on_axis = centred(camera.lens); on_axis.is_rotational()) {
        camera.lens = on_axis;
        camera.model = CameraModel::pinhole;
    }
    settings.spp = kSamples;
    settings.noise.reset();
    settings.effects = {};
    settings.pupil_sampling = PupilSampling::outline;
    settings.illuminant.reset();
    settings.layers = {};
    const auto with = [&](int bounces) { return small_picture(session, scene, camera, settings, bounces, progress); };
    const std::vector<double> all = with(kMostBounces);
    const double indirect = largest_difference(with(0), all);
    double lacking = indirect, lacking_before = indirect;
    plan.max_bounces = 0;
    for (const int bounces : {1, 2, 3, 4, 6, 8, 12, 16, 24, 32, kMostBounces}) {
        if (lacking < kMargin * threshold) break;
        lacking_before = lacking;
        plan.max_bounces = bounces;
        lacking = bounces == kMostBounces ? 0 : largest_difference(with(bounces), all);
    }
    const auto codes = [](double size) { return counted(size, "code", 2); };
    plan.decisions.push_back(
        {"bounces", indirect, SizeUnit::codes, threshold, plan.max_bounces > 0, DecidedBy::planner, std::nullopt,
         plan.max_bounces == 0 ? "light that has bounced brings " + codes(indirect)
                               : "with " + counted(plan.max_bounces, "bounce") + " the picture lacks " +
                                     codes(lacking) + ", with fewer " + codes(lacking_before) +
                                     " (half the threshold is allowed), with direct light alone " + codes(indirect)});
}

}  // namespace REALCAM_NAMESPACE
