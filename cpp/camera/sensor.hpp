#pragma once
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "../error.hpp"
#include "../platform.hpp"

namespace REALCAM_NAMESPACE {

// A sensor as its data sheet describes it, by the linear model of EMVA standard 1288. What a sheet does not say stays
// at the value that adds nothing, and `assumptions` says what the file had to assume.

/// Electrons per photon on the pixel's area: of the red, green and blue filter; the same three times without filters.
struct QuantumEfficiency {
    double wavelength_nm;
    std::array<double, 3> electrons_per_photon;

    bool operator==(const QuantumEfficiency&) const = default;
};

/// A table's point: transmission by wavelength (nm), or relative response by angle (degrees).
struct SensorPoint {
    double at, value;

    bool operator==(const SensorPoint&) const = default;
};

/// From electrons to digital numbers (DN).
struct SensorConversion {
    double gain_dn_per_e = 0;    ///< overall system gain K at the lowest ISO; 0: whatever the ISO asks for
    double largest_gain_db = 0;  ///< that can be added to it
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
    double row_noise_e = 0;   ///< what all pixels of a row have together, from exposure to exposure
    double dark_current_e_per_s = 0;
    double dark_current_temperature_c = 20;
    double dark_current_doubling_k = 0;  ///< doubling temperature interval; 0: not known
    double dsnu_e = 0;
    double prnu_percent = 0;
    double hot_pixel_share = 0;
    double hot_pixel_current_e_per_s = 0;  ///< mean of the hot ones, above the dark current

    bool operator==(const SensorNoise&) const = default;
};

struct Sensor {
    std::string name, title, source;
    std::vector<std::string> assumptions;  ///< what is not published, and what stands in its place
    double pixel_pitch_um = 0;             ///< 0: that of the film's pixels
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

[[noreturn]] inline void fail(const std::string& key, const std::string& wanted) {
    throw InputError(key + " must be " + wanted);
}

inline void require_at_least_0(const std::string& key, double value) {
    if (!(value >= 0 && value <= 1e12)) fail(key, "a number from 0 to 1e12");
}

/// Rising places; values from 0 to 1.
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

inline bool is_share(double value) {
    return value >= 0 && value <= 1;
}

inline void validate_spectra(const Sensor& sensor) {
    require_table<QuantumEfficiency>(
        "quantum_efficiency", sensor.quantum_efficiency, [](const QuantumEfficiency& q) { return q.wavelength_nm; },
        [](const QuantumEfficiency& q) {
            for (double e : q.electrons_per_photon)
                if (!is_share(e)) return false;
            return true;
        });
    if (sensor.quantum_efficiency.size() < 2) fail("quantum_efficiency", "a table of at least two wavelengths");
    const auto at = [](const SensorPoint& p) { return p.at; };
    const auto is_good = [](const SensorPoint& p) { return is_share(p.value); };
    require_table<SensorPoint>("cover_glass", sensor.cover_glass, at, is_good);
    require_table<SensorPoint>("angular_response", sensor.angular_response, at, is_good);
    if (!sensor.angular_response.empty() &&
        (!(sensor.angular_response.front() == SensorPoint{0, 1}) || !(sensor.angular_response.back().at < 90)))
        fail("angular_response", "a table that begins with [0, 1] and ends before 90 degrees");
}

inline void validate_noise(const SensorNoise& noise) {
    require_at_least_0("read_noise_e", noise.read_noise_e);
    require_at_least_0("row_noise_e", noise.row_noise_e);
    require_at_least_0("dark_current_e_per_s", noise.dark_current_e_per_s);
    require_at_least_0("dark_current_doubling_k", noise.dark_current_doubling_k);
    require_at_least_0("dsnu_e", noise.dsnu_e);
    require_at_least_0("hot_pixel_current_e_per_s", noise.hot_pixel_current_e_per_s);
    if (!is_temperature(noise.dark_current_temperature_c))
        fail("dark_current_temperature_c", "a temperature in degrees Celsius, from -273.15 to 1000");
    if (!(noise.prnu_percent >= 0 && noise.prnu_percent <= 15)) fail("prnu_percent", "from 0 to 15");
    if (!is_share(noise.hot_pixel_share)) fail("hot_pixel_share", "from 0 to 1");
}

inline void validate_conversion(const SensorConversion& conversion) {
    require_at_least_0("gain_dn_per_e", conversion.gain_dn_per_e);
    require_at_least_0("converter_noise_dn", conversion.converter_noise_dn);
    if (!(conversion.largest_gain_db >= 0 && conversion.largest_gain_db <= 200))
        fail("largest_gain_db", "from 0 to 200");
    if (!(conversion.saturation_capacity_e >= 1)) fail("saturation_capacity_e", "at least 1, or inf");
    if (!(conversion.adc_bits >= 1 && conversion.adc_bits <= 16)) fail("adc_bits", "a whole number from 1 to 16");
    if (!(conversion.black_level_dn >= 0 && conversion.black_level_dn <= 0.5 * conversion.largest_dn()))
        fail("black_level_dn", "from 0 to half of the converter's largest number");
    if (std::isfinite(conversion.saturation_capacity_e) && conversion.gain_dn_per_e == 0)
        fail("gain_dn_per_e", "given where there is a saturation_capacity_e");
}

}  // namespace sensor_detail

/// Throws InputError naming the key as sensor files have it.
inline void validate(const Sensor& sensor) {
    using namespace sensor_detail;
    if (!(sensor.pixel_pitch_um == 0 || (sensor.pixel_pitch_um >= 1e-3 && sensor.pixel_pitch_um <= 1e6)))
        fail("pixel_pitch_um", "a number from 0.001 to 1e6, or 0: that of the film's pixels");
    if (sensor.columns < 0 || sensor.rows < 0 || (sensor.columns > 0) != (sensor.rows > 0))
        fail("resolution", "columns and rows, from 1 on, or 0 and 0: any number");
    if (sensor.has_filters() && !is_filter_array(sensor.color_filter_array)) fail("color_filter_array", kFilterArrays);
    validate_spectra(sensor);
    validate_conversion(sensor.conversion);
    validate_noise(sensor.noise);
}

}  // namespace REALCAM_NAMESPACE
