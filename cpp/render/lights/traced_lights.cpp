#include "traced_lights.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>

#include "../../math/color.hpp"
#include "../../math/random.hpp"
#include "../../math/sampling_tables.hpp"
#include "light_entries.hpp"

namespace realcam {
namespace {

/// Desired number of samples of a light, for each pixel that its light covers and for each sample of that pixel.
constexpr double kSamplesPerPixel = 6;
constexpr std::int32_t kMinPixelSamples = 2, kMaxPixelSamples = 64;  ///< limits for pixel_samples_
/// Largest n of a sampling probability 2^-n. The table from sample indices to lights has up to 2^n entries.
constexpr int kMaxHalvings = 12;

/// Returns for each weight the exponent n of a sampling probability 2^-n, so that the probabilities approximate the
/// weights (up to a common factor) and their sum is 1. There are at most 2^kMaxHalvings weights.
std::vector<int> halvings_of(const std::vector<double>& weights) {
    double sum = 0;
    for (const double weight : weights) sum += weight;
    std::vector<int> halvings;
    std::int64_t left = std::int64_t{1} << kMaxHalvings;  // 1 less the sum of probabilities, in units of the smallest
    for (const double weight : weights) {
        const int count = static_cast<int>(std::ceil(std::log2(sum / weight)));
        halvings.push_back(std::clamp(count, 0, kMaxHalvings));
        left -= std::int64_t{1} << (kMaxHalvings - halvings.back());
    }
    const auto weight_over_probability = [&](std::size_t i) { return weights[i] * std::exp2(halvings[i]); };
    // If the sum exceeds 1, because small weights were raised to the smallest probability, the probabilities that are
    // largest for their weights are halved; if it is less, those that are smallest for their weights are doubled.
    while (left < 0) {
        std::size_t most_oversampled = halvings.size();
        for (std::size_t i = 0; i < halvings.size(); ++i)
            if (halvings[i] < kMaxHalvings && (most_oversampled == halvings.size() ||
                                               weight_over_probability(i) < weight_over_probability(most_oversampled)))
                most_oversampled = i;
        left += std::int64_t{1} << (kMaxHalvings - ++halvings[most_oversampled]);
    }
    while (left > 0) {
        std::size_t most_undersampled = halvings.size();
        for (std::size_t i = 0; i < halvings.size(); ++i)
            if (std::int64_t{1} << (kMaxHalvings - halvings[i]) <= left &&
                (most_undersampled == halvings.size() ||
                 weight_over_probability(i) > weight_over_probability(most_undersampled)))
                most_undersampled = i;
        left -= std::int64_t{1} << (kMaxHalvings - halvings[most_undersampled]--);
    }
    return halvings;
}

}  // namespace

TracedLights::TracedLights(const SceneView& scene, const CameraView& camera, const CameraSetup& setup,
                           LightTracing tracing, const PupilTracer& tracer) {
    std::vector<LightGroup> groups = light_groups(scene, camera);
    if (groups.empty()) return;
    const LightEntries entries(scene, camera, setup, tracer);
    std::vector<std::optional<FoundLight>> found(groups.size());
    tracer.for_each(static_cast<int>(groups.size()), [&](int i) {
        const auto k = static_cast<std::size_t>(i);
        found[k] = entries.find(groups[k]);
    });
    std::vector<std::size_t> visible;  // indices of the groups whose light reaches the film
    for (std::size_t k = 0; k < groups.size(); ++k)
        if (found[k]) visible.push_back(k);
    // If there are more lights than the table from sample indices to lights can hold, those that cover the most pixels
    // are traced.
    std::stable_sort(visible.begin(), visible.end(),
                     [&](std::size_t a, std::size_t b) { return found[a]->pixels > found[b]->pixels; });
    visible.resize(std::min<std::size_t>(visible.size(), std::size_t{1} << kMaxHalvings));
    if (visible.empty()) return;

    double covered = 0;
    std::vector<double> weights;
    for (const std::size_t k : visible) {
        covered += found[k]->pixels;
        weights.push_back(found[k]->pixels);
    }
    const double pixels = static_cast<double>(camera.width) * camera.height;
    pixel_samples_ = static_cast<std::int32_t>(std::clamp(std::round(pixels / (kSamplesPerPixel * covered)),
                                                          double{kMinPixelSamples}, double{kMaxPixelSamples}));
    const std::vector<int> halvings = halvings_of(weights);

    // Mean density of pixel samples: film area times the projected solid angle of the exit pupil
    // (TracedLightsView::scale).
    const double radius = static_cast<double>(camera.thick.exit_pupil_radius),
                 distance = static_cast<double>(camera.thick.exit_pupil_distance);
    const double film_area =
        4 * static_cast<double>(camera.film_half_width) * static_cast<double>(camera.film_half_height);
    scale_ = static_cast<float>(film_area * std::numbers::pi * radius * radius /
                                (radius * radius + distance * distance) / pixel_samples_);
    // With an infinite density, the MIS weight of pixel samples is 0.
    if (tracing == LightTracing::alone) scale_ = std::numeric_limits<float>::infinity();
    light_of_area_.assign(static_cast<std::size_t>(scene.area_count), -1);
    share_of_area_.assign(light_of_area_.size(), 0);
    for (std::size_t i = 0; i < visible.size(); ++i) {
        TracedLight light = found[visible[i]]->light;
        light.halvings = halvings[i];
        light.probability = std::exp2(static_cast<float>(-halvings[i]));
        add(scene, groups[visible[i]], light);
    }
    set_turns();
}

void TracedLights::add(const SceneView& scene, const LightGroup& group, TracedLight light) {
    light.first = group.lights.front();
    light.count = 1;
    if (group.kind == TracedLightKind::triangles) {
        light.first = static_cast<std::int32_t>(triangles_.size());
        light.count = static_cast<std::int32_t>(group.lights.size());
        std::vector<double> powers;
        for (const std::int32_t area : group.lights)
            powers.push_back(static_cast<double>(scene.areas[area].area * luminance(scene.areas[area].radiance)));
        const std::size_t begin = cdfs_.size();
        append_cdf(powers, cdfs_);
        for (std::size_t k = 0; k < group.lights.size(); ++k) {
            const auto area = static_cast<std::size_t>(group.lights[k]);
            light_of_area_[area] = static_cast<std::int32_t>(lights_.size());
            share_of_area_[area] = cdfs_[begin + k + 1] - cdfs_[begin + k];
        }
        triangles_.insert(triangles_.end(), group.lights.begin(), group.lights.end());
    } else {
        // One entry for each other light: a light's table then begins at the index of its first triangle plus that of
        // the light.
        cdfs_.push_back(0);
    }
    lights_.push_back(light);
}

void TracedLights::set_turns() {
    std::vector<std::int32_t> order(lights_.size());
    std::iota(order.begin(), order.end(), 0);
    const auto halvings = [&](std::int32_t light) { return lights_[static_cast<std::size_t>(light)].halvings; };
    // The table maps a sample's index to its light. In bit-reversed order, each light owns an interval of indices;
    // sorted by length, each interval begins at a multiple of its length, so that the samples of the light are equally
    // spaced.
    std::stable_sort(order.begin(), order.end(),
                     [&](std::int32_t a, std::int32_t b) { return halvings(a) < halvings(b); });
    const int bits = halvings(order.back());
    turns_.resize(std::size_t{1} << bits);
    std::uint32_t reversed = 0;
    for (const std::int32_t light : order)
        for (std::uint32_t end = reversed + (1u << (bits - halvings(light))); reversed < end; ++reversed)
            turns_[bits > 0 ? reverse_bits(reversed) >> (32 - bits) : 0] = light;
}

TracedLightsView TracedLights::view() const {
    const auto size = [](const auto& list) { return static_cast<std::int32_t>(list.size()); };
    return {lights_.data(), size(lights_),    turns_.data(),         size(turns_),          triangles_.data(),
            cdfs_.data(),   size(triangles_), light_of_area_.data(), share_of_area_.data(), size(light_of_area_),
            scale_};
}

TracedLights traced_lights(const SceneView& scene, const CameraView& camera, const CameraSetup& setup,
                           LightTracing tracing, const PupilTracer& tracer) {
    if (!setup.traces_lights() || tracing == LightTracing::off) return {};
    return TracedLights(scene, camera, setup, tracing, tracer);
}

double least_lamp_share(const SceneView& scene, const CameraView& camera, const CameraSetup& setup,
                        LightTracing tracing) {
    if (setup.traces_lights() && tracing != LightTracing::off) return 1;
    const Vec3f front = front_vertex(camera, camera.front_vertex_m);
    const double cosine = std::cos(setup.widest_angle());
    double least = 1;
    for (const LightGroup& group : light_groups(scene, camera)) {
        if (group.kind != TracedLightKind::triangles) continue;  // rays cannot hit points and suns
        const Vec3f offset = scene.areas[group.lights.front()].corner - front;
        const bool is_in_view =
            static_cast<double>(-dot(offset, camera.backward)) > cosine * static_cast<double>(length(offset));
        if (is_in_view || camera.key_count > 0) least = std::min(least, group.filled_fraction);
    }
    return least;
}

std::vector<GhostView> splatted_lights(const CameraSetup& setup, const TracedLights& lights) {
    std::vector<GhostView> views = setup.effects().splats();
    if (!lights.empty())
        views.push_back(setup.effects().direct_lens_path().view(GhostLight::direct, lights.pixel_samples()));
    return views;
}

}  // namespace realcam
