#pragma once
#include <algorithm>
#include <complex>
#include <string>
#include <utility>
#include <vector>

#include "glass.hpp"

namespace REALCAM_NAMESPACE {

/// Refractive index n + i k, relative to air, of a film or a metal. Light that goes as exp(i (k x - omega t)) is
/// absorbed where k > 0.
struct CoatingMaterial {
    struct Point {
        double wavelength_nm, n, k;

        bool operator==(const Point&) const = default;
    };

    Glass glass = Glass::air();  ///< n where there are no points; k is 0 then
    /// Measured n and k, by rising wavelength, straight lines between them. A single point holds at all wavelengths.
    std::vector<Point> points;
    std::string label;  ///< as its author wrote it; empty: as the glass is called

    bool operator==(const CoatingMaterial&) const = default;

    static CoatingMaterial transparent(Glass glass) { return {std::move(glass), {}, {}}; }
    static CoatingMaterial constant(std::complex<double> index) {
        return {Glass::air(), {{kLineD_nm, index.real(), index.imag()}}, {}};
    }

    const std::string& name() const { return label.empty() ? glass.label : label; }

    /// Throws InputError, with the material's name, at a wavelength at which it is not known.
    std::complex<double> index(double wavelength_nm) const {
        if (points.size() == 1) return {points.front().n, points.front().k};
        const auto [first, last] =
            points.empty() ? glass.known_nm() : std::pair{points.front().wavelength_nm, points.back().wavelength_nm};
        // A tenth of a nanometre: a table that ends at 656.3 is meant for the line at 656.27.
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

private:
    static std::string nm(double wavelength_nm) { return std::to_string(std::lround(wavelength_nm)) + " nm"; }
    std::string subject() const { return "the coating material" + (name().empty() ? "" : " \"" + name() + '"'); }
    [[noreturn]] void fail(double wavelength_nm, double first, double last) const {
        throw InputError(subject() + " is known from " + nm(first) + " to " + nm(last) + "; " + nm(wavelength_nm) +
                         " is wanted");
    }
};

}  // namespace REALCAM_NAMESPACE
