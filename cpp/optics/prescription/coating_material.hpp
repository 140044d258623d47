#pragma once
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
    std::complex<double> index(double wavelength_nm) const;

private:
    static std::string nm(double wavelength_nm) { return std::to_string(std::lround(wavelength_nm)) + " nm"; }
    std::string subject() const { return "the coating material" + (name().empty() ? "" : " \"" + name() + '"'); }
    [[noreturn]] void fail(double wavelength_nm, double first, double last) const;
};

}  // namespace REALCAM_NAMESPACE
