#pragma once
#include <optional>

#include "../error.hpp"
#include "../math/color.hpp"

namespace REALCAM_NAMESPACE {

/// Air as specified by the user: a medium (Medium), such as fog, that fills the space outside of glass.
struct Air {
    Color extinction = {0, 0, 0};  ///< extinction coefficient per metre; black: no air
    Color albedo = {1, 1, 1};  ///< fraction of the extinction that is scattering, 0 to 1
    float anisotropy = 0.8f;  ///< Medium::anisotropy
    /// Distance by which the air extends beyond the bounding box of the scene's geometry, in metres. std::nullopt:
    /// unlimited or, if light comes from infinity, half of the visibility.
    std::optional<double> margin_m = {};

    /// True if there is air.
    bool is_present() const { return !is_black(extinction); }

    bool operator==(const Air&) const = default;
};

/// Product of extinction coefficient and visibility, -ln 0.02: the distance at which the contrast of a black object
/// against the horizon is 2% (Koschmieder 1924).
inline constexpr double kKoschmieder = 3.912;

/// Returns the extinction coefficient per metre of air with a visibility. Throws InputError unless it is positive.
inline Color extinction_of_visibility(double visibility_m) {
    if (!(visibility_m > 0)) throw InputError("the visibility must be a positive number of metres");
    return grey(static_cast<float>(kKoschmieder / visibility_m));
}

}  // namespace REALCAM_NAMESPACE
