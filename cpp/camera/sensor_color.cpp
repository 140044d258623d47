#include "sensor_color.hpp"

#include <algorithm>
#include <cmath>

namespace realcam {

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
bool tells_colors(const SensorMatrix& m) {
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
    const SensorMatrix seen = electrons_per_um2(sensor, illuminant);
    std::array<double, 3> white = white_of(seen);
    const double most = std::max({white[0], white[1], white[2]});
    for (double& w : white) w /= most;
    if (!(std::min({white[0], white[1], white[2]}) > 1e-6))
        throw InputError("a filter of the sensor sees nothing of the illuminant: its colours cannot be developed");
    const bool own = tells_colors(seen);
    const SensorMatrix matrix = own ? seen : electrons_per_um2(sensor, d65);
    if (!tells_colors(matrix)) throw InputError("the sensor's filters do not tell colours apart");
    const SensorMatrix xyz_from_film = inverse(film_spectrum_detail::kSrgbFromXyz);
    const std::array<double, 3> film_white = applied(xyz_from_film, {1, 1, 1});
    const std::array<double, 3> reference = own ? white_xyz(illuminant) : film_white;
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
