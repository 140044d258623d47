#pragma once
#include <map>
#include <utility>

#include "../../optics/prescription/surface.hpp"

namespace realcam::io {

/// Coefficients of the powers of r: even terms, radial ones and those of Forbes that depart from a conic. Forbes's
/// departures from a sphere are no polynomial, and are left out.
std::map<int, double> radial_terms_of(const Surface& surface);

/// Degree, and the power of y in it.
using XyPower = std::pair<int, int>;

/// Coefficients of powers of x and y: all terms but those of a toroid, of odd powers of r and of Forbes's departures
/// from a sphere.
std::map<XyPower, double> xy_terms_of(const Surface& surface);

/// Whether a surface has a term of an odd power of r.
bool has_odd_terms(const Surface& surface);

}  // namespace realcam::io
