#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "../../error.hpp"
#include "../../platform.hpp"

namespace REALCAM_NAMESPACE {

// A sensor as its data sheet describes it, by the linear model of EMVA standard 1288. A property that the sheet does
// not state keeps the value without effect, and `assumptions` lists what the sensor file had to assume.

/// Electrons per photon on the pixel's area, for the red, green and blue filter; three equal values without filters.
struct QuantumEfficiency {
    double wavelength_nm;
    std::array<double, 3> electrons_per_photon;

    bool operator==(const QuantumEfficiency&) const = default;
};

/// Point of a table: transmission by wavelength (nm), or relative response by angle (degrees).
struct SensorPoint {
    double at;     ///< wavelength or angle
    double value;  ///< from 0 to 1

    bool operator==(const SensorPoint&) const = default;
};

/// The conversion from electrons to digital numbers (DN).
struct SensorConversion {
    double gain_dn_per_e = 0;    ///< overall system gain K at the lowest ISO; 0: determined by the ISO
    double largest_gain_db = 0;  ///< largest gain in addition to gain_dn_per_e, dB (20 log10 of the factor)
    double saturation_capacity_e = std::numeric_limits<double>::infinity();  ///< as EMVA 1288 measures it
    int adc_bits = 16;
    double black_level_dn = 0;  ///< digital number of a pixel without electrons
    double converter_noise_dn = 0;  ///< noise added after the gain, standard deviation

    bool operator==(const SensorConversion&) const = default;
    /// Largest digital number of the converter.
    double largest_dn() const { return std::ldexp(1.0, adc_bits) - 1; }
};

/// Noise and dark signal of a sensor: standard deviations and means in electrons.
struct SensorNoise {
    double read_noise_e = 0;  ///< temporal dark noise without exposure time, before the gain
    double row_noise_e = 0;   ///< common to all pixels of a row, different in each exposure
    double dark_current_e_per_s = 0;  ///< mean of a pixel, at dark_current_temperature_c
    double dark_current_temperature_c = 20;
    double dark_current_doubling_k = 0;  ///< temperature interval over which the dark current doubles; 0: unknown
    double dsnu_e = 0;  ///< dark signal non-uniformity: standard deviation of the pixels' offsets
    double prnu_percent = 0;  ///< photo-response non-uniformity: relative standard deviation of the pixels' responses
    double hot_pixel_share = 0;  ///< fraction of the pixels that are hot
    double hot_pixel_current_e_per_s = 0;  ///< mean current of the hot pixels, in addition to the dark current

    bool operator==(const SensorNoise&) const = default;
};

/// Image sensor.
struct Sensor {
    std::string name, title, source;  ///< short name, full name, and origin of the data
    std::vector<std::string> assumptions;  ///< properties that are not published, and the values assumed for them
    double pixel_pitch_um = 0;  ///< 0: pitch of the film's pixels
    int columns = 0, rows = 0;  ///< number of pixels; 0: not fixed
    std::string color_filter_array;  ///< "RGGB" and so on: two rows of two, from the top left; empty: none
    std::vector<QuantumEfficiency> quantum_efficiency;  ///< linear between its points, 0 beyond
    std::vector<SensorPoint> cover_glass;  ///< transmission over nm; empty: 1
    std::vector<SensorPoint> angular_response;  ///< of microlenses, over degrees from the axis; empty: 1
    SensorConversion conversion;
    SensorNoise noise;

    bool operator==(const Sensor&) const = default;
    bool has_filters() const { return !color_filter_array.empty(); }
};

/// Supported colour filter arrays, for messages.
inline constexpr const char* kFilterArrays = "RGGB, BGGR, GRBG or GBRG, or absent";

/// True if a colour filter array is supported.
inline bool is_filter_array(const std::string& name) {
    return name == "RGGB" || name == "BGGR" || name == "GRBG" || name == "GBRG";
}

namespace sensor_detail {

/// Throws InputError: the key of the sensor file must be as described in `requirement`.
[[noreturn]] void fail(const std::string& key, const std::string& requirement);

/// Throws InputError unless the arguments of a table, at(point), are finite, at least 0 and strictly increasing, and
/// `is_good` is true for all points. `key`: key of the table in the sensor file.
template <class Point>
void require_table(const std::string& key, const std::vector<Point>& points, double (*at)(const Point&),
                   bool (*is_good)(const Point&)) {
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (!std::isfinite(at(points[i])) || !(at(points[i]) >= 0))
            fail(key, "a table whose first column has numbers of at least 0");
        if (i > 0 && !(at(points[i]) > at(points[i - 1]))) fail(key, "a table whose first column increases strictly");
        if (!is_good(points[i])) fail(key, "a table of values from 0 to 1");
    }
}

/// True if a temperature is physical, and at most 1000 degrees Celsius.
inline bool is_temperature(double celsius) {
    return celsius >= -273.15 && celsius <= 1000;
}

}  // namespace sensor_detail

/// Throws InputError if a value is out of range; the message names the key of the sensor file.
void validate(const Sensor& sensor);

}  // namespace REALCAM_NAMESPACE
