#include "film_spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "../../../optics/trace/lens_dispersion.hpp"

namespace realcam {

namespace film_spectrum_detail {

Matrix product(const Matrix& a, const Matrix& b) {
    Matrix c{};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            for (std::size_t k = 0; k < 3; ++k) c[3 * i + j] += a[3 * i + k] * b[3 * k + j];
    return c;
}

Matrix inverse(const Matrix& m) {
    const auto minor = [&](std::size_t a, std::size_t b, std::size_t c, std::size_t d) {
        return m[a] * m[d] - m[b] * m[c];
    };
    const Matrix cofactors = {minor(4, 5, 7, 8),  -minor(1, 2, 7, 8), minor(1, 2, 4, 5),
                              -minor(3, 5, 6, 8), minor(0, 2, 6, 8),  -minor(0, 2, 3, 5),
                              minor(3, 4, 6, 7),  -minor(0, 1, 6, 7), minor(0, 1, 3, 4)};
    const double determinant = m[0] * cofactors[0] + m[1] * cofactors[3] + m[2] * cofactors[6];
    Matrix result{};
    for (std::size_t i = 0; i < 9; ++i) result[i] = cofactors[i] / determinant;
    return result;
}

std::array<double, 3> basis_at(double wavelength_nm) {
    const double r = Illuminant::at(kBasisRed, wavelength_nm), g = Illuminant::at(kBasisGreen, wavelength_nm),
                 b = Illuminant::at(kBasisBlue, wavelength_nm), sum = r + g + b;  // 1 up to rounding
    return {r / sum, g / sum, b / sum};
}

namespace {

/// Film matrix per nm at a wavelength where the illuminant has this power, before white balance.
Matrix matrix_at(double wavelength_nm, double power) {
    const double x = Illuminant::at(kObserverX, wavelength_nm), y = Illuminant::at(kObserverY, wavelength_nm),
                 z = Illuminant::at(kObserverZ, wavelength_nm);
    const std::array<double, 3> basis = basis_at(wavelength_nm);
    Matrix m{};
    for (std::size_t row = 0; row < 3; ++row) {
        const double film =
            power * (kSrgbFromXyz[3 * row] * x + kSrgbFromXyz[3 * row + 1] * y + kSrgbFromXyz[3 * row + 2] * z);
        for (std::size_t column = 0; column < 3; ++column) m[3 * row + column] = film * basis[column];
    }
    return m;
}

/// Piece of the spectrum in which all tables are linear.
struct Piece {
    double first, last;  ///< nm
    Matrix film;         ///< integral of the film matrix
    double density = 0;  ///< integral of the sampling density, not normalised
};

/// Pieces of 0.5 nm, split at the points of a table. Simpson's rule is exact in each up to the division by the sum of
/// the basis: the product of three linear functions is a cubic.
std::vector<Piece> pieces_of(const Illuminant& illuminant, const std::optional<LensFilter>& filter) {
    std::vector<double> knots;
    for (double nm = kFirstWavelength_nm; nm <= kLastWavelength_nm; nm += 0.5) knots.push_back(nm);
    const auto add_knots = [&](const std::vector<SpectrumPoint>& points) {
        for (const SpectrumPoint& point : points)
            if (point.wavelength_nm > kFirstWavelength_nm && point.wavelength_nm < kLastWavelength_nm)
                knots.push_back(point.wavelength_nm);
    };
    add_knots(illuminant.points());
    if (filter) add_knots(filter->points());
    std::sort(knots.begin(), knots.end());
    std::vector<Piece> pieces;
    for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
        const double a = knots[i], b = knots[i + 1];
        if (!(b > a)) continue;
        Piece piece{a, b, {}};
        // Evaluated slightly inside the ends: power jumps where a table begins or ends.
        const double inside = 1e-9 * (b - a);
        const auto add = [&](double nm, double weight) {
            const Matrix m = matrix_at(nm, illuminant.power(nm) * (filter ? filter->transmittance(nm) : 1));
            for (std::size_t k = 0; k < 9; ++k) piece.film[k] += weight * (b - a) / 6 * m[k];
        };
        add(a + inside, 1);
        add(0.5 * (a + b), 4);
        add(b - inside, 1);
        pieces.push_back(piece);
    }
    return pieces;
}

Matrix sum_of(const std::vector<Piece>& pieces) {
    Matrix sum{};
    for (const Piece& piece : pieces)
        for (std::size_t k = 0; k < 9; ++k) sum[k] += piece.film[k];
    return sum;
}

/// Corrects the matrices of the pieces so that their integral under D65 is the identity, from which the tables differ
/// by a thousandth, and white-balances the film to the illuminant without the filter. Throws InputError if the
/// illuminant has too little of a colour.
void balance(std::vector<Piece>& pieces, const Illuminant& illuminant, bool is_filtered) {
    const Matrix to_identity = inverse(sum_of(pieces_of(Illuminant::named("D65"), {})));
    const auto corrected = [&](std::vector<Piece> list) {
        for (Piece& piece : list) piece.film = product(to_identity, piece.film);
        return list;
    };
    pieces = corrected(std::move(pieces));
    const std::vector<Piece> unfiltered = is_filtered ? corrected(pieces_of(illuminant, {})) : pieces;
    const Matrix sum = sum_of(unfiltered);
    for (std::size_t row = 0; row < 3; ++row) {
        double most = 0;
        for (const Piece& piece : unfiltered) most += std::fabs(row_sum(piece.film, row));
        const double white = row_sum(sum, row);
        if (!(white > 0.02 * most))
            throw InputError("illuminant: " + illuminant.text().substr(0, 60) + " has too little " +
                             std::array{"red", "green", "blue"}[row] + " for a white balance");
        for (Piece& piece : pieces)
            for (std::size_t column = 0; column < 3; ++column) piece.film[3 * row + column] /= white;
    }
}

/// Sets the sampling density of each piece. A sample that counts for one wavelength shows white in channel c as k_c /
/// p, and one that counts for three as their mean. The density is the one of the form p = sqrt(sum of a_c k_c^2) for
/// which the latter differs least from 1 under D65, by 0.28, 0.14 and 0.28; under A and FL2, by at most 0.5 and 0.4.
/// With single wavelengths, the difference is 1.8 to 2.2.
void set_density(std::vector<Piece>& pieces) {
    constexpr std::array<double, 3> kWeights = {0.7, 1, 0.7};
    double sum = 0;
    for (Piece& piece : pieces) {
        double squares = 0;
        for (std::size_t c = 0; c < 3; ++c) {
            const double k = row_sum(piece.film, c);
            squares += kWeights[c] * k * k;
        }
        piece.density = std::sqrt(squares);
        sum += piece.density;
    }
    if (!(sum > 0)) throw InputError("lens_filter: no light of the illuminant passes");
    for (Piece& piece : pieces) piece.density /= sum;
}

/// Divides the spectrum into `count` cells of equal probability. A cell that spans a gap between two lines spreads its
/// light over the gap.
std::vector<WavelengthCell> cells_of(const std::vector<Piece>& pieces, int count) {
    struct Edge {
        double wavelength;
        Matrix film;  ///< integral over all shorter wavelengths
    };
    Matrix film{};
    double passed = 0;
    std::size_t at = 0;
    const auto edge_at = [&](double share) -> Edge {
        // Skips pieces without light, too, in which no wavelength may be sampled.
        while (at + 1 < pieces.size() && (passed + pieces[at].density < share || !(pieces[at].density > 0))) {
            for (std::size_t k = 0; k < 9; ++k) film[k] += pieces[at].film[k];
            passed += pieces[at].density;
            ++at;
        }
        const Piece& piece = pieces[at];
        const double inside = std::clamp((share - passed) / piece.density, 0.0, 1.0);
        Edge edge{piece.first + inside * (piece.last - piece.first), film};
        for (std::size_t k = 0; k < 9; ++k) edge.film[k] += inside * piece.film[k];
        return edge;
    };
    std::size_t last = pieces.size() - 1;
    while (last > 0 && !(pieces[last].density > 0)) --last;
    const Edge end = {pieces[last].last, sum_of(pieces)};  // exact despite rounding
    std::vector<WavelengthCell> cells;
    Edge low = edge_at(0);
    for (int i = 1; i <= count; ++i) {
        const Edge high = i == count ? end : edge_at(static_cast<double>(i) / count);
        WavelengthCell cell{static_cast<float>(low.wavelength), static_cast<float>(high.wavelength), {}};
        for (std::size_t k = 0; k < 9; ++k) cell.film[k] = static_cast<float>(count * (high.film[k] - low.film[k]));
        cells.push_back(cell);
        low = high;
    }
    return cells;
}

}  // namespace

}  // namespace film_spectrum_detail

