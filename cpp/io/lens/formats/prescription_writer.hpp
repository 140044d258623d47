#pragma once
#include <initializer_list>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "../lens_format.hpp"

namespace realcam::io {

/// Base of the writers of other programs' lens files: warnings, and the quantities that all formats have.
class PrescriptionWriter {
protected:
    /// Adds warnings about properties that no format can express: coatings, blades of the iris, focusing. `format`:
    /// name of the program, such as "Zemax".
    PrescriptionWriter(const LensSystem& lens, const std::string& format);

    /// Adds a warning about a surface, whose number is followed by `what`.
    void warn(std::size_t surface, const std::string& what) {
        result_.warnings.push_back("surface " + std::to_string(surface + 1) + ' ' + what);
    }

    /// Title of the lens, or else its name.
    std::string title() const;
    /// Half of the film's diagonal, mm.
    double film_corner() const;
    /// Distance from the object to the first vertex, mm.
    double object_distance() const { return lens_.focus_distance - lens_.film_position(); }
    /// Thickness behind a surface; behind the last one the film distance. In mm.
    double thickness(std::size_t surface) const;
    /// Curvature of the image surface, 1/mm. realcam measures the sag of the film along the light, and other programs
    /// along the axis.
    double image_curvature() const { return (lens_.film_distance < 0 ? -1 : 1) / lens_.film_radius_of_curvature; }
    /// Entrance pupil diameter in mm, as if the lens were centred, because other programs compute the stop's size in
    /// this way. Throws InputError if it is infinite; `suffix`: of the file, for the message.
    double entrance_pupil_diameter(const std::string& suffix) const;
    /// Medium behind a surface, which for a stop, a mirror or an aperture is that of the last refracting surface.
    const Glass& medium_behind(std::size_t surface) const;

    /// Quantity that zooming changes, with its values in all zoom positions.
    struct ZoomedQuantity {
        static constexpr int kObject = 0, kEntrancePupil = -1;
        /// Number, from 1, of the surface whose thickness changes; or kObject for the object distance, kEntrancePupil
        /// for the entrance pupil diameter.
        int surface;
        std::vector<double> values;  ///< mm
    };
    /// Returns the quantities that zooming changes. The current position has the focus of the lens; the other positions
    /// are focused at the distance for which the lens file specifies them.
    std::vector<ZoomedQuantity> zoomed_quantities() const;

    const LensSystem& lens_;
    LensText result_;  ///< text and warnings so far
};

/// Returns the coefficients of the sag by power of r: even terms, radial terms, and Forbes terms on a conic (Qcon).
/// Forbes terms on a sphere (Qbfs) are not polynomials, and are omitted.
std::map<int, double> radial_terms_of(const Surface& surface);

/// Returns the coefficients of r^step, r^(2 step), ... as a list; other powers are omitted.
std::vector<double> radial_list(const std::map<int, double>& terms, int step);

/// Powers of a term x^(degree - power_of_y) y^power_of_y: (degree, power_of_y).
using XyPower = std::pair<int, int>;

/// Returns the coefficients of the sag by powers of x and y: all terms except those of a toroid, odd powers of r, and
/// Forbes terms on a sphere (Qbfs).
std::map<XyPower, double> xy_terms_of(const Surface& surface);

/// Returns the number of a term in the sequence x, y, x^2, x y, y^2, ..., which begins at 1.
inline int xy_number(int degree, int power_of_y) {
    return degree * (degree + 1) / 2 + power_of_y;
}

/// True if a surface has a term of an odd power of r.
bool has_odd_terms(const Surface& surface);

/// Names the terms of a form that are omitted because they are not polynomials, such as Forbes terms on a sphere; empty
/// if there are none.
std::string beyond_polynomials(const SurfaceForm& form);

/// Returns the refractive indices of a glass at nine spectral lines from i to s and at a lens's design wavelength,
/// sorted by wavelength.
std::vector<Glass::TablePoint> indices_at_lines(const Glass& glass, double wavelength_nm);

}  // namespace realcam::io
