#pragma once
#include <cstdint>

#include "../../math/vec3.hpp"

namespace REALCAM_NAMESPACE {

// Lights whose images are traced from the light to the film, instead of being hit by chance by pixel samples.

enum class TracedLightKind : std::int32_t { point, sun, triangles };

/// Rectangle in a plane, in coordinates `along` and `across` two perpendicular axes.
struct PlaneRectangle {
    float low_along, high_along, low_across, high_across;

    REALCAM_INLINE float area() const { return (high_along - low_along) * (high_across - low_across); }
    REALCAM_INLINE bool holds(float along, float across) const {
        return (along >= low_along) & (along <= high_along) & (across >= low_across) & (across <= high_across);
    }
    /// Point of the rectangle. `u`: from 0 to 1, along and across.
    REALCAM_INLINE Vec2f at(Vec2f u) const {
        return {low_along + u.x * (high_along - low_along), low_across + u.y * (high_across - low_across)};
    }
};

/// Light whose image is traced from the light (trace_lights.hpp): a point light, a sun, or emissive triangles that lie
/// near each other.
struct TracedLight {
    TracedLightKind kind;
    std::int32_t first, count;  ///< range of its triangles in the lists of TracedLightsView; for other lights its
                                ///< index, and 1
    Vec3f from;  ///< unit vector towards its centre, in the lens's axes
    Vec3f along;  ///< unit vector perpendicular to `from`, away from the lens's axis
    /// Entrance-pupil bounds of its light: in the plane perpendicular to `from` through the front vertex, mm, in the
    /// direction `along`, and across.
    PlaneRectangle entries;
    std::int32_t halvings;  ///< the light is sampled with the probability 2^-halvings
    float probability;  ///< that probability
};

/// Lights of a scene whose images are traced from the lights, for one camera. Other lights are found by pixel samples
/// alone.
struct TracedLightsView {
    const TracedLight* lights;
    std::int32_t light_count;  ///< 0: no light is traced
    const std::int32_t* turns;  ///< index in `lights` of the light that a sample is traced from, by the last bits of
                                ///< the sample's index
    std::int32_t turn_count;  ///< size of `turns`, a power of two
    const std::int32_t* triangles;  ///< indices of area lights of the scene, light by light
    const float* cdfs;  ///< cumulative probabilities of each light's triangles, one entry more than it has triangles
    std::int32_t triangle_count;
    const std::int32_t* light_of_area;  ///< for each area light of the scene: index in `lights`, or -1
    const float* share_of_area;  ///< probability of being sampled, given its light
    std::int32_t area_count;
    /// Number of light samples per sample of each pixel, times the factor that makes their density that of pixel
    /// samples (light_tracing_density_ratio), mm^2 sr.
    float scale;

    /// Calls move(array, count) for every array.
    template <class Move>
    void move_arrays(Move&& move) {
        move(lights, light_count);
        move(turns, turn_count);
        move(triangles, triangle_count);
        move(cdfs, triangle_count + light_count);
        move(light_of_area, area_count);
        move(share_of_area, area_count);
    }
};

}  // namespace REALCAM_NAMESPACE
