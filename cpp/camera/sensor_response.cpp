#include "sensor_response.hpp"

#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>

#include "../math/gauss_legendre.hpp"
#include "film_spectrum.hpp"

namespace realcam {

namespace sensor_detail {

double table_at(const std::vector<SensorPoint>& table, double x) {
    if (table.empty()) return 1;
    return interpolated(
        table, x, 0, [](const SensorPoint& p) { return p.at; }, [](const SensorPoint& p) { return p.value; });
}

namespace {

/// Photons per joule, by wavelength in nm.
double photons_per_joule(double wavelength_nm) {
    constexpr double kPlanck = 6.62607015e-34, kLight = 299792458;  // J s, m / s: exact in SI
    return wavelength_nm * 1e-9 / (kPlanck * kLight);
}

constexpr double kLumensPerWatt = 683;  // at the maximum of V: the candela's definition

/// Electrons per square micrometre for a spectral exposure of 1 J / m^2 / nm, by filter, cover glass included.
std::array<double, 3> electrons_at(const Sensor& sensor, double wavelength_nm) {
    const double photons = 1e-12 * photons_per_joule(wavelength_nm) * table_at(sensor.cover_glass, wavelength_nm);
    std::array<double, 3> result{};
    for (std::size_t filter = 0; filter < 3; ++filter)
        result[filter] = photons * interpolated(
                                       sensor.quantum_efficiency, wavelength_nm, 0,
                                       [](const QuantumEfficiency& q) { return q.wavelength_nm; },
                                       [filter](const QuantumEfficiency& q) { return q.electrons_per_photon[filter]; });
    return result;
}

/// Wavelengths at which a table of the integrand has a kink. In between, the integrand is a product of linear
/// functions.
std::vector<double> knots_of(const Sensor& sensor, const Illuminant& illuminant) {
    std::vector<double> knots;
    const auto add = [&](double nm) {
        if (nm >= kFirstWavelength_nm && nm <= kLastWavelength_nm) knots.push_back(nm);
    };
    for (double nm = kFirstWavelength_nm; nm <= kLastWavelength_nm; nm += kSpectrumStep_nm) add(nm);
    for (const QuantumEfficiency& point : sensor.quantum_efficiency) add(point.wavelength_nm);
    for (const SensorPoint& point : sensor.cover_glass) add(point.at);
    for (const SpectrumPoint& point : illuminant.points()) add(point.wavelength_nm);
    std::sort(knots.begin(), knots.end());
    knots.erase(std::unique(knots.begin(), knots.end()), knots.end());
    return knots;
}

}  // namespace

}  // namespace sensor_detail

SensorMatrix electrons_per_um2(const Sensor& sensor, const Illuminant& illuminant) {
    using namespace sensor_detail;
    SensorMatrix matrix{};
    double lumens = 0;
    const auto add = [&](double nm, double power) {
        const std::array<double, 3> electrons = electrons_at(sensor, nm);
        const std::array<double, 3> basis = film_spectrum_detail::basis_at(nm);
        lumens += power * kLumensPerWatt * Illuminant::at(kObserverY, nm);
        for (std::size_t filter = 0; filter < 3; ++filter)
            for (std::size_t channel = 0; channel < 3; ++channel)
                matrix[3 * filter + channel] += power * electrons[filter] * basis[channel];
    };
    if (illuminant.is_line()) {
        add(illuminant.points()[0].wavelength_nm, 1);
    } else {
        const std::vector<double> knots = knots_of(sensor, illuminant);
        constexpr int kNodes = 3;  // exact for a product of five linear functions
        for (std::size_t i = 0; i + 1 < knots.size(); ++i)
            for (int k = 0; k < kNodes; ++k) {
                const GaussNode node = gauss_node(kNodes, k);
                const double width = knots[i + 1] - knots[i], nm = knots[i] + node.node * width;
                add(nm, node.weight * width * illuminant.power(nm));
            }
    }
    if (!(lumens > 0)) throw InputError("the illuminant " + illuminant.text().substr(0, 60) + " has no visible light");
    for (double& value : matrix) value /= lumens;
    return matrix;
}

std::array<double, 3> white_of(const SensorMatrix& matrix) {
    return {film_spectrum_detail::row_sum(matrix, 0), film_spectrum_detail::row_sum(matrix, 1),
            film_spectrum_detail::row_sum(matrix, 2)};
}

double full_well_e(double saturation_capacity_e, double prnu_percent) {
    if (!std::isfinite(saturation_capacity_e)) return saturation_capacity_e;
    const auto slope = [](double m, double full) {
        const double z = (full - m) / std::sqrt(m);
        const double below = 0.5 * std::erfc(-z / std::numbers::sqrt2);
        const double density = std::exp(-z * z / 2) / std::sqrt(2 * std::numbers::pi);
        const double mean = z * (1 - below) - density;
        const double variance = below - z * density + z * z * (1 - below) - mean * mean;
        return variance - (1 - below) * (density + z * below) * (full + m) / std::sqrt(m);
    };
    const auto rises = [&](double full) {
        double sum = 0;
        for (int i = -24; i <= 24; ++i) {  // PRNU up to six standard deviations, in quarters
            const double deviations = 0.25 * i, response = 1 + 0.01 * prnu_percent * deviations;
            sum += std::exp(-deviations * deviations / 2) * response * slope(response * saturation_capacity_e, full);
        }
        return sum >= 0;
    };
    double low = saturation_capacity_e;
    double high = low + 12 * std::sqrt(low) + 0.08 * prnu_percent * low;
    for (int i = 0; i < 60; ++i) (rises(0.5 * (low + high)) ? high : low) = 0.5 * (low + high);
    return high;
}

SensorSpeed::SensorSpeed(const Sensor& sensor, double pitch_um)
    : conversion_(sensor.conversion), full_well_e_(full_well_e(sensor)) {
    const std::array<double, 3> white = white_of(electrons_per_um2(sensor, Illuminant::named("D65")));
    electrons_per_lux_s_ = pitch_um * pitch_um * *std::max_element(white.begin(), white.end());
    if (!(electrons_per_lux_s_ > 0)) throw InputError("quantum_efficiency must see some of the light of D65");
}

double SensorSpeed::lowest_iso() const {
    if (conversion_.gain_dn_per_e == 0) return 0;
    const double electrons = std::min(full_well_e_, range_dn() / conversion_.gain_dn_per_e);
    return kSaturation * electrons_per_lux_s_ / electrons;
}

double SensorSpeed::highest_iso() const {
    if (conversion_.gain_dn_per_e == 0) return std::numeric_limits<double>::infinity();
    return lowest_iso() * std::pow(10, conversion_.largest_gain_db / 20);
}

double SensorSpeed::gain_dn_per_e(double iso) const {
    if (!(iso > 0) || !std::isfinite(iso)) throw InputError("iso must be a positive number");
    if (conversion_.gain_dn_per_e == 0) return range_dn() * iso / (kSaturation * electrons_per_lux_s_);
    constexpr double kRounded = 5e-3;  // rounding of values that users copy from a message or a table
    if (iso < lowest_iso() * (1 - kRounded))
        throw InputError("the lowest ISO of this sensor is " + rounded(lowest_iso()) + "; it is " + rounded(iso) +
                         " here (camera.replace(iso=...).metered(scene), or the command realcam render with --iso, "
                         "exposes for another)");
    return conversion_.gain_dn_per_e * std::min(iso, highest_iso()) / lowest_iso();
}

std::string SensorSpeed::rounded(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.4g", value);
    return text;
}

}  // namespace realcam
