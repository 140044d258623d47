#pragma once
#include <cstddef>

#include "surface.hpp"

namespace REALCAM_NAMESPACE {

inline constexpr std::size_t kMaxCoatingLayers = 1000;
inline constexpr double kThickestLayer_nm = 1e6;  ///< a millimetre: light no longer interferes in thicker ones

/// Throws InputError where a coating cannot be.
void check_coating(const Coating& coating);

/// Throws InputError where a coating does not fit its surface.
void check_coating_fits(const Surface& surface);

}  // namespace REALCAM_NAMESPACE
