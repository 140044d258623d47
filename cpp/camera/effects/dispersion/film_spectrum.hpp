#pragma once
#include <array>
#include <optional>
#include <vector>

#include "../../../optics/prescription/known_wavelengths.hpp"
#include "../filter/lens_filter.hpp"
#include "dispersion_view.hpp"
#include "illuminant.hpp"

namespace REALCAM_NAMESPACE {

// Scenes are RGB. The colour of a surface or light is upsampled to a spectrum with the basis of Mallett and Yuksel
// (2019), times that of the illuminant. For each wavelength, film and sRGB form a 3 x 3 matrix from the scene's colour
// to the picture's. Its integral over the visible wavelengths is the identity for D65, sRGB's white. For any illuminant
// the film is white-balanced: each channel is scaled so that white stays white. A filter in front of the lens scales
// the matrix at each wavelength after this balance, so that its colour shows.

namespace film_spectrum_detail {

using Matrix = std::array<double, 9>;  ///< row by row

/// CIE XYZ to linear sRGB (IEC 61966-2-1).
inline constexpr Matrix kSrgbFromXyz = {3.2404542, -1.5371385, -0.4985314, -0.9692660, 1.8760108,
                                        0.0415560, 0.0556434,  -0.2040259, 1.0572252};

/// Matrix product a b.
Matrix product(const Matrix& a, const Matrix& b);

/// Inverse of an invertible matrix.
Matrix inverse(const Matrix& m);

/// Red, green and blue basis spectra at a wavelength from 380 to 780 nm; their sum is 1.
std::array<double, 3> basis_at(double wavelength_nm);

/// Sum of the elements of a row: response of a film channel to white.
inline double row_sum(const Matrix& m, std::size_t row) {
    return m[3 * row] + m[3 * row + 1] + m[3 * row + 2];
}

}  // namespace film_spectrum_detail

/// Wavelengths of a picture under an illuminant, and the film's matrix over them.
class FilmSpectrum {
public:
    static constexpr int kCells = 64 * kSharedWavelengths;

    /// Throws InputError if the illuminant has too little of a colour for white to be balanced, or no light of it
    /// passes the filter.
    explicit FilmSpectrum(const Illuminant& illuminant, const std::optional<LensFilter>& filter = {});
    /// Uniform over a range of wavelengths, in one cell whose film matrix is the identity; for rays without a colour.
    explicit FilmSpectrum(WavelengthRange range);

    const std::vector<WavelengthCell>& cells() const { return cells_; }
    WavelengthRange range() const {
        return {static_cast<double>(cells_.front().first_nm), static_cast<double>(cells_.back().last_nm)};
    }
    /// Mean of WavelengthCell::film over all cells.
    std::array<float, 9> mean_film() const;
    /// 32 wavelengths with the distribution of those of samples.
    std::vector<double> even_wavelengths() const;

private:
    std::vector<WavelengthCell> cells_;
};

}  // namespace REALCAM_NAMESPACE
