#pragma once
#include <pybind11/numpy.h>

#include <optional>
#include <string>
#include <vector>

#include "../../optics/pupil/pupil_pattern.hpp"
#include "../values/arrays.hpp"

namespace realcam::bindings {

// Arguments common to the analyses of one object point.

inline constexpr int kMaxPatternSamples = 2048;

/// Returns the sample points on the stop: `pupil`, an array of shape (N, 2), if it is given, otherwise those of the
/// named pattern. Throws InputError.
std::vector<PupilPoint> pattern_from(const std::string& pattern, int samples,
                                     const std::optional<InputArray<double>>& pupil);

inline constexpr const char* kFieldText =
    R"(field_deg: angle to the axis at which the light comes; positive: it rises towards +y and the film. Less than 180
  for an object at infinity; less than 90, seen from the middle of the paraxial entrance pupil, for one nearer.
film_mm: (x, y), names the field by the film point, from the film's middle, at which the chief ray of the design
  wavelength ends; in place of field_deg, and in both directions across the film.
object_distance_m: object plane to front vertex, inf allowed; None is the plane in focus.
wavelength_nm: None is the design wavelength.
)";
inline constexpr const char* kPatternText =
    R"(pattern, samples: "grid", the cells of a square of samples x samples; "rings", samples rings at Gauss's nodes,
  whose means over a round stop are exact for smooth functions; "hexapolar", a middle ray and samples rings of 6, 12,
  ... rays up to the edge, all of one weight.
pupil: (N, 2), points of the stop in units of its radius, instead of a pattern.
Rays fill the real stop: each is aimed at its point there within 1e-10 of the stop's radius. One for which no ray is
found ends as NO_CONVERGENCE, and what a rim blocks as VIGNETTED.
)";

}  // namespace realcam::bindings
