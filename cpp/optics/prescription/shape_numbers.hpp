#pragma once
#include <array>
#include <vector>

#include "surface.hpp"

namespace REALCAM_NAMESPACE {

/// The numbers that define a surface's shape, as in Surface and SurfaceForm. T: double, or dual numbers for derivatives
/// with respect to them.
template <class T>
struct ShapeNumbers {
    T curvature, conic, curvature_x, conic_x;
    std::vector<T> aspheric, radial;
    std::vector<XyTermOf<T>> xy;
    std::array<std::vector<T>, kFormTermsCount>
        terms;  ///< coefficients of each kind of terms, in the order of kFormTerms

    explicit ShapeNumbers(const Surface& surface)
        : curvature(surface.curvature),
          conic(surface.conic),
          curvature_x(surface.form.curvature_x),
          conic_x(surface.form.conic_x),
          aspheric(surface.aspheric.begin(), surface.aspheric.end()),
          radial(surface.form.radial.begin(), surface.form.radial.end()) {
        for (const XyTerm& term : surface.form.xy) xy.push_back({term.x, term.y, term.coefficient});
        std::size_t kind = 0;
        for_each_kind_of_terms(surface.form, [&](const auto& optional) {
            if (optional) terms[kind].assign(optional->coefficients.begin(), optional->coefficients.end());
            ++kind;
        });
    }
};

}  // namespace REALCAM_NAMESPACE
