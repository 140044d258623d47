#pragma once
#include "../../camera/effects/rays_with_effects.hpp"
#include "../../camera/models/exposed_rays.hpp"
#include "../../camera/models/lane_numbers.hpp"
#include "../../math/color.hpp"
#include "../../scene/geometry/opacity.hpp"
#include "../../scene/materials/light_sample.hpp"
#include "../../scene/materials/scattering.hpp"

namespace REALCAM_NAMESPACE {

/// Rays to be intersected with the scene, in render space.
template <int N>
struct SceneRays {
    Vec3Lanes<float, N> origin, direction;
    Lanes<float, N> far;  ///< end of the ray, in lengths of its direction
    Lanes<std::int32_t, N> active;  ///< 1 if the ray is traced, 0 if it is skipped and its members are undefined
    // Only for scenes of SceneKind::any:
    Lanes<std::uint32_t, N> number;  ///< random bits that decide at which partly opaque surfaces the ray stops
                                     ///< (stops_ray in opacity.hpp)
    Lanes<float, N> time;  ///< fraction of the exposure (see instance_at.hpp)
};

/// Returns SceneRays::number for the ray of a sample at a bounce; bounce 0 is the camera ray.
template <int N>
REALCAM_INLINE std::uint32_t ray_number(const SampleBlock<N>& block, int lane, int bounce) {
    return path_ray_number(block.bits(lane, ~static_cast<std::uint32_t>(bounce)));
}

/// Results of a block of paths, one lane per sample.
template <int N>
struct PathResults {
    ColorLanes<N> irradiance;  ///< lux; the mean over a pixel's samples is the irradiance of the pixel
    Lanes<float, N> depth;  ///< depth of the first hit along the camera's axis from the film, metres; negative behind
                            ///< the film; kFarAway: no hit
    Lanes<float, N> weight;  ///< weight of the sample in the exposure (CameraRays)
    Lanes<std::int32_t, N> sampled;  ///< 1 if a ray was sent into the lens
    Lanes<std::int32_t, N> passed;  ///< 1 if it left the lens
};

/// Contributions of a block of paths to other pixels than their own: a sample traces one ray, which also counts at
/// kSharedWavelengths - 1 other wavelengths, for the pixels that dispersion would bring that ray to (SampleSharing).
template <int N>
struct SharedResults {
    ColorLanes<N> irradiance[kSharedWavelengths - 1];
    ColorLanes<N> white[kSharedWavelengths - 1];  ///< irradiance if the scene were uniformly white with radiance 1 and
                                                  ///< the sample had weight 1
    Lanes<std::int32_t, N> away[kSharedWavelengths - 1];  ///< index of the other pixel in the film's array less that of
                                                          ///< the sample's own pixel; 0: no contribution
};
/// Stand-ins for the members that a set of effects does not need.
struct NothingShared {};
struct NoExcess {};
/// PathResults with the additional results of a set of effects.
template <int N, Effects effects>
struct PathResultsWith : PathResults<N> {
    [[no_unique_address]] std::conditional_t<effects.share_pixels(), SharedResults<N>, NothingShared> shared;
    /// Excess of each sample: its contribution to its own pixel by channel if the scene were white, less 1 if it passed
    /// the lens (film_control_variates.hpp).
    [[no_unique_address]] std::conditional_t<effects.have_wavelengths(), ColorLanes<N>, NoExcess> excess;
};

/// State of a block of paths that are traced from the film into the scene: the next ray of each path, and what the path
/// has accumulated before that ray. A lane is the fixed index of a sample in its block; a slot is the index of a path
/// in these arrays. At each surface the continuing paths move to the first slots.
template <int N>
struct PathState {
    int count = N;  ///< slots in use; some of their paths may have ended since
    SceneRays<N> rays;
    ColorLanes<N> throughput;  ///< irradiance on the film per unit of radiance along the ray
    Lanes<float, N> weight;  ///< initial throughput of the path
    Lanes<float, N> pdf;  ///< density with which the ray's direction was sampled, per steradian; kFromFilm for camera
                          ///< rays, kDelta after a mirror
    // The LightReceiver at the surface from which the ray starts, for the density of light samples there:
    Vec3Lanes<float, N> receiver_position, receiver_normal;
    Vec3Lanes<float, N> receiver_to_eye;  ///< LightLobe::to_eye; the lobe is unused for SceneKind::plain
    Lanes<float, N> receiver_alpha, receiver_share;  ///< LightLobe::alpha and LightLobe::share
    Lanes<SkySampling, N> receiver_sky;  ///< sampling of the environment there; set for SceneKind::any only
    Lanes<const Material*, N> interior;  ///< material of the glass around the ray; null outside of glass

