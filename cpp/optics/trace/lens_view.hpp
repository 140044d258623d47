#pragma once
#include <cstdint>

#include "../../math/vec3.hpp"
#include "../prescription/lens_limits.hpp"
#include "aperture.hpp"
#include "freeform.hpp"

namespace REALCAM_NAMESPACE {

inline constexpr int kStartTerms = 8;  ///< of the polynomial from which the search on an asphere starts

enum class SurfaceShape : int { sphere, conic, asphere, freeform };

/// One surface in the order in which the light meets it. Lengths in mm. What every ray needs comes first, in pieces
/// that a GPU loads at once.
template <class T>
struct alignas(16) SurfaceView {
    T shift;               ///< axial distance from the vertex before this one
    T curvature;           ///< 0: plane
    T direction_sign_in;  ///< +1 where the ray crosses towards the film, -1 towards the scene (a mirror turns it)
    T direction_sign_out;
    T squared_index_change;  ///< n'^2 / n^2 - 1
    T rim_squared;  ///< squared clear semi-diameter
    T hole_squared;  ///< squared radius inside which light is blocked; negative: none
    T index_squared;  ///< n^2 of the medium before the surface
    SurfaceShape kind;
    std::int32_t has_blades;  ///< 1: the stop of a lens that has an iris
    std::int32_t surface_index;  ///< in the lens system, 0 at the front
    T conic_factor;  ///< 1 + k
    T sag_min, sag_max;  ///< aspheres: bounds of the sag inside the search radius
    T sag_edge;  ///< aspheres: the sag at the search radius
    T search_squared;  ///< aspheres: the sag is continued as constant outside this squared radius
    T inverse_search_squared;
    /// Coefficients of u^2 times the powers of u - 1/2, with u = r^2 / search_squared, mm; zeros after the last. The
    /// polynomial's own coefficients leave the range of float32 where surfaces are large or small. Powers of u, where
    /// they cancel towards the rim, would be a hundred times as large as these.
    T aspheric[kMaxAsphericTerms];
    T inner_share;  ///< aspheres: a part of search_squared, out to which the surface may be less steep than beyond
    /// Aspheres: a ray crosses the surface once where the squared tangent of its angle with the axis, over
    /// search_squared, is less than this. One bound is for rays that stay in the inner part, the other for all. 0: not
    /// known of any.
    T crossed_once_inside, crossed_once;
    T start_parabola;  ///< aspheres: the sag is about this times u, mm
    T start[kStartTerms];  ///< and nearly these times u, u^2, ..., with the conic's part
};

/// The opening of the aperture stop: n blades whose inner edges are arcs of one curvature.
template <class T>
struct Iris {
    int blades;
    T apothem;  ///< distance from the axis to the middle of a blade's edge
    T curvature;  ///< of the edge: 0 straight, 1/apothem a circle
    T cos[kMaxIrisBlades], sin[kMaxIrisBlades];
};

/// A rigid change of frame.
template <class T>
struct alignas(16) FrameChange {
    Vec3<T> origin;  ///< of the new frame, in the old one
    Vec3<T> x, y, z;  ///< its axes
    std::int32_t changes;  ///< 0: both frames are the same

    REALCAM_INLINE Vec3<T> direction(Vec3<T> d) const { return {dot(x, d), dot(y, d), dot(z, d)}; }
    REALCAM_INLINE Vec3<T> point(Vec3<T> p) const { return direction(p - origin); }
};

/// Of a surface of a lens that is not centred.
template <class T>
struct FrameChanges {
    FrameChange<T> before;  ///< from the frame of the surface before, or of the rays that enter; then its shift is 0
    FrameChange<T> out;  ///< from the surface's frame to that in which rays leave, if it is the last
};

/// What makes a lens one of kind `any`: arrays of a member for each surface, or null.
template <class T>
struct FreeParts {
    const FrameChanges<T>* frames = nullptr;
    const FreeformView<T>* freeforms = nullptr;  ///< read for freeforms alone
    const ApertureView<T>* apertures = nullptr;

    /// Those from surface `first` on.
    REALCAM_INLINE FreeParts from(int first) const {
        return {frames ? frames + first : nullptr, freeforms ? freeforms + first : nullptr,
                apertures ? apertures + first : nullptr};
    }

    /// move(array, count) for every array.
    template <class Move>
    void move_arrays(int surfaces, Move&& move) {
        move(frames, surfaces);
        move(freeforms, surfaces);
        move(apertures, surfaces);
    }
};

/// What a lens consists of. Code for plain ones alone needs fewer registers and instructions, of which a GPU has few.
enum class LensKind : int {
    plain,  ///< spheres and planes, open up to their rims, and a stop without blades
    rotational,  ///< a centred lens of revolution
    any,  ///< surfaces may be tilted, decentred and of any form, with apertures of any shape
};

/// A lens in one state of focus and stop, at one wavelength and in one direction of the light.
/// Trivially copyable; the surfaces belong to a LensPath.
template <class T>
struct LensView {
    const SurfaceView<T>* surfaces;
    int count;
    LensKind kind;
    Iris<T> iris;
    FreeParts<T> free = {};  ///< read only where the kind is `any`
};

}  // namespace REALCAM_NAMESPACE
