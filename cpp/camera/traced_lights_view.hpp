#pragma once
#include <cstdint>

#include "../math/vec3.hpp"

namespace REALCAM_NAMESPACE {

enum class TracedLightKind : std::int32_t { point, sun, triangles };

/// A rectangle of a plane with two axes.
struct PlaneRectangle {
    float low_along, high_along, low_across, high_across;

    REALCAM_INLINE float area() const { return (high_along - low_along) * (high_across - low_across); }
    REALCAM_INLINE bool holds(float along, float across) const {
        return (along >= low_along) & (along <= high_along) & (across >= low_across) & (across <= high_across);
    }
    /// `u`: 0 to 1, along and across.
    REALCAM_INLINE Vec2f at(Vec2f u) const {
        return {low_along + u.x * (high_along - low_along), low_across + u.y * (high_across - low_across)};
    }
};

/// A light whose image is found from its own side (trace_lights.hpp): a point light, a sun, or emitting triangles that
/// lie near each other.
struct TracedLight {
    TracedLightKind kind;
    std::int32_t first, count;  ///< of its triangles in the lists of TracedLightsView; else its number, and 1
    Vec3f from;  ///< unit, towards its middle, in the lens's axes
    Vec3f along;  ///< unit, at a right angle to it, away from the lens's axis
    /// Where its light enters the lens: in the plane across `from` through the front vertex, mm, in the direction
    /// `along`, and across that.
    PlaneRectangle entries;
    std::int32_t halvings;  ///< a sample takes it with the probability 2^-halvings
    float probability;
};

/// The lights of a scene whose images are found from their side, as one camera sees them. Others are found by samples
/// of pixels alone.
struct TracedLightsView {
    const TracedLight* lights;
    std::int32_t light_count;  ///< 0: there are none
    const std::int32_t* turns;  ///< which light a sample takes, by the last bits of its number
    std::int32_t turn_count;  ///< a power of two
    const std::int32_t* triangles;  ///< area lights of the scene, light by light
    const float* cdfs;  ///< of each light's triangles, one entry more than they are
    std::int32_t triangle_count;
    const std::int32_t* light_of_area;  ///< of each area light of the scene: one of `lights`, or -1
    const float* share_of_area;  ///< probability with which a sample of its light takes it
    std::int32_t area_count;
    /// Samples from the lights, for one sample of each pixel, times what makes their density that of samples of pixels
    /// (traced_light_weight), mm^2 sr.
    float scale;

    /// move(array, count) for every array.
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
