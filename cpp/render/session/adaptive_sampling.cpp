#include "adaptive_sampling.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "../../camera/film/develop.hpp"

namespace realcam {

AdaptiveSampling::AdaptiveSampling(int width, int height, const NoiseGoal& goal, double iso,
                                   std::span<const float> exposure, const std::vector<std::int64_t>& samples,
                                   std::span<const float> traced)
    : width_(width),
      height_(height),
      goal_(goal),
      iso_(iso),
      across_(tiles_of(width)),
      down_(tiles_of(height)),
      halves_(2 * static_cast<std::size_t>(across_) * static_cast<std::size_t>(down_)),
      traced_(traced.begin(), traced.end()),
      traced_samples_(static_cast<double>(*std::max_element(samples.begin(), samples.end()))) {
    values_.reserve(exposure.size());
    for (const float e : exposure) values_.push_back(value_of(e));
    for_pixels([&](std::size_t pixel, std::size_t half) {
        ++halves_[half].pixels;
        halves_[half].samples += static_cast<double>(samples[pixel]);
    });
    for (Half& half : halves_) {
        half.samples = std::max(1.0, half.samples / std::max(half.pixels, 1.0));
        half.traced = traced_.empty() ? 0 : std::numeric_limits<double>::infinity();
    }
}

std::vector<std::uint32_t> AdaptiveSampling::next(double max_total) {
    std::vector<double> additional(halves_.size());
    double sum = 0;
    traces_lights_ = false;
    for (std::size_t h = 0; h < halves_.size(); ++h) {
        const double end = samples_at_goal(other(h));
        halves_[h].is_finished |= end <= halves_[h].samples;
        additional[h] = additional_samples(halves_[h], end);
        sum += additional[h] * halves_[h].pixels;
        traces_lights_ |= additional[h] > 0 && halves_[h].traced > kMaxTracedFraction * goal_variance(halves_[h]);
    }
    const double scale = std::clamp(max_total / std::max(sum, 1.0), 0.0, 1.0);
    std::vector<std::uint32_t> counts(values_.size() / 3);
    for_pixels([&](std::size_t pixel, std::size_t half) {
        counts[pixel] = static_cast<std::uint32_t>(scale * additional[half]);
    });
    return counts;
}

void AdaptiveSampling::add(std::span<const float> exposure, const std::vector<std::uint32_t>& counts,
                           std::span<const float> traced) {
    std::vector<double> difference(halves_.size()), by_lights(halves_.size()), mean(halves_.size()),
        taken(halves_.size());
    const bool is_traced = traces_lights_ && !traced.empty();
    for_pixels([&](std::size_t pixel, std::size_t half) {
        for (std::size_t c = 3 * pixel; c < 3 * pixel + 3; ++c) {
            if (counts[pixel] > 0) {
                const float value = value_of(exposure[c]);
                const double step = static_cast<double>(value) - static_cast<double>(values_[c]);
                difference[half] += step * step;
                values_[c] = value;
                if (is_traced) {
                    const float without = value_of(exposure[c] - (traced[c] - traced_[c]));
                    const double by_light = static_cast<double>(value) - static_cast<double>(without);
                    by_lights[half] += by_light * by_light;
                }
            }
            mean[half] += static_cast<double>(values_[c]);
        }
        taken[half] = counts[pixel];
    });
    // B samples are followed by N new ones. The change of the mean is N / (B + N) of the difference of both means,
    // whose variance is s^2 (1/B + 1/N). The variance of the new mean, s^2 / (B + N), is therefore B / N times that of
    // the change.
    const double traced_taken = *std::max_element(counts.begin(), counts.end());
    const double variance_over_change = traced_samples_ / std::max(traced_taken, 1.0);
    for (std::size_t h = 0; h < halves_.size(); ++h) {
        const double values = 3 * std::max(halves_[h].pixels, 1.0);
        halves_[h].mean = mean[h] / values;
        if (taken[h] == 0) continue;
        // Both kinds of samples are independent, so that the squares of their changes add up.
        halves_[h].add(std::max(0.0, difference[h] - by_lights[h]) / values, taken[h]);
        if (is_traced) halves_[h].traced = variance_over_change * by_lights[h] / values;
    }
    if (!is_traced) return;
    traced_.assign(traced.begin(), traced.end());
    traced_samples_ += traced_taken;
}

ReachedNoise AdaptiveSampling::reached() const {
    ReachedNoise worst{0, true, 0};
    for (std::size_t h = 0; h < halves_.size(); ++h) {
        if (halves_[h].pixels == 0) continue;
        if (halves_[h].doublings == 0) return {};
        const double noise = goal_.noise * std::sqrt(variance_ratio(h));
        if (noise > worst.noise) worst = {noise, true, samples_at_goal(h)};
    }
    for (std::size_t h = 0; h < halves_.size(); ++h)
        worst.is_reached &= halves_[h].pixels == 0 || halves_[h].is_finished;
    return worst;
}

double AdaptiveSampling::left() const {
    double sum = 0;
    for (std::size_t h = 0; h < halves_.size(); ++h) {
        if (halves_[h].is_finished) continue;
        const double end = std::min(samples_at_goal(other(h)), static_cast<double>(goal_.max_samples));
        sum += halves_[h].pixels * std::max(0.0, end - halves_[h].samples);
    }
    return sum;
}

void AdaptiveSampling::Half::add(double change, double taken) {
    // The difference is a poor estimate if fewer samples are added than the half has.
    const bool is_doubling = taken >= samples;
    samples += taken;
    if (!is_doubling) return;
    square_before = square;
    square = change;
    doubled_to = samples;
    ++doublings;
}

std::size_t AdaptiveSampling::half_at(int row, int column, std::size_t half) const {
    return 2 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(across_) + static_cast<std::size_t>(column)) +
           half;
}