FilmSpectrum::FilmSpectrum(const Illuminant& illuminant, const std::optional<LensFilter>& filter) {
    using namespace film_spectrum_detail;
    if (illuminant.is_line()) {
        // After white balance all channels are equal: the spectrum of the scene colour at this wavelength.
        const double nm = illuminant.points()[0].wavelength_nm;
        const std::array<double, 3> basis = basis_at(nm);
        WavelengthCell cell{static_cast<float>(nm), static_cast<float>(nm), {}};
        const double passed = filter ? filter->transmittance(nm) : 1;
        if (!(passed > 0)) throw InputError("lens_filter: no light of the illuminant passes");
        for (std::size_t k = 0; k < 9; ++k) cell.film[k] = static_cast<float>(passed * basis[k % 3]);
        cells_ = {cell};
        return;
    }
    std::vector<Piece> pieces = pieces_of(illuminant, filter);
    balance(pieces, illuminant, filter.has_value());
    set_density(pieces);
    cells_ = cells_of(pieces, kCells);
}

FilmSpectrum::FilmSpectrum(WavelengthRange range)
    : cells_{{static_cast<float>(range.first), static_cast<float>(range.last), {1, 0, 0, 0, 1, 0, 0, 0, 1}}} {}

std::array<float, 9> FilmSpectrum::mean_film() const {
    std::array<float, 9> mean;
    for (std::size_t k = 0; k < mean.size(); ++k) {
        double sum = 0;
        for (const WavelengthCell& cell : cells_) sum += static_cast<double>(cell.film[k]);
        mean[k] = static_cast<float>(sum / static_cast<double>(cells_.size()));
    }
    return mean;
}

std::vector<double> FilmSpectrum::even_wavelengths() const {
    constexpr std::size_t kCount = 32;
    std::vector<double> wavelengths;
    for (std::size_t i = 0; i < kCount; ++i) {
        const double position = (static_cast<double>(i) + 0.5) / kCount * static_cast<double>(cells_.size());
        const WavelengthCell& cell = cells_[static_cast<std::size_t>(position)];
        // If there are many cells, each is narrow, and its centre is used.
        const double within = cells_.size() > kCount ? 0.5 : position - std::floor(position);
        wavelengths.push_back(std::lerp(static_cast<double>(cell.first_nm), static_cast<double>(cell.last_nm), within));
    }
    return wavelengths;
}

}  // namespace realcam
