#include "frames.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "../math/random.hpp"
#include "../render/metering.hpp"

namespace realcam::shot {

double frame_opens_s(const Camera& camera, int number, double frames_per_second) {
    return camera.shutter.opens_s + (number - 1) / frames_per_second;
}

Camera camera_at(Camera camera, const std::vector<CameraKey>& keys, const Shake& shake, double opens_s) {
    camera.shutter.opens_s = opens_s;
    camera = with_key(std::move(camera), key_at(keys, opens_s));
    return shaken(std::move(camera), shake);
}

std::vector<int> frames_to_plan(const std::vector<int>& numbers, const Camera& camera,
                                const std::vector<CameraKey>& keys, double frames_per_second) {
    std::vector<int> chosen;
    std::optional<LensSystem> lens;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        std::optional<LensSystem> now = key_at(keys, frame_opens_s(camera, numbers[i], frames_per_second)).lens;
        if (i == 0 || i == numbers.size() / 2 || i + 1 == numbers.size() || now != lens) chosen.push_back(numbers[i]);
        lens = std::move(now);
    }
    return chosen;
}

std::uint32_t frame_seed(std::uint32_t seed, int number) {
    return hash32(static_cast<std::uint32_t>(number), seed);
}

FollowedIso::FollowedIso(Session& session, const Assembly& scene, Camera camera, std::vector<CameraKey> keys,
                         RenderSettings settings, double frames_per_second, double smoothing_s)
    : session_(session),
      scene_(scene),
      camera_(std::move(camera)),
      keys_(std::move(keys)),
      settings_(std::move(settings)),
      frames_per_second_(frames_per_second),
      smoothing_s_(smoothing_s) {}

double FollowedIso::at(int number, const Progress& progress) {
    constexpr double kOldest = 5;  // times the smoothing: older frames have less than a hundredth of the weight
    const double frames = smoothing_s_ * frames_per_second_;
    const int first = std::max(std::min(number, 1), number - static_cast<int>(std::min(kOldest * frames, 1e6)));
    double sum = 0, weights = 0;
    for (int n = first; n <= number; ++n) {
        const double weight = n == number ? 1 : std::exp((n - number) / frames);
        sum += weight * std::log(metered(n, progress));
        weights += weight;
    }
    return std::exp(sum / weights);
}

double FollowedIso::metered(int number, const Progress& progress) {
    const auto known = metered_.find(number);
    if (known != metered_.end()) return known->second;
    const Camera camera = camera_at(camera_, keys_, {}, frame_opens_s(camera_, number, frames_per_second_));
    const double time_s = metered_exposure_time(session_, scene_, camera, settings_, progress);
    return metered_[number] = camera.iso * time_s / camera.exposure_time_s;
}

}  // namespace realcam::shot
