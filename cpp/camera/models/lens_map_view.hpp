#pragma once
#include "../../math/lanes.hpp"

namespace REALCAM_NAMESPACE {

/// Distortion and vignetting of the real lens at one film radius.
struct LensMapNode {
    float scale;  ///< film radius at which a thin lens images the point that the real lens images at this node's
                  ///< radius, over the latter
    float light;  ///< irradiance of the real lens for uniform unit radiance
};

/// Distortion and vignetting of a lens, in uniform steps of the film radius from the axis.
struct LensMapView {
    const LensMapNode* nodes;
    int count;
    float steps_per_mm;
};

/// Map at a film point, mm, linearly interpolated; extrapolated beyond the last node.
REALCAM_INLINE LensMapNode lens_map_at(const LensMapView& map, Vec2f film) {
    const float position = map.steps_per_mm * sqrt_or_zero(film.x * film.x + film.y * film.y);
    int step = static_cast<int>(position);
    step = select(step < map.count - 1, step, map.count - 2);
    const float share = position - static_cast<float>(step);
    const LensMapNode &near = map.nodes[step], &far = map.nodes[step + 1];
    return {near.scale + share * (far.scale - near.scale), near.light + share * (far.light - near.light)};
}

}  // namespace REALCAM_NAMESPACE
