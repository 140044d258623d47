#pragma once
#include <pybind11/numpy.h>

#include <optional>
#include <string>
#include <vector>

#include "../../optics/pupil/pupil_pattern.hpp"
#include "../values/arrays.hpp"

namespace realcam::bindings {

// Arguments common to the analyses of one object point, and their docstrings.

inline constexpr int kMaxPatternSamples = 2048;  ///< upper limit of the argument `samples`

/// Returns the sample points on the stop: `pupil`, an array of shape (N, 2), if it is specified, otherwise those of the
/// named pattern. Throws InputError.
std::vector<PupilPoint> pattern_from(const std::string& pattern, int samples,
                                     const std::optional<InputArray<double>>& pupil);

inline constexpr const char* kFieldText =
    R"(field_deg: field angle in degrees, between the incoming light and the axis, in the y-z plane; positive: the light
  travels towards +y on its way to the film. Below 180 for an object at infinity. For a nearer object below 90, and as
  seen from the centre of the paraxial entrance pupil.
film_mm: specifies the field instead of field_deg, by the film point (x, y), in mm from the film's centre, at which the
  chief ray of the design wavelength ends. It may lie outside the y-z plane.
object_distance_m: distance from the object plane to the front vertex, inf allowed; None: the plane in focus.
wavelength_nm: wavelength; None: the design wavelength.
)";
inline constexpr const char* kPatternText =
    R"(pattern: arrangement of the rays on the stop. "grid": the cells of a square of samples x samples. "rings": rings
  at the nodes of Gauss quadrature, whose weighted mean over a round stop is exact for smooth functions. "hexapolar": a
  central ray and rings of 6, 12, ... rays up to the edge, of equal weights.
samples: cells along a side of the grid, or number of rings; 1 to 2048.
pupil: (N, 2), points of the stop in units of its radius, instead of a pattern.
Rays fill the real stop: each is aimed at its point there within 1e-10 of the stop's radius. The status of a point for
which no ray is found is NO_CONVERGENCE, that of a ray which a rim blocks is VIGNETTED.
)";

}  // namespace realcam::bindings
