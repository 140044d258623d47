#pragma once
#include "film_spectrum.hpp"
#include "sensor_response.hpp"

namespace REALCAM_NAMESPACE {

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

std::array<double, 3> applied(const SensorMatrix& m, const std::array<double, 3>& v);

inline SensorMatrix diagonal(const std::array<double, 3>& v) {
    return {v[0], 0, 0, 0, v[1], 0, 0, 0, v[2]};
}

/// Chromatic adaptation by Bradford's matrix (Lam 1985), as ICC and DNG have it.
SensorMatrix adaptation(const std::array<double, 3>& from_white, const std::array<double, 3>& to_white);

}  // namespace sensor_detail

/// If the sensor cannot distinguish colours under the illuminant, the matrices are those of D65, with the white of the
/// illuminant. Throws InputError if it cannot under D65 either, or if a filter has no response to the illuminant.
SensorColor sensor_color(const Sensor& sensor, const Illuminant& illuminant);

}  // namespace REALCAM_NAMESPACE
