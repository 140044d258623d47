// The choice from tables, and of a direction in an environment image by them.

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "bare_scene.hpp"
#include "chi_square.hpp"
#include "math/sampling_tables.hpp"
#include "render/path/light_samples.hpp"
#include "scene/lights/light.hpp"
#include "scene/render_space/render_space_scene.hpp"

using namespace realcam;
using namespace realcam::test;

namespace {

constexpr int kSkySamples = 1 << 18;

Scene under_image(int height, int width, const std::vector<float>& grey) {
    Scene scene = bare_scene();
    scene.environment.height = height;
    scene.environment.width = width;
    for (const float v : grey) scene.environment.pixels.push_back({v, v, v});
    return scene;
}

std::vector<float> uneven(int count, unsigned seed) {
    std::mt19937 engine(seed);
    std::normal_distribution<double> normal(0, 2);
    std::vector<float> values;
    for (int i = 0; i < count; ++i)
        values.push_back(engine() % 10 < 3 ? 0.0f : static_cast<float>(std::exp(normal(engine))));
    return values;
}

std::vector<float> with_pixel(int count, float others, int pixel, float value) {
    std::vector<float> values(static_cast<std::size_t>(count), others);
    values[static_cast<std::size_t>(pixel)] = value;
    return values;
}

// 2 x 2 bins in each pixel, in units of pixels: (row, column).
template <class Sampler>
Bins over_image(const EnvironmentView& e, Sampler&& sampler, unsigned seed) {
    Bins bins(Bins::even(0, e.height, 2 * e.height), Bins::even(0, e.width, 2 * e.width));
    const auto density = [&](double row, double column) {
        const double polar = M_PI * row / e.height, azimuth = 2 * M_PI * (column / e.width - 0.5), r = std::sin(polar);
        const Vec3d d{r * std::sin(azimuth), std::cos(polar), -r * std::cos(azimuth)};
        return static_cast<double>(environment_image_pdf(e, static_cast<Vec3f>(d))) * r * (M_PI / e.height) *
               (2 * M_PI / e.width);
    };
    bins.expect(density, kSkySamples, 1);
    Uniform uniform(seed);
    for (int i = 0; i < kSkySamples; ++i) {
        const Vec3d d = static_cast<Vec3d>(sampler(uniform.pair()).direction);
        bins.add(std::atan2(std::hypot(d.x, d.z), d.y) / M_PI * e.height,
                 (std::atan2(d.x, -d.z) / (2 * M_PI) + 0.5) * e.width);
    }
    return bins;
}

}  // namespace

TEST_CASE("an entry is chosen exactly as often as its probability says, by all numbers there are") {
    std::vector<double> weights = {0, 3, 1e-30, 0, 0, 7, 1e8, 1e-3, 0};
    for (int i = 0; i < 200; ++i) weights.push_back(i % 3 ? 0.01 * i : 0.0);
    std::vector<float> cdf;
    append_cdf(weights, cdf);
    REQUIRE(cdf.size() == weights.size() + 1);
    CHECK(cdf.front() == 0);
    CHECK(cdf.back() == 1);
    std::vector<double> counts(weights.size());
    const int count = static_cast<int>(weights.size());
    for (std::uint32_t i = 0; i < (1u << 24); ++i) {
        const CdfChoice choice = choose_from_cdf(cdf.data(), count, static_cast<float>(i) * 0x1p-24f);
        ++counts[static_cast<std::size_t>(choice.index)];
        REQUIRE((choice.fresh > 0 && choice.fresh < 1));
    }
    double worst = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        const double expected = static_cast<double>(cdf[i + 1] - cdf[i]) * 0x1p24;
        worst = std::max(worst, std::fabs(counts[i] - expected));
        CHECK((weights[i] > 0) == (counts[i] > 0));
    }
    hold({"Samplers", "find_in_cdf: choices of an entry less its probability",
          "all 2^24 numbers, 209 entries from 1e-30 to 1e8", "core", "float32", worst, 0, "choices"});

    // Running sums in float, as a table without steps would hold them.
    std::vector<float> sums{0};
    double total = 0, sum = 0;
    for (const double w : weights) total += w;
    for (const double w : weights) sums.push_back(static_cast<float>((sum += w) / total));
    double lost = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) lost += weights[i] > 0 && sums[i + 1] == sums[i];
    breaks({"Samplers", "find_in_cdf: entries that rounded sums never choose", "209 entries from 1e-30 to 1e8", "core",
            "float32", lost, 0, "entries"});

    // A single entry with a weight, and no entry with a weight.
    for (const std::vector<double>& few : {std::vector<double>{0, 0, 2, 0}, std::vector<double>{0, 0, 0, 0}}) {
        std::vector<float> table;
        append_cdf(few, table);
        CHECK(table.back() == 1);
        for (const Vec2f u : extreme_inputs()) {
            const CdfChoice choice = choose_from_cdf(table.data(), 4, u.x);
            CHECK(choice.probability > 0);
            CHECK((choice.index == 2 || few[2] == 0));
        }
    }
}

