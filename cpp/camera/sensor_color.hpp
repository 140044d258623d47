#pragma once
#include "film_spectrum.hpp"
#include "sensor_response.hpp"

namespace REALCAM_NAMESPACE {

/// How the numbers of a sensor's filters become colours again, under one illuminant. The film's colours stand for
/// spectra of a basis of three (film_spectrum.hpp), so this is exact, and not a fit over samples.
struct SensorColor {
    std::array<double, 3> white;  ///< what the filters see of the illuminant, the largest 1: DNG's AsShotNeutral
    SensorMatrix camera_from_xyz;     ///< of XYZ under the illuminant, white of Y = 1 as `white`: DNG's ColorMatrix
    SensorMatrix film_from_balanced;  ///< from numbers over `white` to linear Rec. 709
    SensorMatrix d50_from_balanced;   ///< likewise to XYZ under D50: DNG's ForwardMatrix
};

namespace sensor_detail {

using film_spectrum_detail::inverse;
using film_spectrum_detail::product;

std::array<double, 3> applied(const SensorMatrix& m, const std::array<double, 3>& v);

inline SensorMatrix diagonal(const std::array<double, 3>& v) {
    return {v[0], 0, 0, 0, v[1], 0, 0, 0, v[2]};
}

/// Chromatic adaptation by Bradford's matrix (Lam 1985), as ICC and DNG have it.
SensorMatrix adaptation(const std::array<double, 3>& from_white, const std::array<double, 3>& to_white);

}  // namespace sensor_detail

/// Where the sensor cannot tell colours apart in the illuminant, they are those of D65, and white is the illuminant's.
/// Throws InputError where it cannot under D65 either, or where a filter sees nothing of the illuminant.
SensorColor sensor_color(const Sensor& sensor, const Illuminant& illuminant);

}  // namespace REALCAM_NAMESPACE
