#pragma once
#include <initializer_list>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "../lens_format.hpp"

namespace realcam::io {

/// Base of the writers of other programs' lens files: the quantities that all formats state.
class PrescriptionWriter {
protected:
    /// Warns of properties that the format lacks: coatings, blades of the iris, focusing.
    PrescriptionWriter(const LensSystem& lens, const std::string& format);

    void leave_out(std::size_t surface, const std::string& what) {
        result_.warnings.push_back("surface " + std::to_string(surface + 1) + ' ' + what);
    }

    std::string title() const;
    /// Half of the film's diagonal, mm.
    double corner() const;
    double object_distance() const { return lens_.focus_distance - lens_.film_position(); }
    double thickness(std::size_t surface) const;
    /// Curvature of the image surface. The sag of the film is measured along the light, and that of files along the
    /// axis.
    double image_curvature() const { return (lens_.film_distance < 0 ? -1 : 1) / lens_.film_radius_of_curvature; }
    /// Entrance pupil diameter as if the lens were centred, because readers size the stop in this way. `suffix`: for
    /// the error message if it is infinite.
    double entrance_pupil_diameter(const std::string& suffix) const;
    /// Medium behind a surface. A stop, a mirror or an aperture inside a glass has it on both sides.
    const Glass& medium_behind(std::size_t surface) const;

    /// Values of a quantity in all zoom positions.
    struct ZoomRow {
        static constexpr int kObject = 0, kEntrancePupil = -1;
        int surface;  ///< the one whose thickness changes, from 1; or one of the constants
        std::vector<double> values;
    };
    /// Returns the quantities that zooming changes. The current position has the lens unchanged; in the others it is
    /// focused at their rest distance.
    std::vector<ZoomRow> zoom_rows() const;

    const LensSystem& lens_;
    LensText result_;
};

/// Returns the coefficients of the powers of r: even terms, radial terms, and Forbes terms that depart from a conic.
/// Forbes's departures from a sphere are not polynomials, and are omitted.
std::map<int, double> radial_terms_of(const Surface& surface);

/// Returns the coefficients of r^step, r^(2 step), ... as a list.
std::vector<double> radial_list(const std::map<int, double>& terms, int step);

/// Degree, and the power of y in it.
using XyPower = std::pair<int, int>;

/// Returns the coefficients of powers of x and y: all terms except those of a toroid, odd powers of r, and Forbes's
/// departures from a sphere.
std::map<XyPower, double> xy_terms_of(const Surface& surface);

/// Returns the number of a term in the order x, y, x^2, x y, y^2, ..., from 1.
inline int xy_number(int degree, int power_of_y) {
    return degree * (degree + 1) / 2 + power_of_y;
}

/// True if a surface has a term of an odd power of r.
bool has_odd_terms(const Surface& surface);

/// Name of terms that are omitted because they are not a polynomial: "Forbes terms of a departure from a sphere"; empty
/// if there are none.
std::string beyond_polynomials(const SurfaceForm& form);

/// Returns the indices of a glass at spectral lines and at the wavelength of a lens, sorted.
std::vector<Glass::TablePoint> indices_at_lines(const Glass& glass, double wavelength_nm);

}  // namespace realcam::io
