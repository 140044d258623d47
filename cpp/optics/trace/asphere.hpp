#pragma once
#include <limits>

#include "lens_view.hpp"
#include "refraction.hpp"

namespace REALCAM_NAMESPACE {

template <class T>
struct Sag {
    T height;      ///< z of the surface, mm
    T size;  ///< of the conic's part and of each term, added up: they may cancel, but their roundings do not, mm
    T derivative;  ///< d height / d (r^2)
};

/// Even asphere: z(r) = c r^2 / (1 + sqrt(1 - (1+k) c^2 r^2)) + a4 r^4 + a6 r^6 + ...
/// Outside the search radius the sag goes on as a constant, so that a search never meets a square root of a
/// negative number or a polynomial run wild.
template <class T>
REALCAM_INLINE Sag<T> asphere_sag(const SurfaceView<T>& surface, T radius_squared) {
    using std::fabs;  // dual numbers have a function of this name of their own
    const T r2 = select(radius_squared < surface.search_squared, radius_squared, surface.search_squared);
    const T root = sqrt_or_zero(T(1) - surface.conic_factor * surface.curvature * surface.curvature * r2);
    const T u = r2 * surface.inverse_search_squared, from_middle = u - T(0.5);
    T polynomial = 0, slope = 0, sizes = 0;  // Horner, of p(u) = a4 + a6 u + ... and its derivative; sizes of its terms
    // Always all terms, zeros too: a constant count unrolls, and the loop over the lanes becomes vector code.
    REALCAM_UNROLL
    for (int i = kMaxAsphericTerms - 1; i >= 0; --i) {
        slope = slope * from_middle + polynomial;
        polynomial = polynomial * from_middle + surface.aspheric[i];
        sizes = sizes * T(0.5) + fabs(surface.aspheric[i]);  // at the axis and the rim; the same for all rays
    }
    const T base = quotient(surface.curvature * r2, T(1) + root), departure = u * u * polynomial;
    const T derivative =
        surface.curvature / (T(2) * root) + surface.inverse_search_squared * u * (T(2) * polynomial + u * slope);
    return {base + departure, fabs(base) + u * u * sizes,
            select(radius_squared <= surface.search_squared, derivative, T(0))};
}

/// Search state of N lanes: a root of f(t) = z(t) - sag(r^2(t)). `below` and `above` are ray parameters with f <= 0
/// (the scene's side of the surface) and f >= 0 (the film's): a bracket, in whichever order the ray meets them. A
/// crossing in the right direction lies between them. NaN: the ray does not meet the surface.
template <class T, int N>
struct AsphereSearch {
    Lanes<T, N> t, below, above;
    Lanes<T, N> residual, tolerance;  ///< |f|, and what rounding alone can leave of it
};

/// Newton's steps are taken alone for as long as they suffice on a lens that can be made. Then every other step halves
/// the bracket, which bounds their number for any surface: 2^-digits of a bracket that is at most 2^8 times the scale.
inline constexpr int kNewtonSteps = 6;
template <class T>
inline constexpr int kMaxAsphereSteps = kNewtonSteps + 2 * (std::numeric_limits<T>::digits + 8);

/// Share of the scale by which rounding may move a height: 1 / (16 sqrt(epsilon)) roundings.
template <class T>
inline constexpr T kSteepest = std::numeric_limits<T>::digits == 24 ? T(181) : T(4194304);

/// More than any squared radius.
template <class T>
inline constexpr T kSideways = std::numeric_limits<T>::max() / 4;

/// For a ray that goes through the surface: the sag's bounds are planes on either side of it. Returns how far from the
/// axis (squared, less the square of the search radius) the ray meets the plane of the surface's edge. Where that is
/// positive, the only crossing in this bracket may be one with the plane outside.
template <class T>
REALCAM_INLINE T begin_search(const SurfaceView<T>& surface, Vec3<T> o, Vec3<T> p, T& t, T& below, T& above) {
    const SurfaceHit<T> conic =
        intersect_conic(o, p, surface.curvature, surface.conic_factor, surface.direction_sign_in);
    const T per_z = T(1) / select(p.z == T(0), T(1), p.z);
    below = (surface.sag_min - o.z) * per_z;
    above = (surface.sag_max - o.z) * per_z;
    const bool inside = (conic.parameter - below) * (above - conic.parameter) >= T(0);
    t = select(conic.met() & inside, conic.parameter, T(0.5) * (below + above));
    const T to_edge = (surface.sag_edge - o.z) * per_z;
    const T x = o.x + to_edge * p.x, y = o.y + to_edge * p.y;
    // Less than 3 degrees from the vertex plane, or backwards: out of a fisheye's front, say.
    const bool sideways = p.z * surface.direction_sign_in * std::fabs(p.z) < T(0.0025) * dot(p, p);
    // A sum, because gcc would turn a choice into a branch.
    return x * x + y * y - surface.search_squared + select(sideways, kSideways<T>, T(0));
}

/// A place on a ray: how far it has passed the surface there, and the derivative of that.
template <class T>
struct WaySample {
    T parameter, beyond, slope;
};

/// The first piece of a ray's way, from `middle` - `half` to `middle` + `half`, that begins on the near side of the
/// surface and ends on its far side. In a piece that comes nearer to the surface and turns away again, the turning
/// point may lie on its other side. `sample` makes the WaySample of a parameter. Leaves the bracket as it is where
/// there is none.
template <class T, class Sample>
REALCAM_HD inline bool find_bracket_on_way(T middle, T half, T direction_sign, Sample&& sample, T& t, T& below,
                                           T& above) {
    constexpr int kPieces = 16, kTurnSteps = std::numeric_limits<T>::digits;
    const auto bracketed = [&](T near, T far) {
        below = direction_sign > T(0) ? near : far;
        above = direction_sign > T(0) ? far : near;
        t = T(0.5) * (below + above);
        return true;
    };
    WaySample<T> near = sample(middle - half);
    for (int i = 1; i <= kPieces; ++i) {
        const WaySample<T> far = sample(middle + (T(2) / kPieces * static_cast<T>(i) - T(1)) * half);
        if (near.beyond < T(0) && far.beyond >= T(0)) return bracketed(near.parameter, far.parameter);
        const T side = near.beyond < T(0) ? T(-1) : T(1);
        if (side * far.beyond >= T(0) && side * near.slope < T(0) && side * far.slope > T(0)) {
            T low = near.parameter, high = far.parameter;
            for (int k = 0; k < kTurnSteps; ++k) {
                const WaySample<T> turn = sample(T(0.5) * (low + high));
                if (side * turn.beyond < T(0))
                    return side > T(0) ? bracketed(turn.parameter, far.parameter)
                                       : bracketed(near.parameter, turn.parameter);
                (side * turn.slope < T(0) ? low : high) = turn.parameter;
            }
        }
        near = far;
    }
    return false;
}

/// For the others: a bracket on their way through the search cylinder.
template <class T>
REALCAM_HD inline bool find_bracket(const SurfaceView<T>& surface, Vec3<T> o, Vec3<T> p, T& t, T& below, T& above) {
    const T across = p.x * p.x + p.y * p.y;
    const T middle = -(o.x * p.x + o.y * p.y) / across;
    const T x = o.x + middle * p.x, y = o.y + middle * p.y;
    const T room = surface.search_squared - x * x - y * y;
    if (!(room > T(0))) return false;
    // A little inside: at the very edge the sag's slope is already that of its continuation.
    const T half = (T(1) - T(16) * std::numeric_limits<T>::epsilon()) * std::sqrt(room / across);
    const auto sample = [&](T parameter) -> WaySample<T> {
        const Vec3<T> at = o + parameter * p;
        const Sag<T> sag = asphere_sag(surface, at.x * at.x + at.y * at.y);
        return {parameter, surface.direction_sign_in * (at.z - sag.height),
                surface.direction_sign_in * (p.z - T(2) * sag.derivative * (at.x * p.x + at.y * p.y))};
    };
    return find_bracket_on_way(middle, half, surface.direction_sign_in, sample, t, below, above);
}

/// One safeguarded Newton step. `halve`: not Newton's step but the middle of the bracket.
template <class T>
REALCAM_INLINE void improve_search(const SurfaceView<T>& surface, Vec3<T> o, Vec3<T> p, bool halve, T& t, T& below,
                                   T& above, T& residual, T& tolerance) {
    constexpr T eps = std::numeric_limits<T>::epsilon();
    const Vec3<T> at = o + t * p;
    const Sag<T> sag = asphere_sag(surface, at.x * at.x + at.y * at.y);
    const T f = at.z - sag.height;
    const T slope = p.z - T(2) * sag.derivative * (at.x * p.x + at.y * p.y);
    // Rounding of z(t) and of the sag, and what rounding of x(t) and y(t) becomes where the surface is steep. A wall is
    // as steep as one likes: there the bracket has to shrink until the height fits too. And a ray that starts on the
    // vertex has no lengths at all but the surface's own.
    const T axial = std::fabs(o.z) + std::fabs(t * p.z) + sag.size + T(0.0625) * (surface.sag_max - surface.sag_min);
    const T lateral = std::fabs(T(2) * sag.derivative) * (std::fabs(at.x) * (std::fabs(o.x) + std::fabs(t * p.x)) +
                                                          std::fabs(at.y) * (std::fabs(o.y) + std::fabs(t * p.y)));
    const T most = kSteepest<T> * axial;
    tolerance = T(4) * eps * (axial + select(lateral < most, lateral, most));
    // A root that is crossed in the wrong direction is none.
    const bool right_direction_sign = slope * surface.direction_sign_in >= T(0);
    residual = select(right_direction_sign, std::fabs(f), std::numeric_limits<T>::max());
    // Not both where f is 0: a root in the wrong direction would be all that is left.
    below = select(f <= T(0), t, below);
    above = select(f > T(0), t, above);
    const T newton = t - f / slope;
    const bool inside = (newton - below) * (above - newton) > T(0);
    const T next = select(inside & right_direction_sign & !halve, newton, T(0.5) * (below + above));
    t = select(residual <= tolerance, t, next);
}

/// `slack`: by how much the search ended within its tolerance. A hit counts where that is not negative and the ray
/// crosses in the right direction; one number says both, because gcc does not vectorise a chain of truth values here.
template <class T>
REALCAM_INLINE SurfaceHit<T> asphere_hit(const SurfaceView<T>& surface, Vec3<T> o, Vec3<T> p, T t, T slope, T slack) {
    const Vec3<T> at = o + t * p;
    const Vec3<T> normal = normalized(Vec3<T>{-slope * at.x, -slope * at.y, T(1)});
    const T along_normal = dot(p, normal);
    const T crossing = along_normal * surface.direction_sign_in;
    return {t, along_normal, normal, select(crossing < slack, crossing, slack)};
}

}  // namespace REALCAM_NAMESPACE