    REALCAM_INLINE PathState() {
        REALCAM_LANES
        for (int i = 0; i < N; ++i) lane_[i] = i;
    }

    /// Number of slots in use: count or, on a GPU, the constant 1.
    REALCAM_INLINE int slots() const { return N > 1 ? count : 1; }
    /// Lane of the block, and so the sample, to which the path in a slot belongs.
    REALCAM_INLINE int lane(int slot) const {
        if constexpr (N > 1) return lane_[slot];
        return 0;
    }
    REALCAM_INLINE LightLobe receiver_lobe(int slot) const {
        return {receiver_to_eye[slot], receiver_alpha[slot], receiver_share[slot]};
    }
    REALCAM_INLINE void set_receiver_lobe(int slot, LightLobe lobe) {
        receiver_to_eye.set(slot, lobe.to_eye);
        receiver_alpha[slot] = lobe.alpha;
        receiver_share[slot] = lobe.share;
    }
    /// Moves the state that a path still needs once it has reached a surface to another slot.
    template <SceneKind scene_kind>
    REALCAM_INLINE void move(int from, int to) {
        if constexpr (N > 1) {
            lane_[to] = lane_[from];
            rays.direction.set(to, rays.direction[from]);
            throughput.set(to, throughput[from]);
            weight[to] = weight[from];
            if constexpr (scene_kind != SceneKind::plain) interior[to] = interior[from];
            if constexpr (scene_kind == SceneKind::any) {
                rays.time[to] = rays.time[from];
                rays.number[to] = rays.number[from];
                // Needed if the surface is a shadow catcher, through which the ray continues:
                pdf[to] = pdf[from];
                receiver_position.set(to, receiver_position[from]);
                receiver_normal.set(to, receiver_normal[from]);
                receiver_sky[to] = receiver_sky[from];
                set_receiver_lobe(to, receiver_lobe(from));
            }
        }
    }

private:
    Lanes<std::int32_t, N> lane_;
};

/// Returns the time of a path as a fraction of the exposure; 0 if nothing moves (other kinds than SceneKind::any).
template <SceneKind scene_kind, int N>
REALCAM_INLINE float time_of(const PathState<N>& path, int slot) {
    if constexpr (scene_kind == SceneKind::any) return path.rays.time[slot];
    return 0.0f;
}

/// PathState with the wavelengths of the samples, if the effects need them.
template <int N, Effects effects>
struct PathStateWith : PathState<N> {
    WavelengthsWith<N, effects> wavelengths;
};

/// Pair of random numbers of one dimension of the sequence for each path; operator[] takes a slot. A GPU's thread
/// computes it on demand (PathNumbers<1>), because it has no registers to store it.
template <int N>
class PathNumbers {
public:
    REALCAM_INLINE PathNumbers(const SampleBlock<N>& block, const PathState<N>& path, std::uint32_t dimension)
        : numbers_(block, dimension, whole_vectors<N>(path.count), [&](int slot) { return path.lane(slot); }) {}

    REALCAM_INLINE Vec2f operator[](int slot) const { return numbers_[slot]; }

private:
    LaneNumbers<N> numbers_;
};

template <>
class PathNumbers<1> {
public:
    REALCAM_INLINE PathNumbers(const SampleBlock<1>& block, const PathState<1>&, std::uint32_t dimension)
        : block_(block), dimension_(dimension) {}

    REALCAM_INLINE Vec2f operator[](int) const {
        // With constant dimensions the compiler omits the code for the other dimensions of the joint sequence.
        if (dimension_ == kFirstLight) return block_.random(0, kFirstLight);
        if (dimension_ == kFirstScatter) return block_.random(0, kFirstScatter);
        return sample_2d(block_.stream[0], block_.sample[0], dimension_);
    }

private:
    static constexpr std::uint32_t kFirstLight = dimension::first_bounce + dimension::light,
                                   kFirstScatter = dimension::first_bounce + dimension::scatter;

    const SampleBlock<1>& block_;
    std::uint32_t dimension_;
};

}  // namespace REALCAM_NAMESPACE
