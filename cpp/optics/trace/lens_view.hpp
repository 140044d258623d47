#pragma once
#include <cstdint>

#include "../../math/vec3.hpp"
#include "../prescription/lens_limits.hpp"
#include "aperture.hpp"
#include "freeform.hpp"

namespace REALCAM_NAMESPACE {

// A lens as the ray trace reads it: surfaces in the order of the light, as plain structures of numbers.

inline constexpr int kStartTerms = 8;  ///< terms of the polynomial from which the search on an asphere starts

/// Shape of a surface, which selects the code that intersects it. A plane is a sphere of curvature 0.
enum class SurfaceShape : int { sphere, conic, asphere, freeform };

/// One surface of a path. Lengths in mm. Members that every ray needs come first, in groups that a GPU loads at once.
template <class T>
struct alignas(16) SurfaceView {
    T shift;  ///< z of the vertex relative to the previous one in the order of the light
    T curvature;  ///< 1/mm, positive if the centre lies on the film side; 0: plane
    T direction_sign_in;  ///< +1 if the incoming ray travels towards the film, -1 if towards the scene (a mirror
                          ///< reverses it)
    T direction_sign_out;  ///< the same for the outgoing ray
    T squared_index_change;  ///< n'^2 / n^2 - 1, n before and n' behind the surface
    T rim_squared;  ///< squared clear semi-diameter
    T hole_squared;  ///< squared radius inside which light is blocked; negative: no hole
    T index_squared;  ///< n^2 of the medium before the surface
    SurfaceShape kind;
    std::int32_t has_blades;  ///< 1: the stop of a lens that has an iris
    std::int32_t surface_index;  ///< index in the lens system, 0 at the front
    T conic_factor;  ///< 1 + k, k the conic constant
    T sag_min, sag_max;  ///< aspheres: bounds of the sag inside the search radius
    T sag_edge;  ///< aspheres: the sag at the search radius
    T search_squared;  ///< aspheres: squared search radius, mm^2; outside it the sag continues as a constant
    T inverse_search_squared;  ///< 1 / search_squared, 1/mm^2
    /// Coefficients of u^2 times the powers of u - 1/2, with u = r^2 / search_squared, mm; unused ones are 0. The
    /// coefficients of the prescription would leave the range of float32 for very large and very small surfaces. Those
    /// of powers of u, which cancel towards the rim, would be a hundred times as large as these.
    T aspheric[kMaxAsphericTerms];
    T inner_u;  ///< aspheres: u at the edge of the inner part, in which the surface may be less steep than outside
    /// Aspheres: a ray crosses the surface exactly once if the squared tangent of its angle to the axis, over
    /// search_squared, is less than this bound. The first bound is for rays that stay in the inner part, the second for
    /// all rays. 0: unknown for all rays.
    T crossed_once_inside, crossed_once;
    T start_parabola;  ///< aspheres: the paraboloid that approximates the sag is this times u, mm
    T start[kStartTerms];  ///< aspheres: coefficients of u, u^2, ... in a polynomial that approximates the sag, conic
                           ///< included, mm
};

/// The opening of the aperture stop: n blades whose inner edges are arcs of one curvature.
template <class T>
struct Iris {
    int blades;  ///< number of blades; 0: the stop is round, and only its rim blocks light
    T apothem;  ///< distance from the axis to the midpoint of a blade's edge, mm
    T curvature;  ///< curvature of the blade's edge, 1/mm: 0 straight, 1/apothem a circle
    T cos[kMaxIrisBlades], sin[kMaxIrisBlades];  ///< direction from the axis to each blade's midpoint
};

/// A rigid change of frame: converts coordinates in an old frame to those in a new one.
template <class T>
struct alignas(16) FrameChange {
    Vec3<T> origin;  ///< origin of the new frame, in the old one, mm
    Vec3<T> x, y, z;  ///< axes of the new frame, in the old one
    std::int32_t changes;  ///< 0: both frames are the same

    REALCAM_INLINE Vec3<T> direction(Vec3<T> d) const { return {dot(x, d), dot(y, d), dot(z, d)}; }
    REALCAM_INLINE Vec3<T> point(Vec3<T> p) const { return direction(p - origin); }
};

/// Frame changes at a surface of a lens that is not centred.
template <class T>
struct FrameChanges {
    FrameChange<T> before;  ///< from the frame of the previous surface, or of the entering rays; if set, the surface's
                            ///< shift is 0
    FrameChange<T> out;  ///< from the surface's frame to the exit frame, used if it is the last surface
};

/// Data of lenses without rotational symmetry, which only LensKind::any has: arrays with an element for each surface,
/// in the order of the light, or null.
template <class T>
struct AsymmetricParts {
    const FrameChanges<T>* frames = nullptr;
    const FreeformView<T>* freeforms = nullptr;  ///< read only for surfaces that are freeforms
    const ApertureView<T>* apertures = nullptr;

    /// Returns the data of the surfaces from `first` on.
    REALCAM_INLINE AsymmetricParts from(int first) const {
        return {frames ? frames + first : nullptr, freeforms ? freeforms + first : nullptr,
                apertures ? apertures + first : nullptr};
    }

    /// Calls move(array, count) with each pointer, by reference, and the number of its elements: to copy the arrays to
    /// another memory. `surfaces`: number of surfaces.
    template <class Move>
    void move_arrays(int surfaces, Move&& move) {
        move(frames, surfaces);
        move(freeforms, surfaces);
        move(apertures, surfaces);
    }
};

/// Class of lens for which tracing code is specialised, from the most special to the most general. Code for plain
/// lenses needs fewer registers and instructions, which are scarce on a GPU.
enum class LensKind : int {
    plain,  ///< spheres and planes without holes, and a stop without blades
    rotational,  ///< a centred, rotationally symmetric lens
    any,  ///< surfaces may be tilted, decentred and of any shape, with apertures of any shape
};

/// A lens in one state of focus and stop, at one wavelength and in one direction of the light. Trivially copyable; the
/// surfaces belong to a LensPath.
template <class T>
struct LensView {
    const SurfaceView<T>* surfaces;
    int count;  ///< number of surfaces
    LensKind kind;
    Iris<T> iris;
    AsymmetricParts<T> free = {};  ///< read only if the kind is `any`
};

}  // namespace REALCAM_NAMESPACE