std::size_t AdaptiveSampling::other(std::size_t half) const {
    // A picture of one pixel, for example, has no other half.
    return halves_[half ^ 1].pixels > 0 ? half ^ 1 : half;
}

float AdaptiveSampling::value_of(float exposure) const {
    const auto developed = static_cast<float>(sensor_value(static_cast<double>(exposure), iso_));
    return goal_.unit == NoiseUnit::codes ? code_of(developed) : developed;
}

double AdaptiveSampling::decay_of(std::size_t half) const {
    const int tile = static_cast<int>(half / 2), row = tile / across_, column = tile % across_;
    double last = 0, before = 0, values = 0;
    for (int y = std::max(0, row - 1); y <= std::min(down_ - 1, row + 1); ++y)
        for (int x = std::max(0, column - 1); x <= std::min(across_ - 1, column + 1); ++x) {
            const Half& near = halves_[half_at(y, x, half % 2)];
            if (near.doublings < 2) continue;
            last += near.square * near.pixels;
            before += near.square_before * near.pixels;
            values += 3 * near.pixels;
        }
    if (!(last > 0) || !(before > 0)) return 1;
    // The estimate log2(before / last) less two standard deviations of the logarithm of a ratio of two mean squares
    // over this many values.
    return std::clamp(std::log2(before / last) - 2 * std::numbers::log2e * 2 / std::sqrt(values), 1.0, kMaxDecay);
}

double AdaptiveSampling::goal_variance(const Half& half) const {
    constexpr double kDarkest = 0.01;  // relative noise is not measured below this fraction of white
    const double goal = goal_.unit == NoiseUnit::codes ? goal_.noise : goal_.noise * std::max(half.mean, kDarkest);
    return goal * goal;
}

double AdaptiveSampling::variance_ratio(std::size_t half) const {
    const Half& h = halves_[half];
    const double decay = decay_of(half);
    const double variance = h.square / (std::exp2(decay) - 1) * std::pow(h.doubled_to / h.samples, decay);
    return (variance + h.traced) / goal_variance(h);
}

double AdaptiveSampling::samples_at_goal(std::size_t half) const {
    const Half& h = halves_[half];
    return h.doublings == 0 ? std::numeric_limits<double>::infinity()
                            : h.samples * std::pow(variance_ratio(half) / kMargin, 1 / decay_of(half));
}

double AdaptiveSampling::additional_samples(const Half& half, double end) const {
    const double limit = std::min(half.samples, static_cast<double>(goal_.max_samples) - half.samples);
    if (half.is_finished || half.pixels == 0 || limit < 1) return 0;
    const double step = std::max(1.0, half.samples / 4);
    return std::clamp(std::ceil((end - half.samples) / step) * step, 0.0, limit);
}

std::vector<SampleRange> learning_passes(const SampleRange& range) {
    std::vector<SampleRange> passes;
    const std::uint64_t last = std::uint64_t{range.first} + range.count;
    std::uint64_t first = range.first, end = pixel_pupil::kFirstPass;
    std::uint32_t pass = 0;
    while (first < last) {
        for (; end <= first; end *= 2) ++pass;
        const std::uint64_t count = std::min(end, last) - first;
        passes.push_back(
            {hash32(range.seed, pass), static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(count)});
        first += count;
    }
    return passes;
}

}  // namespace realcam
