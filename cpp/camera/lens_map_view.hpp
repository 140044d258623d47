#pragma once
#include "../math/lanes.hpp"

namespace REALCAM_NAMESPACE {

/// What a thin lens takes over from the real one at a radius of the film.
struct LensMapNode {
    float scale;  ///< the radius at which a thin lens sees what the real one sees here, over this one
    float light;  ///< the real irradiance for unit radiance all around
};

/// Distortion and vignetting of a lens, in even steps of the film's radius from the middle.
struct LensMapView {
    const LensMapNode* nodes;
    int count;
    float steps_per_mm;
};

REALCAM_INLINE LensMapNode lens_map_at(const LensMapView& map, Vec2f film) {
    const float place = map.steps_per_mm * sqrt_or_zero(film.x * film.x + film.y * film.y);
    int step = static_cast<int>(place);
    step = select(step < map.count - 1, step, map.count - 2);
    const float share = place - static_cast<float>(step);
    const LensMapNode &near = map.nodes[step], &far = map.nodes[step + 1];
    return {near.scale + share * (far.scale - near.scale), near.light + share * (far.light - near.light)};
}

}  // namespace REALCAM_NAMESPACE
