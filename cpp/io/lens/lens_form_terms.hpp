#pragma once
#include <map>
#include <string>
#include <utility>

#include "../../optics/prescription/surface.hpp"

namespace realcam::io {

/// Returns the coefficients of the powers of r: even terms, radial terms, and Forbes terms that depart from a conic.
/// Forbes's departures from a sphere are not polynomials, and are omitted.
std::map<int, double> radial_terms_of(const Surface& surface);

/// Degree, and the power of y in it.
using XyPower = std::pair<int, int>;

/// Returns the coefficients of powers of x and y: all terms except those of a toroid, odd powers of r, and Forbes's
/// departures from a sphere.
std::map<XyPower, double> xy_terms_of(const Surface& surface);

/// Name of terms that are omitted because they are not a polynomial: "Forbes terms of a departure from a sphere"; empty
/// if there are none.
std::string beyond_polynomials(const SurfaceForm& form);

/// True if a surface has a term of an odd power of r.
bool has_odd_terms(const Surface& surface);

}  // namespace realcam::io
