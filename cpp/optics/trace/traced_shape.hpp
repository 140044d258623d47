#pragma once
#include <algorithm>
#include <cmath>
#include <list>
#include <vector>

#include "asphere_start.hpp"
#include "make_freeform.hpp"

namespace REALCAM_NAMESPACE {

/// Shape of a surface of any kind, prepared for tracing.
template <class T>
struct TracedShape {
    SurfaceView<T> view;  ///< its shift, indices and direction signs are not set
    FreeformView<T> freeform;  ///< set if `view` is a SurfaceShape::freeform
};

namespace traced_shape_detail {

/// Sets the search radius of an asphere, and the polynomials and bounds of its sag inside it. The search extends 2%
/// past the rim, so that a ray that just misses it is found to miss it. The sag's bounds are sampled, and widened by
/// more than the sag of a surface that can be made changes between two samples.
template <class T>
void set_search_region(SurfaceView<T>& view, const Surface& surface) {
    double reach = 1.02 * surface.clear_semi_diameter;
    if (!std::isfinite(surface.sag(reach))) reach = surface.clear_semi_diameter;
    constexpr int kSamples = 256;
    double low = 0, high = 0;
    for (int i = 1; i <= kSamples; ++i) {
        const double sag = surface.sag(reach * i / kSamples);
        low = std::min(low, sag);
        high = std::max(high, sag);
    }
    const double margin = 0.02 * (high - low) + 1e-3 * reach;
    view.sag_edge = static_cast<T>(surface.sag(reach));
    view.search_squared = static_cast<T>(reach * reach);
    view.inverse_search_squared = static_cast<T>(1 / (reach * reach));
    // Products instead of std::pow, whose rounding would differ between the powers of a radius and of twice the radius.
    std::vector<long double> terms;
    long double power = static_cast<long double>(reach) * reach;
    for (const double coefficient : surface.aspheric)
        terms.push_back(coefficient * (power *= static_cast<long double>(reach) * reach));
    set_terms(view, terms);
    view.sag_min = static_cast<T>(low - margin);
    view.sag_max = static_cast<T>(high + margin);
    set_start(view, surface, terms);
}

/// Returns the view of a surface's shape and rim, without media and position.
template <class T>
SurfaceView<T> shape_view(const Surface& surface) {
    SurfaceView<T> view{};
    view.kind = !surface.form.adds_nothing() ? SurfaceShape::freeform
                : surface.is_asphere()       ? SurfaceShape::asphere
                : surface.conic != 0         ? SurfaceShape::conic
                                             : SurfaceShape::sphere;
    view.curvature = static_cast<T>(surface.curvature);
    view.conic_factor = static_cast<T>(1 + surface.conic);
    const double rim = surface.clear_semi_diameter, hole = surface.inner_semi_diameter;
    view.rim_squared = static_cast<T>(rim * rim);
    view.hole_squared = static_cast<T>(hole > 0 ? hole * hole : -1.0);
    if (view.kind == SurfaceShape::asphere) set_search_region(view, surface);
    // Curvature of the sphere from which the search on a freeform starts.
    if (view.kind == SurfaceShape::freeform && surface.form.base != BaseForm::conic)
        view.curvature = static_cast<T>(0.5 * (surface.curvature + surface.form.curvature_x));
    return view;
}

/// True if all numbers on which a TracedShape depends are equal.
inline bool have_same_shape(const Surface& a, const Surface& b) {
    return a.curvature == b.curvature && a.conic == b.conic && a.clear_semi_diameter == b.clear_semi_diameter &&
           a.inner_semi_diameter == b.inner_semi_diameter && a.aspheric == b.aspheric && a.form == b.form &&
           a.aperture_shape == b.aperture_shape;
}

}  // namespace traced_shape_detail

/// Returns the shape of a surface, prepared for tracing. Each thread caches the aspheres and freeforms that it used
/// last: finding their bounds takes as long as tracing hundreds of rays, and while a lens is focused or edited nearly
/// all of its surfaces remain unchanged.
template <class T>
TracedShape<T> traced_shape(const Surface& surface) {
    using namespace traced_shape_detail;
    if (!surface.is_asphere() && surface.form.adds_nothing()) return {shape_view<T>(surface), {}};
    constexpr std::size_t kMaxEntries = 64;
    struct Entry {
        Surface surface;
        TracedShape<T> shape;
    };
    thread_local std::list<Entry> cache;  // most recently used first
    const auto found = std::find_if(cache.begin(), cache.end(),
                                    [&](const Entry& entry) { return have_same_shape(entry.surface, surface); });
    if (found != cache.end()) {
        cache.splice(cache.begin(), cache, found);
    } else {
        const FreeformView<T> freeform = surface.form.adds_nothing() ? FreeformView<T>{} : freeform_view<T>(surface);
        cache.push_front({surface, {shape_view<T>(surface), freeform}});
        if (cache.size() > kMaxEntries) cache.pop_back();
    }
    return cache.front().shape;
}

}  // namespace REALCAM_NAMESPACE
