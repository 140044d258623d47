#include "coating_material.hpp"

#include <algorithm>

namespace realcam {

std::complex<double> CoatingMaterial::index(double wavelength_nm) const {
    if (points.size() == 1) return {points.front().n, points.front().k};
    const auto [first, last] =
        points.empty() ? glass.known_nm() : std::pair{points.front().wavelength_nm, points.back().wavelength_nm};
    // Tolerance of 0.05 nm: a table that ends at 656.3 is meant for the line at 656.27.
    if (wavelength_nm < first - 0.05 || wavelength_nm > last + 0.05) fail(wavelength_nm, first, last);
    if (points.empty()) {
        const double n = glass.index(wavelength_nm);
        if (!(n > 0.1 && n < 100)) throw InputError(subject() + " has no refractive index at " + nm(wavelength_nm));
        return n;
    }
    const auto above = std::upper_bound(points.begin() + 1, points.end() - 1, wavelength_nm,
                                        [](double nm, const Point& point) { return nm < point.wavelength_nm; });
    const Point &a = *(above - 1), &b = *above;
    const double share = (wavelength_nm - a.wavelength_nm) / (b.wavelength_nm - a.wavelength_nm);
    return {a.n + share * (b.n - a.n), a.k + share * (b.k - a.k)};
}

void CoatingMaterial::fail(double wavelength_nm, double first, double last) const {
    throw InputError(subject() + " is known from " + nm(first) + " to " + nm(last) + "; " + nm(wavelength_nm) +
                     " is wanted");
}

}  // namespace realcam
