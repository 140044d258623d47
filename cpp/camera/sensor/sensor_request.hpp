#pragma once
#include <cmath>
#include <cstdint>

#include "../../math/lanes.hpp"
#include "../../math/random_variates.hpp"

namespace REALCAM_NAMESPACE {

// Response of a sensor to the film's exposure, after the linear model of EMVA standard 1288 (release 4.0 linear).
// Photons become electrons, up to the full well. The gain converts electrons to digital numbers, to which the black
// level is added.

/// Response of a pixel to light at an angle, relative to light along the axis. Tabulated uniformly over the squared
/// tangent of the angle, which is linear in the squared distance from the axis.
struct AngularResponse {
    static constexpr int kSteps = 64;
    float at[kSteps + 1];  ///< response at each step
    float steps_per_square;  ///< steps per square pixel of squared distance; 0: no dependence on the angle
    float middle_column, middle_row;  ///< pixel coordinates of the lens's axis
};

/// Part of a sensor's picture that expose_rows computes. Plain data, because it is passed to one of several builds of
/// the code, the fastest one on the CPU.
struct SensorRequest {
    const float* exposure;  ///< rows * width * 3, lux seconds, linear Rec. 709
    std::uint16_t* raw;     ///< result: rows * width, digital numbers
    std::int32_t width, first_row, row_count;  ///< the pointers refer to the first of these rows
    /// Electrons for one lux second of each channel, indexed by (row % 2) * 2 + column % 2 in the mosaic.
    float electrons[4][3];
    AngularResponse angular_response;
    float response_deviation;  ///< photo-response non-uniformity, relative standard deviation
    float offset_deviation_e;  ///< dark signal non-uniformity, standard deviation
    float dark_electrons;  ///< mean number of dark electrons of a pixel in the exposure time
    float hot_share, hot_electrons;  ///< fraction of hot pixels, and the mean of their additional electrons
    float full_well_e;  ///< may be infinite
    float read_noise_e, row_noise_e;  ///< before the gain, standard deviations
    float converter_noise_dn;  ///< after the gain, standard deviation
    float gain_dn_per_e, black_level_dn;
    float largest_dn;  ///< largest digital number of the converter
    std::uint32_t seed, serial;  ///< seeds of the noise of this exposure, and of the sensor's fixed pattern
};

/// Random numbers of a pixel: functions of pixel, seed and dimension alone.
namespace sensor_noise {

/// Random stream of a pixel or row of index `pixel`. The seed enters twice: otherwise another seed would give the same
/// numbers to other pixels.
REALCAM_INLINE std::uint32_t stream(std::uint32_t pixel, std::uint32_t seed) {
    return hash32(pixel, seed) ^ hash32(seed, 0x5eed);
}

/// Dimensions of read noise and row noise, far beyond the attempts of Poisson sampling, which use the same stream.
inline constexpr std::uint32_t kRead = 0x10000, kRow = 0x10002;
/// Dimensions of a pixel's response and offset, and of its hot current, in the stream of the serial number.
inline constexpr std::uint32_t kPattern = 0, kHot = 2;

/// Current of a hot pixel in units of its mean, exponentially distributed; 0 for all but a fraction of the pixels.
REALCAM_INLINE float hot_current(std::uint32_t bits, float hot_fraction) {
    const float u = positive_unit_float(bits);
    return u < hot_fraction ? -log_of_positive(u / hot_fraction) : 0.0f;
}

}  // namespace sensor_noise

/// N consecutive pixels in a row of a mosaic.
template <int N>
struct SensorLanes {
    alignas(64) float light_e[N];  ///< expected photoelectrons, without variation between pixels
    alignas(64) double mean[N];  ///< expected electrons
    alignas(64) double count[N];  ///< electrons, a Poisson variate
    alignas(64) std::uint32_t stream[N];  ///< random stream of each pixel in this exposure
    alignas(64) std::int32_t is_pending[N];  ///< 1: the first attempt of rejection sampling failed
    alignas(64) float offset_e[N];  ///< fixed-pattern offset and read noise
    alignas(64) float converter_dn[N];  ///< noise after the gain
};

namespace sensor_detail {

/// Interpolated angular response at a pixel.
REALCAM_INLINE float angular_response(const AngularResponse& response, float column, float row) {
    const float x = column - response.middle_column, y = row - response.middle_row;
    const float position = (x * x + y * y) * response.steps_per_square;
    const float last = AngularResponse::kSteps;
    const float inside = position < last ? position : last;
    const std::int32_t step = static_cast<std::int32_t>(inside),
                       lower = step < AngularResponse::kSteps - 1 ? step : AngularResponse::kSteps - 1;
    const float fraction = inside - static_cast<float>(lower);
    return response.at[lower] + fraction * (response.at[lower + 1] - response.at[lower]);
}

/// Upper bound for the expected electrons of a pixel: beyond it, even with 40 standard deviations of noise, either the
/// well is full or the converter saturates. Keeps sums finite for any exposure.
REALCAM_INLINE float max_expected_electrons(const SensorRequest& request) {
    const float converter = request.largest_dn / request.gain_dn_per_e;
    const float saturation = request.full_well_e < converter ? request.full_well_e : converter;
    const float limit = saturation < 1e15f ? saturation : 1e15f;  // far below 2^53: exact in a double
    return limit +
           40.0f * (std::sqrt(limit) + request.read_noise_e + request.row_noise_e + request.offset_deviation_e) +
           1000.0f;
}

/// Clamps light, so that sums of it are finite; NaN is kept.
REALCAM_INLINE float clamp_light(float light) {
    const float below = light > 1e24f ? 1e24f : light;
    return below < -1e24f ? -1e24f : below;
}

/// Sets the expected photoelectrons, without variation between pixels. `row`, `column`: of the first pixel; `exposure`:
/// three values for each pixel.
template <int N>
void set_expected_light(const SensorRequest& request, std::int32_t row, std::int32_t column, const float* exposure,
                        SensorLanes<N>& lanes) {
    const float (&even)[3] = request.electrons[(row & 1) * 2];
    const float (&odd)[3] = request.electrons[(row & 1) * 2 + 1];
    REALCAM_LANES
    for (int k = 0; k < N; ++k) {
        const bool is_odd = ((column + k) & 1) != 0;
        const float r = clamp_light(exposure[3 * k]), g = clamp_light(exposure[3 * k + 1]),
                    b = clamp_light(exposure[3 * k + 2]);
        lanes.light_e[k] = select(is_odd, odd[0], even[0]) * r + select(is_odd, odd[1], even[1]) * g +
                           select(is_odd, odd[2], even[2]) * b;
    }
    if (!(request.angular_response.steps_per_square > 0)) return;
    REALCAM_LANES
    for (int k = 0; k < N; ++k)
        lanes.light_e[k] *=
            angular_response(request.angular_response, static_cast<float>(column + k), static_cast<float>(row));
}

/// Adds the fixed pattern of each pixel: response, dark electrons and offset. `max_electrons`: max_expected_electrons.
template <int N>
void add_pattern(const SensorRequest& request, std::uint32_t first_pixel, float max_electrons, SensorLanes<N>& lanes) {
    REALCAM_LANES
    for (int k = 0; k < N; ++k) {
        const std::uint32_t pattern = sensor_noise::stream(first_pixel + static_cast<std::uint32_t>(k), request.serial);
        const Vec2f fixed =
            normal_pair(hash32(pattern, sensor_noise::kPattern), hash32(pattern, sensor_noise::kPattern + 1));
        const float photoelectrons = lanes.light_e[k] * (1.0f + request.response_deviation * fixed.x);
        const float hot = sensor_noise::hot_current(hash32(pattern, sensor_noise::kHot), request.hot_share);
        const float mean =
            // NaN counts as no light.
            (photoelectrons > 0.0f ? photoelectrons : 0.0f) + request.dark_electrons + request.hot_electrons * hot;
        lanes.mean[k] = static_cast<double>(mean < max_electrons ? mean : max_electrons);
        lanes.offset_e[k] = request.offset_deviation_e * fixed.y;
    }
}

/// Samples Poisson counts of small means by inversion, some lanes at a time, so that few wait for one of a larger mean.
template <int N>
void draw_small_means(SensorLanes<N>& lanes) {
    constexpr int kGroup = 32;
    static_assert(N % kGroup == 0);
    alignas(64) double mean[kGroup], u[kGroup], count[kGroup];
    for (int first = 0; first < N; first += kGroup) {
        bool is_any_small = false;
        for (int k = 0; k < kGroup; ++k) {
            const double m = lanes.mean[first + k];
            is_any_small |= (m < kLargestInvertedMean) & (m > 0);
        }
        if (!is_any_small) {
            for (int k = 0; k < kGroup; ++k) lanes.count[first + k] = 0;
            continue;
        }
        REALCAM_LANES
        for (int k = 0; k < kGroup; ++k) {
            const std::uint32_t stream = lanes.stream[first + k];
            mean[k] = lanes.mean[first + k] < kLargestInvertedMean ? lanes.mean[first + k] : 0.0;
            u[k] = open_unit_double(attempt_bits(stream, 0, 0)) +
                   (open_unit_double(attempt_bits(stream, 0, 1)) - 0.5) * 0x1p-32;
        }
        invert_poisson(mean, u, count);
        for (int k = 0; k < kGroup; ++k) lanes.count[first + k] = count[k];
    }
}

/// Samples Poisson counts of larger means by rejection. Most come from the first attempt, which all lanes make
/// together; the remaining ones are drawn one by one.
template <int N>
void draw_large_means(SensorLanes<N>& lanes) {
    std::int32_t pending = 0;
    REALCAM_LANES
    for (int k = 0; k < N; ++k) {
        const bool is_large = lanes.mean[k] >= kLargestInvertedMean;
        const PoissonHat hat(is_large ? lanes.mean[k] : kLargestInvertedMean);
        const PoissonAttempt attempt = hat.attempt(open_unit_double(attempt_bits(lanes.stream[k], 0, 0)),
                                                   open_unit_double(attempt_bits(lanes.stream[k], 0, 1)));
        lanes.count[k] = is_large ? attempt.count : lanes.count[k];
        lanes.is_pending[k] = (is_large & !attempt.is_accepted) ? 1 : 0;
        pending += lanes.is_pending[k];
    }
    if (pending == 0) return;
    for (int k = 0; k < N; ++k)
        if (lanes.is_pending[k]) lanes.count[k] = poisson_by_rejection(lanes.mean[k], lanes.stream[k]);
}

/// Adds read noise and the noise of the row, `row_offset_e`, and draws the converter's noise.
template <int N>
void add_read_noise(const SensorRequest& request, float row_offset_e, SensorLanes<N>& lanes) {
    REALCAM_LANES
    for (int k = 0; k < N; ++k) {
        const Vec2f noise =
            normal_pair(hash32(lanes.stream[k], sensor_noise::kRead), hash32(lanes.stream[k], sensor_noise::kRead + 1));
        lanes.offset_e[k] += row_offset_e + request.read_noise_e * noise.x;
        lanes.converter_dn[k] = request.converter_noise_dn * noise.y;
    }
}

/// Converts electrons to digital numbers, with half a number added for rounding by truncation.
template <int N>
void convert_to_dn(const SensorRequest& request, const SensorLanes<N>& lanes, float (&dn)[N]) {
    REALCAM_LANES
    for (int k = 0; k < N; ++k) {
        const float count = static_cast<float>(lanes.count[k]);
        const float electrons = count < request.full_well_e ? count : request.full_well_e;
        const float value = request.black_level_dn + request.gain_dn_per_e * (electrons + lanes.offset_e[k]) +
                            lanes.converter_dn[k] + 0.5f;
        const float above = value > 0.0f ? value : 0.0f;
        dn[k] = above < request.largest_dn ? above : request.largest_dn;
    }
}

}  // namespace sensor_detail

/// Computes the raw values of the rows of a request, N pixels at a time. Every value is a function of the pixel and the
/// seeds, so rows may be processed in any order.
template <int N>
void expose_rows(const SensorRequest& request) {
    using namespace sensor_detail;
    SensorLanes<N> lanes;
    alignas(64) float exposure[3 * N];
    alignas(64) float dn[N];
    const float max_electrons = max_expected_electrons(request);
    for (std::int32_t y = 0; y < request.row_count; ++y) {
        const std::int32_t row = request.first_row + y;
        const std::uint32_t row_stream = sensor_noise::stream(static_cast<std::uint32_t>(row), request.seed);
        const float row_offset_e =
            request.row_noise_e *
            normal_pair(hash32(row_stream, sensor_noise::kRow), hash32(row_stream, sensor_noise::kRow + 1)).x;
        for (std::int32_t column = 0; column < request.width; column += N) {
            const std::int32_t left = request.width - column, used = left < N ? left : N;
            const std::ptrdiff_t position = static_cast<std::ptrdiff_t>(y) * request.width + column;
            const float* from = request.exposure + 3 * position;
            if (used < N) {
                for (int k = 0; k < 3 * N; ++k) exposure[k] = k < 3 * used ? from[k] : 0.0f;
                from = exposure;
            }
            const std::uint32_t first = static_cast<std::uint32_t>(row) * static_cast<std::uint32_t>(request.width) +
                                        static_cast<std::uint32_t>(column);
            REALCAM_LANES
            for (int k = 0; k < N; ++k)
                lanes.stream[k] = sensor_noise::stream(first + static_cast<std::uint32_t>(k), request.seed);
            set_expected_light(request, row, column, from, lanes);
            add_pattern(request, first, max_electrons, lanes);
            draw_small_means(lanes);
            draw_large_means(lanes);
            add_read_noise(request, row_offset_e, lanes);
            convert_to_dn(request, lanes, dn);
            for (int k = 0; k < used; ++k)
                request.raw[position + k] = static_cast<std::uint16_t>(static_cast<int>(dn[k]));
        }
    }
}

}  // namespace REALCAM_NAMESPACE
