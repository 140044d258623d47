#pragma once
#include "../camera/exposed_rays.hpp"
#include "../camera/rays_with_effects.hpp"
#include "../math/color.hpp"
#include "../scene/light_sample.hpp"
#include "../scene/opacity.hpp"
#include "../scene/scattering.hpp"

namespace REALCAM_NAMESPACE {

/// Rays for traversal. Lanes with active 0 are left out.
template <int N>
struct SceneRays {
    Vec3Lanes<float, N> origin, direction;
    Lanes<float, N> far;  ///< how far along the ray to look, in lengths of the direction
    Lanes<std::int32_t, N> active;
    // For scenes of SceneKind::any alone:
    Lanes<std::uint32_t, N> number;  ///< by which a ray decides at holes
    Lanes<float, N> time;  ///< share of the exposure (see instance_at.hpp)
};

/// The number of the ray that a sample sends out at a bounce; the camera's is bounce 0.
template <int N>
REALCAM_INLINE std::uint32_t ray_number(const SampleBlock<N>& block, int lane, int bounce) {
    return path_ray_number(block.bits(lane, ~static_cast<std::uint32_t>(bounce)));
}

/// What a block of paths saw. Irradiance per sample: its mean over a pixel's samples is the pixel's irradiance.
template <int N>
struct PathResults {
    ColorLanes<N> irradiance;
    Lanes<float, N> depth;  ///< of the first hit along the camera's axis from the film,
                            ///< metres; below 0 behind the film; kFarAway: none
    Lanes<float, N> weight;  ///< of the sample in the exposure (CameraRays)
    Lanes<std::int32_t, N> sampled, passed;
};

/// And what they bring to other pixels, at the further steps of their wavelengths.
template <int N>
struct SharedResults {
    ColorLanes<N> irradiance[kSharedWavelengths - 1];
    ColorLanes<N> white[kSharedWavelengths - 1];  ///< for how many samples they count
    Lanes<std::int32_t, N> away[kSharedWavelengths - 1];  ///< from the sample's own pixel in the sums; 0: nothing
};
struct NothingShared {};
struct NoExcess {};
template <int N, Effects effects>
struct PathResultsWith : PathResults<N> {
    [[no_unique_address]] std::conditional_t<effects.share_pixels(), SharedResults<N>, NothingShared> shared;
    /// By how much those that pass count in their own pixel for more than one, in each channel.
    [[no_unique_address]] std::conditional_t<effects.have_wavelengths(), ColorLanes<N>, NoExcess> excess;
};

/// Paths on their way from the film into the scene: the next ray of each, and what is known of the way up to it. At
/// each surface those that have ended give their places to others, so that the first ones are in use.
template <int N>
struct PathState {
    int count = N;  ///< places in use, some of them perhaps by paths that have ended since
    SceneRays<N> rays;
    ColorLanes<N> throughput;  ///< irradiance on the film for a unit of radiance that comes along the ray
    Lanes<float, N> weight;  ///< the throughput with which the path began
    Lanes<float, N> pdf;  ///< with which the ray's direction was drawn, per steradian
    Vec3Lanes<float, N> receiver_position, receiver_normal;  ///< of the surface that the ray left (LightReceiver)
    Vec3Lanes<float, N> receiver_to_eye;  ///< its LightLobe, not for SceneKind::plain
    Lanes<float, N> receiver_alpha, receiver_share;
    Lanes<SkySampling, N> receiver_sky;  ///< how the environment was looked for there; for SceneKind::any alone
    ColorLanes<N> absorption;  ///< of the medium that the ray is in, per metre

    REALCAM_INLINE PathState() {
        REALCAM_LANES
        for (int i = 0; i < N; ++i) lane_[i] = i;
    }

    /// As count, but where the path is known to be there, a constant for a GPU.
    REALCAM_INLINE int places() const { return N > 1 ? count : 1; }
    /// Which sample of the block a path belongs to.
    REALCAM_INLINE int lane(int place) const {
        if constexpr (N > 1) return lane_[place];
        return 0;
    }
    REALCAM_INLINE LightLobe receiver_lobe(int place) const {
        return {receiver_to_eye[place], receiver_alpha[place], receiver_share[place]};
    }
    REALCAM_INLINE void set_receiver_lobe(int place, LightLobe lobe) {
        receiver_to_eye.set(place, lobe.to_eye);
        receiver_alpha[place] = lobe.alpha;
        receiver_share[place] = lobe.share;
    }
    /// Moves what a path at a surface still needs of its way there.
    template <SceneKind scene_kind>
    REALCAM_INLINE void move(int from, int to) {
        if constexpr (N > 1) {
            lane_[to] = lane_[from];
            rays.direction.set(to, rays.direction[from]);
            throughput.set(to, throughput[from]);
            weight[to] = weight[from];
            if constexpr (scene_kind != SceneKind::plain) absorption.set(to, absorption[from]);
            if constexpr (scene_kind == SceneKind::any) {
                rays.time[to] = rays.time[from];
                rays.number[to] = rays.number[from];
                // These are kept where a ray continues through a surface that shows nothing but shadows:
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

/// When a path goes through the scene, as a share of the exposure.
template <SceneKind scene_kind, int N>
REALCAM_INLINE float time_of(const PathState<N>& path, int lane) {
    if constexpr (scene_kind == SceneKind::any) return path.rays.time[lane];
    return 0.0f;
}

/// What paths with these effects carry.
template <int N, Effects effects>
struct PathStateWith : PathState<N> {
    WavelengthsWith<N, effects> wavelengths;
};

}  // namespace REALCAM_NAMESPACE
