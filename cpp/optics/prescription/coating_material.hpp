#pragma once
#include <complex>
#include <string>
#include <utility>
#include <vector>

#include "glass.hpp"

namespace REALCAM_NAMESPACE {

/// Refractive index n + i k, relative to air, of a film or a metal, as a function of the wavelength. The time
/// dependence is exp(-i omega t), so that k > 0 absorbs.
struct CoatingMaterial {
    /// Refractive index n + i k at one wavelength.
    struct Point {
        double wavelength_nm, n, k;

        bool operator==(const Point&) const = default;
    };

    Glass glass = Glass::air();  ///< gives n, with k = 0, if `points` is empty
    /// Measured n and k by ascending wavelength, interpolated linearly. A single point holds at all wavelengths.
    std::vector<Point> points;
    std::string label;  ///< name given by its author; if empty, name() is the glass's label

    bool operator==(const CoatingMaterial&) const = default;

    /// Material without absorption.
    static CoatingMaterial transparent(Glass glass) { return {std::move(glass), {}, {}}; }
    /// Material whose index is the same at all wavelengths.
    static CoatingMaterial constant(std::complex<double> index) {
        return {Glass::air(), {{kLineD_nm, index.real(), index.imag()}}, {}};
    }

    const std::string& name() const { return label.empty() ? glass.label : label; }

    /// Returns n + i k. Throws InputError, naming the material, if the index is not known at this wavelength.
    std::complex<double> index(double wavelength_nm) const;

private:
    /// Formats a wavelength: "550 nm".
    static std::string nm(double wavelength_nm) { return std::to_string(std::lround(wavelength_nm)) + " nm"; }
    /// Names the material in a message.
    std::string subject() const { return "the coating material" + (name().empty() ? "" : " \"" + name() + '"'); }
    /// Throws InputError: `wavelength_nm` lies outside the known range `first` to `last`, nm.
    [[noreturn]] void fail(double wavelength_nm, double first, double last) const;
};

// Measured refractive indices of mirror metals, as clean evaporated films.

/// A. D. Rakic, "Algorithm for the determination of intrinsic optical constants of metal films: application to
/// aluminum", Appl. Opt. 34, 4755 (1995), table 1.
CoatingMaterial aluminium();

/// P. B. Johnson and R. W. Christy, "Optical constants of the noble metals", Phys. Rev. B 6, 4370 (1972), table I.
CoatingMaterial silver();

}  // namespace REALCAM_NAMESPACE
