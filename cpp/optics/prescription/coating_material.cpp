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
    const double t = (wavelength_nm - a.wavelength_nm) / (b.wavelength_nm - a.wavelength_nm);
    return {a.n + t * (b.n - a.n), a.k + t * (b.k - a.k)};
}

void CoatingMaterial::fail(double wavelength_nm, double first, double last) const {
    throw InputError(subject() + " is known from " + nm(first) + " to " + nm(last) + "; " + nm(wavelength_nm) +
                     " was requested");
}

CoatingMaterial aluminium() {
    return {
        Glass::air(),
        {{177.12, 0.094236, 1.9519}, {206.64, 0.12677, 2.3563}, {247.97, 0.18137, 2.9029}, {309.96, 0.28003, 3.7081},
         {326.28, 0.31474, 3.9165},  {364.66, 0.39877, 4.3957}, {413.28, 0.52135, 5.0008}, {442.80, 0.60790, 5.3676},
         {476.87, 0.72780, 5.7781},  {516.60, 0.87340, 6.2418}, {563.57, 1.0728, 6.7839},  {619.93, 1.3660, 7.4052},
         {652.25, 1.5724, 7.7354},   {688.81, 1.8301, 8.0601},  {729.32, 2.1606, 8.3565},  {774.91, 2.6154, 8.4914},
         {794.78, 2.7675, 8.3866},   {815.69, 2.7668, 8.2573},  {837.74, 2.6945, 8.1878},  {885.61, 2.2802, 8.1134},
         {911.66, 1.9739, 8.3058},   {939.28, 1.6784, 8.5970},  {968.63, 1.4867, 9.0655},  {999.88, 1.4359, 9.4939},
         {1033.2, 1.3998, 9.8914},   {1127.1, 1.3281, 10.969},  {1239.9, 1.3157, 12.245},  {1377.6, 1.3899, 13.784},
         {1549.8, 1.5782, 15.656},   {1771.2, 1.9205, 17.991},  {2066.4, 2.4738, 20.982}},
        "aluminium"};
}

CoatingMaterial silver() {
    return {
        Glass::air(),
        {{187.9, 1.07, 1.212}, {191.6, 1.10, 1.232}, {195.3, 1.12, 1.255}, {199.3, 1.14, 1.277}, {203.3, 1.15, 1.296},
         {207.3, 1.18, 1.312}, {211.9, 1.20, 1.325}, {216.4, 1.22, 1.336}, {221.4, 1.25, 1.342}, {226.2, 1.26, 1.344},
         {231.3, 1.28, 1.357}, {237.1, 1.28, 1.367}, {242.6, 1.30, 1.378}, {249.0, 1.31, 1.389}, {255.1, 1.33, 1.393},
         {261.6, 1.35, 1.387}, {268.9, 1.38, 1.372}, {276.1, 1.41, 1.331}, {284.4, 1.41, 1.264}, {292.4, 1.39, 1.161},
         {300.9, 1.34, 0.964}, {310.7, 1.13, 0.616}, {320.4, 0.81, 0.392}, {331.5, 0.17, 0.829}, {342.5, 0.14, 1.142},
         {354.2, 0.10, 1.419}, {367.9, 0.07, 1.657}, {381.5, 0.05, 1.864}, {397.4, 0.05, 2.070}, {413.3, 0.05, 2.275},
         {430.5, 0.04, 2.462}, {450.9, 0.04, 2.657}, {471.4, 0.05, 2.869}, {495.9, 0.05, 3.093}, {520.9, 0.05, 3.324},
         {548.6, 0.06, 3.586}, {582.1, 0.05, 3.858}, {616.8, 0.06, 4.152}, {659.5, 0.05, 4.483}, {704.5, 0.04, 4.838},
         {756.0, 0.03, 5.242}, {821.1, 0.04, 5.727}, {892.0, 0.04, 6.312}, {984.0, 0.04, 6.992}, {1088, 0.04, 7.795},
         {1216, 0.09, 8.828},  {1393, 0.13, 10.10},  {1610, 0.15, 11.85},  {1937, 0.24, 14.08}},
        "silver"};
}

}  // namespace realcam
