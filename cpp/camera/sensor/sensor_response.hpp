#pragma once
#include <algorithm>
#include <array>
#include <vector>

#include "../effects/dispersion/film_spectrum.hpp"
#include "../effects/dispersion/illuminant.hpp"
#include "sensor.hpp"

namespace REALCAM_NAMESPACE {

// Conversion from lux seconds to electrons. The film's colours stand for the spectra into which Mallett and Yuksel's
// basis upsamples them, times the illuminant (film_spectrum.hpp). So the response of a filter is linear in the three
// channels, and a sensor is a 3 x 3 matrix. The film is balanced to its illuminant: (1, 1, 1) is the illuminant's own
// spectrum, of 1 lux second.

/// Rows: red, green and blue filter; columns: red, green and blue of the film.
using SensorMatrix = std::array<double, 9>;

namespace sensor_detail {

/// Linear interpolation between the points of a table, at(point) being its arguments and value(point) its values.
/// Returns `beyond` outside.
template <class Point, class At, class Value>
double interpolated(const std::vector<Point>& points, double x, double beyond, At&& at, Value&& value) {
    if (points.empty() || x < at(points.front()) || x > at(points.back())) return beyond;
    const auto next = std::lower_bound(points.begin(), points.end(), x,
                                       [&](const Point& point, double position) { return at(point) < position; });
    if (next == points.begin()) return value(*next);
    const Point &a = *(next - 1), &b = *next;
    return value(a) + (x - at(a)) / (at(b) - at(a)) * (value(b) - value(a));
}

/// Value of a table at x, linear between its points, 0 outside; 1 for an empty table.
double table_at(const std::vector<SensorPoint>& table, double x);

}  // namespace sensor_detail

/// Electrons per square micrometre for one lux second of each of the film's channels. Throws InputError if the
/// illuminant has no visible light.
SensorMatrix electrons_per_um2(const Sensor& sensor, const Illuminant& illuminant);

/// Filter responses to the illuminant itself, per lux second.
std::array<double, 3> white_of(const SensorMatrix& matrix);

/// Number of electrons at which a well is full. EMVA 1288 measures the saturation capacity where the temporal variance,
/// averaged over the pixels, is largest. For a Poisson number of mean m that is clipped at C it is m v(z). Here z = (C
/// - m) / sqrt(m), and v is the variance of a standard normal number clipped at z. Its derivative by m is v(z) - v'(z)
/// (C + m) / (2 sqrt(m)). Pixels have the means m (1 + PRNU). So C lies some three standard deviations above the
/// saturation capacity.
double full_well_e(double saturation_capacity_e, double prnu_percent);

/// Full well of a sensor, electrons.
inline double full_well_e(const Sensor& sensor) {
    return full_well_e(sensor.conversion.saturation_capacity_e, sensor.noise.prnu_percent);
}

/// ISO speed of a sensor with a given pixel pitch. ISO 12232, saturation-based speed: S = 78 / H, H being the exposure
/// in lux seconds at which white, here under D65, saturates its most sensitive filter.
class SensorSpeed {
public:
    /// Throws InputError if the sensor does not respond to D65.
    SensorSpeed(const Sensor& sensor, double pitch_um);

    /// Lowest and highest ISO; 0 and infinite if the gain is determined by the ISO.
    double lowest_iso() const;
    double highest_iso() const;  ///< at the largest gain
    /// Overall system gain, DN per electron. ISO numbers above the highest get the largest gain; their pictures are
    /// brightened in development. Throws InputError for an ISO number below the lowest.
    double gain_dn_per_e(double iso) const;

private:
    static constexpr double kSaturation = 78;  ///< lux seconds, times the ISO speed

    /// Range of digital numbers above the black level.
    double range_dn() const { return conversion_.largest_dn() - conversion_.black_level_dn; }
    static std::string rounded(double value);

    SensorConversion conversion_;
    double full_well_e_;
    double electrons_per_lux_s_;  ///< response of a pixel with the most sensitive filter, under D65
};

/// Conversion of a sensor's raw values to colours under one illuminant. The film's colours stand for spectra of a basis
/// of three (film_spectrum.hpp), so this is exact, and not a fit over samples.
struct SensorColor {
    std::array<double, 3> white;  ///< filter responses to the illuminant, the largest 1: DNG's AsShotNeutral
    SensorMatrix camera_from_xyz;  ///< from XYZ under the illuminant; white of Y = 1 maps to `white`: DNG's ColorMatrix
    SensorMatrix film_from_balanced;  ///< from raw values divided by `white` to linear Rec. 709
    SensorMatrix d50_from_balanced;  ///< from the same values to XYZ under D50: DNG's ForwardMatrix
};

namespace sensor_detail {

using film_spectrum_detail::inverse;
using film_spectrum_detail::product;

/// Product of a matrix and a vector.
std::array<double, 3> applied(const SensorMatrix& m, const std::array<double, 3>& v);

/// Diagonal matrix.
inline SensorMatrix diagonal(const std::array<double, 3>& v) {
    return {v[0], 0, 0, 0, v[1], 0, 0, 0, v[2]};
}

/// Chromatic adaptation by Bradford's matrix (Lam 1985), as in ICC and DNG. `from_white`, `to_white`: XYZ of the two
/// whites.
SensorMatrix adaptation(const std::array<double, 3>& from_white, const std::array<double, 3>& to_white);

}  // namespace sensor_detail

/// Colour conversion of a sensor. If the sensor cannot distinguish colours under the illuminant, the matrices are those
/// of D65, with the white of the illuminant. Throws InputError if it cannot under D65 either, or if a filter has no
/// response to the illuminant.
SensorColor sensor_color(const Sensor& sensor, const Illuminant& illuminant);

}  // namespace REALCAM_NAMESPACE
