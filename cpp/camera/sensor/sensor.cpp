#include "sensor.hpp"

namespace realcam {

namespace sensor_detail {

void fail(const std::string& key, const std::string& requirement) {
    throw InputError(key + " must be " + requirement);
}

namespace {

void require_at_least_0(const std::string& key, double value) {
    if (!(value >= 0 && value <= 1e12)) fail(key, "a number from 0 to 1e12");
}

bool is_fraction(double value) {
    return value >= 0 && value <= 1;
}

void validate_spectra(const Sensor& sensor) {
    require_table<QuantumEfficiency>(
        "quantum_efficiency", sensor.quantum_efficiency, [](const QuantumEfficiency& q) { return q.wavelength_nm; },
        [](const QuantumEfficiency& q) {
            for (double e : q.electrons_per_photon)
                if (!is_fraction(e)) return false;
            return true;
        });
    if (sensor.quantum_efficiency.size() < 2) fail("quantum_efficiency", "a table of at least two wavelengths");
    const auto at = [](const SensorPoint& p) { return p.at; };
    const auto is_good = [](const SensorPoint& p) { return is_fraction(p.value); };
    require_table<SensorPoint>("cover_glass", sensor.cover_glass, at, is_good);
    require_table<SensorPoint>("angular_response", sensor.angular_response, at, is_good);
    if (!sensor.angular_response.empty() &&
        (!(sensor.angular_response.front() == SensorPoint{0, 1}) || !(sensor.angular_response.back().at < 90)))
        fail("angular_response", "a table that begins with [0, 1] and ends before 90 degrees");
}

void validate_noise(const SensorNoise& noise) {
    require_at_least_0("read_noise_e", noise.read_noise_e);
    require_at_least_0("row_noise_e", noise.row_noise_e);
    require_at_least_0("dark_current_e_per_s", noise.dark_current_e_per_s);
    require_at_least_0("dark_current_doubling_k", noise.dark_current_doubling_k);
    require_at_least_0("dsnu_e", noise.dsnu_e);
    require_at_least_0("hot_pixel_current_e_per_s", noise.hot_pixel_current_e_per_s);
    if (!is_temperature(noise.dark_current_temperature_c))
        fail("dark_current_temperature_c", "a temperature in degrees Celsius, from -273.15 to 1000");
    if (!(noise.prnu_percent >= 0 && noise.prnu_percent <= 15)) fail("prnu_percent", "from 0 to 15");
    if (!is_fraction(noise.hot_pixel_share)) fail("hot_pixel_share", "from 0 to 1");
}

void validate_conversion(const SensorConversion& conversion) {
    require_at_least_0("gain_dn_per_e", conversion.gain_dn_per_e);
    require_at_least_0("converter_noise_dn", conversion.converter_noise_dn);
    if (!(conversion.largest_gain_db >= 0 && conversion.largest_gain_db <= 200))
        fail("largest_gain_db", "from 0 to 200");
    if (!(conversion.saturation_capacity_e >= 1)) fail("saturation_capacity_e", "at least 1, or inf");
    if (!(conversion.adc_bits >= 1 && conversion.adc_bits <= 16)) fail("adc_bits", "a whole number from 1 to 16");
    if (!(conversion.black_level_dn >= 0 && conversion.black_level_dn <= 0.5 * conversion.largest_dn()))
        fail("black_level_dn", "from 0 to half of the converter's largest number");
    if (std::isfinite(conversion.saturation_capacity_e) && conversion.gain_dn_per_e == 0)
        fail("gain_dn_per_e", "given if saturation_capacity_e is given");
}

}  // namespace

}  // namespace sensor_detail

void validate(const Sensor& sensor) {
    using namespace sensor_detail;
    if (!(sensor.pixel_pitch_um == 0 || (sensor.pixel_pitch_um >= 1e-3 && sensor.pixel_pitch_um <= 1e6)))
        fail("pixel_pitch_um", "a number from 0.001 to 1e6, or 0 for the pitch of the film's pixels");
    if (sensor.columns < 0 || sensor.rows < 0 || (sensor.columns > 0) != (sensor.rows > 0))
        fail("resolution", "a number of columns and one of rows, both at least 1, or 0 and 0 if they are not fixed");
    if (sensor.has_filters() && !is_filter_array(sensor.color_filter_array)) fail("color_filter_array", kFilterArrays);
    validate_spectra(sensor);
    validate_conversion(sensor.conversion);
    validate_noise(sensor.noise);
}

}  // namespace realcam
