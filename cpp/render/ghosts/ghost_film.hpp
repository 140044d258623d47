#pragma once
#include <algorithm>
#include <cstdint>
#include <limits>

#include "../../math/color.hpp"
#include "../path/sample_range.hpp"
#include "splat_ghosts.hpp"

// Films of splatted light: all light of a picture that is not found by its pixel samples, which are ghosts, starbursts
// and the images of traced lights (GhostLight).

namespace REALCAM_NAMESPACE {

/// Splatted light on one pixel, by channel: irradiance in fixed point, because sums of integers do not depend on their
/// order.
struct GhostSum {
    std::int64_t units[3];
};

/// Returns the number of fixed-point units per lux, for the light of `ghosts`. The unit is a small fraction of the
/// irradiance of a pixel on which all light that enters the front of the lens falls. Ghosts are 1e4 to 1e8 times dimmer
/// than that: 2^-36. The image of a lamp in focus does bring all light to one pixel, with all samples of the film:
/// 2^-28, so that 2^35 samples do not overflow the sum, and a lamp 1e8 times dimmer than another one still counts units
/// in each sample.
inline double ghost_units_per_lux(const SceneView& scene, const CameraView& camera, const GhostView& ghosts) {
    const LightReceiver middle{front_vertex(camera, camera.front_vertex_m), {0, 0, 0}};
    // Upper bound of the illuminance at the front vertex, lux.
    double incident_lux = scene.has_environment ? 4 * static_cast<double>(environment_importance(scene)) : 0.0;
    if (scene.light_node_count > 0) incident_lux += static_cast<double>(max_illuminance(scene.light_nodes[0], middle));
    for (int i = 0; i < scene.sun_count; ++i) incident_lux += static_cast<double>(luminance(scene.suns[i].illuminance));
    const double pixel_mm2 = 4.0 * static_cast<double>(camera.film_half_width) *
                             static_cast<double>(camera.film_half_height) / camera.width / camera.height;
    const double side_mm = 2 * static_cast<double>(ghosts.reach),
                 max_lux = incident_lux * side_mm * side_mm / pixel_mm2;
    const bool is_image = ghosts.light == GhostLight::direct || ghosts.light == GhostLight::starbursts;
    const double units = is_image ? 0x1p28 : 0x1p36;
    return max_lux > 1e-30 ? units / max_lux : units;
}

/// Returns the index of the film (GhostFilmView) to which a block's samples are added. `films`: 1 or 2.
REALCAM_INLINE int film_of_block(std::uint64_t block, int films) {
    return static_cast<int>(block) & (films - 1);
}

/// Converts irradiance to fixed-point units with random rounding, which preserves the mean of values below one unit.
/// `dither`: random number in [0, 1).
REALCAM_INLINE std::int64_t ghost_units(float lux, double units_per_lux, float dither) {
    constexpr double kMaxUnits = 0x1p52;  // larger values would lose integer precision
    const double units = static_cast<double>(lux) * units_per_lux + static_cast<double>(dither);
    return static_cast<std::int64_t>(units < kMaxUnits ? std::floor(units) : kMaxUnits);
}

/// One kind of splatted light of a picture, for its development. If the variance is requested, the light is accumulated
/// in two films: one of the blocks with even indices and one of those with odd indices.
struct GhostFilmView {
    GhostLight light = GhostLight::of_lights;
    const GhostSum* sums = nullptr;  ///< values for all pixels, film by film; null: no light
    int films = 1;  ///< number of films: 1 or 2
    double units_per_lux = 1;  ///< see ghost_units_per_lux
    const unsigned long long* blocks = nullptr;  ///< number of blocks in each film; each has kGhostBlock samples, which
                                                 ///< fall anywhere on the film
    int width = 0, height = 0;  ///< pixels

    /// Irradiance of a pixel, lux. Ghosts are smoothed by a binomial filter of 5 x 5 pixels (standard deviation one
    /// pixel), which loses no relevant detail and reduces their noise as much as thirteen times the samples would.
    REALCAM_HD double irradiance(std::int64_t pixel, int channel) const { return irradiance(pixel, channel, 0, films); }

    /// Variance of the irradiance, lux^2, estimated from the difference between the two films; 0 without light, NaN if
    /// a film has no samples.
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
        unsigned long long block_count = 0;
        for (int film = first_film; sums && film < end; ++film) block_count += blocks[film];
        if (block_count == 0) return 0;
        const double scale = units_per_lux * static_cast<double>(block_count) * kGhostBlock;
        const std::int64_t pixels = std::int64_t{width} * height;
        const GhostSum* const first = sums + first_film * pixels;
        const bool is_two = end - first_film > 1;
        const auto units_at = [&](std::int64_t index) {
            std::int64_t units = first[index].units[channel];
            if (is_two) units += first[index + pixels].units[channel];
            return static_cast<double>(units);
        };
        if (light == GhostLight::starbursts || light == GhostLight::direct) return units_at(pixel) / scale;
        constexpr double kWeights[] = {1, 4, 6, 4, 1}, kSum = 256;  // binomial filter; kSum: of its 25 products
        // Pixels beyond the border repeat the border's own pixel.
        const auto clamp_index = [](int index, int count) { return index < 0 ? 0 : index < count ? index : count - 1; };
        const int column = static_cast<int>(pixel % width), row = static_cast<int>(pixel / width);
        std::int64_t columns[5];
        REALCAM_UNROLL
        for (int x = 0; x < 5; ++x) columns[x] = clamp_index(column + x - 2, width);
        double units = 0;
        for (int y = 0; y < 5; ++y) {
            const std::int64_t line = static_cast<std::int64_t>(clamp_index(row + y - 2, height)) * width;
            double of_row = 0;
            REALCAM_UNROLL
            for (int x = 0; x < 5; ++x) of_row += kWeights[x] * units_at(line + columns[x]);
            units += kWeights[y] * of_row;
        }
        return units / kSum / scale;
    }
};

/// All splatted light of a picture.
struct SplattedLight {
    GhostFilmView films[kMaxGhostViews];  ///< one for each kind of light; those without light are empty

    /// Irradiance of a pixel by all kinds of light, lux.
    REALCAM_HD double irradiance(std::int64_t pixel, int channel) const {
        double sum = 0;
        for (const GhostFilmView& film : films) sum += film.irradiance(pixel, channel);
        return sum;
    }
    /// Variance of that irradiance, lux^2.
    double variance(std::int64_t pixel, int channel) const {
        double sum = 0;
        for (const GhostFilmView& film : films) sum += film.variance(pixel, channel);
        return sum;
    }
};

/// Range [first, end) of blocks of splatted samples.
struct GhostBlocks {
    std::uint64_t first, end;
};

/// Returns the blocks of splatted samples that belong to a range of samples of each pixel.
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
