#pragma once
#include <algorithm>
#include <cstdint>
#include <limits>

#include "../../math/color.hpp"
#include "../path/sample_range.hpp"
#include "splat_ghosts.hpp"

namespace REALCAM_NAMESPACE {

/// Ghosts on one pixel: irradiance in fixed point, because sums of integers do not depend on their order.
struct GhostSum {
    std::int64_t units[3];
};

/// The unit is a small fraction of the irradiance of a pixel on which all light that enters the front of the lens
/// falls. Ghosts are 1e4 to 1e8 times dimmer than that: 2^-36. The image of a lamp in focus does bring all light to one
/// pixel, with all samples of the film: 2^-28, so that 2^35 samples do not overflow the sum, and a lamp 1e8 times
/// dimmer than another one still counts units in each sample.
inline double ghost_units_per_lux(const SceneView& scene, const CameraView& camera, const GhostView& ghosts) {
    const LightReceiver middle{front_vertex(camera, camera.front_vertex_m), {0, 0, 0}};
    double light = scene.has_environment ? 4 * static_cast<double>(environment_importance(scene)) : 0.0;
    if (scene.light_node_count > 0) light += static_cast<double>(most_illuminance(scene.light_nodes[0], middle));
    for (int i = 0; i < scene.sun_count; ++i) light += static_cast<double>(luminance(scene.suns[i].illuminance));
    const double pixel_mm2 = 4.0 * static_cast<double>(camera.film_half_width) *
                             static_cast<double>(camera.film_half_height) / camera.width / camera.height;
    const double side_mm = 2 * static_cast<double>(ghosts.reach), most = light * side_mm * side_mm / pixel_mm2;
    const bool is_image = ghosts.light == GhostLight::direct || ghosts.light == GhostLight::starbursts;
    const double units = is_image ? 0x1p28 : 0x1p36;
    return most > 1e-30 ? units / most : units;
}

/// Index of the film (GhostFilmView) to which a block's samples are added.
REALCAM_INLINE int film_of_block(std::uint64_t block, int films) {
    return static_cast<int>(block) & (films - 1);
}

/// Converts irradiance to units. `dither`: random number in [0, 1), so that the mean of values below one unit is
/// preserved.
REALCAM_INLINE std::int64_t ghost_units(float lux, double units_per_lux, float dither) {
    constexpr double kMost = 0x1p52;
    const double units = static_cast<double>(lux) * units_per_lux + static_cast<double>(dither);
    return static_cast<std::int64_t>(units < kMost ? std::floor(units) : kMost);
}

/// One kind of a picture's light that was traced apart from its samples, to be added to their light. If the variance is
/// requested, there are two films, of the blocks with even and with odd indices.
struct GhostFilmView {
    GhostLight light = GhostLight::of_lights;
    const GhostSum* sums = nullptr;  ///< values for all pixels, film by film; null: no light
    int films = 1;
    double units_per_lux = 1;
    const unsigned long long* blocks = nullptr;  ///< blocks in each film, of kGhostBlock samples of the whole film
    int width = 0, height = 0;  ///< pixels

    /// Irradiance of a pixel. Ghosts are smoothed by one pixel (a binomial filter of five by five), which loses no
    /// relevant detail and reduces their noise as much as thirteen times the samples would.
    REALCAM_HD double irradiance(std::int64_t pixel, int channel) const { return irradiance(pixel, channel, 0, films); }

    /// Variance of the irradiance, lux^2, by the difference between the two films. NaN if one has no sample.
    double variance(std::int64_t pixel, int channel) const {
        if (!sums) return 0;
        if (films < 2 || blocks[0] == 0 || blocks[1] == 0) return std::numeric_limits<double>::quiet_NaN();
        const double a = static_cast<double>(blocks[0]), b = static_cast<double>(blocks[1]);
        const double difference = irradiance(pixel, channel, 0, 1) - irradiance(pixel, channel, 1, 2);
        return difference * difference * a * b / ((a + b) * (a + b));
    }

private:
    /// Irradiance from the films [first_film, end).
    REALCAM_HD double irradiance(std::int64_t pixel, int channel, int first_film, int end) const {
        unsigned long long taken = 0;
        for (int film = first_film; sums && film < end; ++film) taken += blocks[film];
        if (taken == 0) return 0;
        const double scale = units_per_lux * static_cast<double>(taken) * kGhostBlock;
        const std::int64_t pixels = std::int64_t{width} * height;
        const GhostSum* const first = sums + first_film * pixels;
        const bool is_two = end - first_film > 1;
        const auto units_at = [&](std::int64_t at) {
            std::int64_t units = first[at].units[channel];
            if (is_two) units += first[at + pixels].units[channel];
            return static_cast<double>(units);
        };
        if (light == GhostLight::starbursts || light == GhostLight::direct) return units_at(pixel) / scale;
        constexpr double kWeights[] = {1, 4, 6, 4, 1}, kSum = 256;
        // Pixels beyond the border repeat the border's own pixel.
        const auto inside = [](int index, int count) { return index < 0 ? 0 : index < count ? index : count - 1; };
        const int column = static_cast<int>(pixel % width), row = static_cast<int>(pixel / width);
        std::int64_t columns[5];
        REALCAM_UNROLL
        for (int x = 0; x < 5; ++x) columns[x] = inside(column + x - 2, width);
        double units = 0;
        for (int y = 0; y < 5; ++y) {
            const std::int64_t line = static_cast<std::int64_t>(inside(row + y - 2, height)) * width;
            double of_row = 0;
            REALCAM_UNROLL
            for (int x = 0; x < 5; ++x) of_row += kWeights[x] * units_at(line + columns[x]);
            units += kWeights[y] * of_row;
        }
        return units / kSum / scale;
    }
};

/// All light of a picture that was traced apart from the samples of its pixels.
struct SplattedLight {
    GhostFilmView films[kMostSplats];

    REALCAM_HD double irradiance(std::int64_t pixel, int channel) const {
        double sum = 0;
        for (const GhostFilmView& film : films) sum += film.irradiance(pixel, channel);
        return sum;
    }
    double variance(std::int64_t pixel, int channel) const {
        double sum = 0;
        for (const GhostFilmView& film : films) sum += film.variance(pixel, channel);
        return sum;
    }
};

/// Range of blocks of samples of the whole film.
struct GhostBlocks {
    std::uint64_t first, end;
};

/// The blocks that belong to some samples of each pixel.
inline GhostBlocks ghost_blocks(const CameraView& camera, const SampleRange& range, const GhostView& ghosts) {
    const std::uint64_t pixels = static_cast<std::uint64_t>(camera.width) * static_cast<std::uint64_t>(camera.height),
                        per_block = kGhostBlock * static_cast<std::uint64_t>(ghosts.pixel_samples);
    // At least one block for each sample, so that twice the samples are twice the blocks in small pictures, too:
    // AdaptiveSampling measures noise by the change of a picture with doubled samples.
    const auto up_to = [&](std::uint64_t samples) {
        return std::max(samples, (samples * pixels + per_block - 1) / per_block);
    };
    return {up_to(range.first), up_to(std::uint64_t{range.first} + range.count)};
}

}  // namespace REALCAM_NAMESPACE
