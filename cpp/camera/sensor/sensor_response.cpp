#include "sensor_response.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>

#include "../../math/gauss_legendre.hpp"
#include "../effects/dispersion/film_spectrum.hpp"

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
    // Derivative of the variance by the mean m, for a full well of `full` (see the declaration of full_well_e).
    const auto derivative = [](double m, double full) {
        const double z = (full - m) / std::sqrt(m);
        const double below = 0.5 * std::erfc(-z / std::numbers::sqrt2);
        const double density = std::exp(-z * z / 2) / std::sqrt(2 * std::numbers::pi);
        const double mean = z * (1 - below) - density;
        const double variance = below - z * density + z * z * (1 - below) - mean * mean;
        return variance - (1 - below) * (density + z * below) * (full + m) / std::sqrt(m);
    };
    // True if the mean variance of all pixels still increases at the saturation capacity: the full well lies lower.
    const auto still_increases = [&](double full) {
        double sum = 0;
        for (int i = -24; i <= 24; ++i) {  // PRNU up to six standard deviations, in quarters
            const double deviations = 0.25 * i, response = 1 + 0.01 * prnu_percent * deviations;
            sum +=
                std::exp(-deviations * deviations / 2) * response * derivative(response * saturation_capacity_e, full);
        }
        return sum >= 0;
    };
    double low = saturation_capacity_e;
    double high = low + 12 * std::sqrt(low) + 0.08 * prnu_percent * low;
    for (int i = 0; i < 60; ++i) (still_increases(0.5 * (low + high)) ? high : low) = 0.5 * (low + high);
    return high;
}

SensorSpeed::SensorSpeed(const Sensor& sensor, double pitch_um)
    : conversion_(sensor.conversion), full_well_e_(full_well_e(sensor)) {
    const std::array<double, 3> white = white_of(electrons_per_um2(sensor, Illuminant::named("D65")));
    electrons_per_lux_s_ = pitch_um * pitch_um * *std::max_element(white.begin(), white.end());
    if (!(electrons_per_lux_s_ > 0)) throw InputError("quantum_efficiency must be positive at some wavelength of D65");
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
    constexpr double kRoundingTolerance = 5e-3;  // rounding of values that users copy from a message or a table
    if (iso < lowest_iso() * (1 - kRoundingTolerance))
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

namespace sensor_detail {

std::array<double, 3> applied(const SensorMatrix& m, const std::array<double, 3>& v) {
    std::array<double, 3> result{};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < 3; ++k) result[i] += m[3 * i + k] * v[k];
    return result;
}

namespace {

/// XYZ of an illuminant's own light, Y = 1.
std::array<double, 3> white_xyz(const Illuminant& illuminant) {
    std::array<double, 3> sum{};
    const auto add = [&](double nm, double power) {
        sum[0] += power * Illuminant::at(kObserverX, nm);
        sum[1] += power * Illuminant::at(kObserverY, nm);
        sum[2] += power * Illuminant::at(kObserverZ, nm);
    };
    if (illuminant.is_line())
        add(illuminant.points()[0].wavelength_nm, 1);
    else
        for (double nm = kFirstWavelength_nm; nm <= kLastWavelength_nm; nm += 0.5) add(nm, illuminant.power(nm));
    return {sum[0] / sum[1], 1, sum[2] / sum[1]};
}

}  // namespace

SensorMatrix adaptation(const std::array<double, 3>& from_white, const std::array<double, 3>& to_white) {
    constexpr SensorMatrix kBradford = {0.8951, 0.2664, -0.1614, -0.7502, 1.7135, 0.0367, 0.0389, -0.0685, 1.0296};
    const auto from = applied(kBradford, from_white), to = applied(kBradford, to_white);
    return product(inverse(kBradford),
                   product(diagonal({to[0] / from[0], to[1] / from[1], to[2] / from[2]}), kBradford));
}

namespace {

/// True if the filters distinguish three colours. Under a single line they do not.
bool distinguishes_colors(const SensorMatrix& m) {
    double volume =
        m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) + m[2] * (m[3] * m[7] - m[4] * m[6]);
    for (std::size_t row = 0; row < 3; ++row) volume /= std::hypot(m[3 * row], m[3 * row + 1], m[3 * row + 2]);
    return std::fabs(volume) > 1e-4;
}

}  // namespace

}  // namespace sensor_detail

SensorColor sensor_color(const Sensor& sensor, const Illuminant& illuminant) {
    using namespace sensor_detail;
    const Illuminant d65 = Illuminant::named("D65");
    const SensorMatrix response = electrons_per_um2(sensor, illuminant);
    std::array<double, 3> white = white_of(response);
    const double largest = std::max({white[0], white[1], white[2]});
    for (double& w : white) w /= largest;
    if (!(std::min({white[0], white[1], white[2]}) > 1e-6))
        throw InputError("a filter of the sensor does not respond to the illuminant: its colours cannot be developed");
    const bool is_distinct = distinguishes_colors(response);
    const SensorMatrix matrix = is_distinct ? response : electrons_per_um2(sensor, d65);
    if (!distinguishes_colors(matrix)) throw InputError("the sensor's filters do not distinguish colours");
    const SensorMatrix xyz_from_film = inverse(film_spectrum_detail::kSrgbFromXyz);
    const std::array<double, 3> film_white = applied(xyz_from_film, {1, 1, 1});
    const std::array<double, 3> reference = is_distinct ? white_xyz(illuminant) : film_white;
    SensorColor color{};
    color.white = white;
    color.film_from_balanced = product(inverse(matrix), diagonal(white_of(matrix)));
    color.d50_from_balanced =
        product(adaptation(film_white, {0.9642, 1, 0.8251}), product(xyz_from_film, color.film_from_balanced));
    color.camera_from_xyz =
        product(diagonal(white),
                inverse(product(adaptation(film_white, reference), product(xyz_from_film, color.film_from_balanced))));
    return color;
}

}  // namespace realcam
