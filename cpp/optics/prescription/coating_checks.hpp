#pragma once
#include <cstddef>

#include "surface.hpp"

namespace REALCAM_NAMESPACE {

inline constexpr std::size_t kMaxCoatingLayers = 1000;
inline constexpr double kMaxLayerThickness_nm = 1e6;  ///< a millimetre: thicker layers show no interference

/// Throws InputError if a layer is invalid.
void validate(const CoatingLayer& layer);

/// Throws InputError if a coating is invalid. The metal is checked even if the coating's kind does not use it.
void validate(const Coating& coating);

/// Throws InputError if a surface's coating does not suit its type. A mirror takes a metal or a reflectance, a
/// refracting surface takes layers or is bare, a stop or aperture cannot be coated; `unknown` suits all.
void check_coating_fits(const Surface& surface);

}  // namespace REALCAM_NAMESPACE
