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
    double at, value;

    bool operator==(const SensorPoint&) const = default;
};

/// The conversion from electrons to digital numbers (DN).
struct SensorConversion {
    double gain_dn_per_e = 0;    ///< overall system gain K at the lowest ISO; 0: determined by the ISO
    double largest_gain_db = 0;  ///< largest gain in addition to it
    double saturation_capacity_e = std::numeric_limits<double>::infinity();  ///< as EMVA 1288 measures it
    int adc_bits = 16;
    double black_level_dn = 0;
    double converter_noise_dn = 0;  ///< after the gain, standard deviation

    bool operator==(const SensorConversion&) const = default;
    double largest_dn() const { return std::ldexp(1.0, adc_bits) - 1; }
};

/// Standard deviations and means in electrons.
struct SensorNoise {
    double read_noise_e = 0;  ///< temporal dark noise without exposure time, before the gain
    double row_noise_e = 0;   ///< common to all pixels of a row, different in each exposure
    double dark_current_e_per_s = 0;
    double dark_current_temperature_c = 20;
    double dark_current_doubling_k = 0;  ///< doubling temperature interval; 0: unknown
    double dsnu_e = 0;
    double prnu_percent = 0;
    double hot_pixel_share = 0;
    double hot_pixel_current_e_per_s = 0;  ///< mean of the hot pixels, above the dark current

    bool operator==(const SensorNoise&) const = default;
};

struct Sensor {
    std::string name, title, source;
    std::vector<std::string> assumptions;  ///< properties that are not published, and the values assumed for them
    double pixel_pitch_um = 0;             ///< 0: pitch of the film's pixels
    int columns = 0, rows = 0;             ///< 0: any number
    std::string color_filter_array;        ///< "RGGB" and so on: two rows of two, from the top left; empty: none
    std::vector<QuantumEfficiency> quantum_efficiency;  ///< linear between its points, 0 beyond
    std::vector<SensorPoint> cover_glass;               ///< transmission over nm; empty: 1
    std::vector<SensorPoint> angular_response;          ///< of microlenses, over degrees from the axis; empty: 1
    SensorConversion conversion;
    SensorNoise noise;

    bool operator==(const Sensor&) const = default;
    bool has_filters() const { return !color_filter_array.empty(); }
};

inline constexpr const char* kFilterArrays = "RGGB, BGGR, GRBG or GBRG, or absent";

inline bool is_filter_array(const std::string& name) {
    return name == "RGGB" || name == "BGGR" || name == "GRBG" || name == "GBRG";
}

namespace sensor_detail {

[[noreturn]] void fail(const std::string& key, const std::string& wanted);

/// Throws InputError unless the arguments are at least 0 and strictly increasing, and `is_good` holds for all points.
template <class Point>
void require_table(const std::string& key, const std::vector<Point>& points, double (*at)(const Point&),
                   bool (*is_good)(const Point&)) {
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (!std::isfinite(at(points[i])) || !(at(points[i]) >= 0)) fail(key, "a table over numbers from 0 on");
        if (i > 0 && !(at(points[i]) > at(points[i - 1]))) fail(key, "a table whose first column rises");
        if (!is_good(points[i])) fail(key, "a table of values from 0 to 1");
    }
}

inline bool is_temperature(double celsius) {
    return celsius >= -273.15 && celsius <= 1000;
}

}  // namespace sensor_detail

/// Throws InputError, naming the key of the sensor file.
void validate(const Sensor& sensor);

}  // namespace REALCAM_NAMESPACE