TEST_CASE("sample_environment_image follows environment_pdf") {
    ChiSquareTests tests("sample_environment_image");
    const std::vector<Scene> scenes = {
        under_image(8, 16, uneven(128, 1)),
        under_image(16, 32, uneven(512, 2)),
        under_image(8, 16, with_pixel(128, 0, 2 * 16 + 5, 100)),  // one bright pixel
        under_image(8, 16, with_pixel(128, 1, 6 * 16 + 3, 1e8f)),  // and its surroundings not black
        under_image(8, 16, with_pixel(128, 0, 15, 1)),  // at the pole
        under_image(8, 16, with_pixel(128, 1e-30f, 7 * 16 + 15, 1e19f)),
        under_image(1, 1, {3}),
        under_image(2, 64, uneven(128, 3)),
        under_image(64, 2, uneven(128, 4))};
    unsigned seed = 1;
    for (const Scene& scene : scenes) {
        const RenderSpaceScene placed(scene, {0, 0, 0});
        const EnvironmentView e = placed.view().environment;
        tests.add(over_image(e, [&](Vec2f u) { return sample_environment_image(e, u); }, seed++));
    }
    tests.hold();

    ChiSquareTests broken("sample_environment_image with rows mistaken for equal heights");
    const RenderSpaceScene placed(scenes[0], {0, 0, 0});
    const EnvironmentView e = placed.view().environment;
    broken.add(over_image(
        e,
        [&](Vec2f u) {
            LightSample sample = sample_environment_image(e, u);
            const float y = 1 - 2 * std::acos(sample.direction.y) * 0.3183098862f;
            const float scale = std::sqrt((1 - y * y) / (1 - sample.direction.y * sample.direction.y));
            sample.direction = {scale * sample.direction.x, y, scale * sample.direction.z};
            return sample;
        },
        1));
    broken.breaks();

    for (const Scene& scene : scenes) {
        const RenderSpaceScene all(scene, {0, 0, 0});
        for (const Vec2f u : extreme_inputs()) {
            const LightSample sample = sample_environment_image(all.view().environment, u);
            CHECK(std::fabs(length(sample.direction) - 1) < 1e-6f);
            CHECK((sample.irradiance.r >= 0 && std::isfinite(sample.irradiance.r)));
        }
    }
}

TEST_CASE("many samples of an image at once are those that it gives one by one") {
    constexpr int kLanes = 64;
    Uniform uniform(7);
    for (int height = 1; height <= 9; ++height)
        for (int width = 1; width <= 17; ++width) {
            const Scene scene =
                under_image(height, width, uneven(height * width, static_cast<unsigned>(17 * height + width)));
            const RenderSpaceScene placed(scene, {0, 0, 0});
            const EnvironmentView e = placed.view().environment;
            const std::vector<Vec2f> extreme = extreme_inputs();
            Vec2Lanes<float, kLanes> u;
            for (int i = 0; i < kLanes; ++i) {
                const auto k = static_cast<std::size_t>(i);
                u.set(i, k < extreme.size() ? extreme[k] : static_cast<Vec2f>(uniform.pair()));
            }
            const EnvironmentSamples<kLanes> samples(e, u, kLanes);
            for (int i = 0; i < kLanes; ++i) {
                const LightSample a = samples[i], b = sample_environment_image(e, u[i]);
                // Compilers may fuse a product and a sum in one of them: a few roundings of sine and cosine.
                CHECK(length(a.direction - b.direction) < 3e-7f);
                const float sine = std::hypot(b.direction.x, b.direction.z), error = 3e-7f / sine;
                CHECK(std::fabs(a.pdf / b.pdf - 1) < error);
                CHECK(std::fabs(a.irradiance.r - b.irradiance.r) <= error * b.irradiance.r);
            }
        }
}
