#pragma once
#include <array>
#include <vector>

#include "surface.hpp"

namespace REALCAM_NAMESPACE {

/// The numbers of a surface's shape. T: double, or dual numbers for derivatives with respect to them.
template <class T>
struct ShapeNumbers {
    T curvature, conic, curvature_x, conic_x;
    std::vector<T> aspheric, radial;
    std::vector<XyTermOf<T>> xy;
    std::array<std::vector<T>, kFormTermsCount> terms;  ///< coefficients, in the order of kFormTerms

    explicit ShapeNumbers(const Surface& surface)
        : curvature(surface.curvature),
          conic(surface.conic),
          curvature_x(surface.form.curvature_x),
          conic_x(surface.form.conic_x),
          aspheric(surface.aspheric.begin(), surface.aspheric.end()),
          radial(surface.form.radial.begin(), surface.form.radial.end()) {
        for (const XyTerm& term : surface.form.xy) xy.push_back({term.x, term.y, term.coefficient});
        std::size_t row = 0;
        over_rows(surface.form, [&](const auto& of) {
            if (of) terms[row].assign(of->coefficients.begin(), of->coefficients.end());
            ++row;
        });
    }
};

}  // namespace REALCAM_NAMESPACE
