#pragma once
#include <cmath>

#include "field_fan.hpp"
#include "study_request.hpp"

namespace REALCAM_NAMESPACE {

/// Rays of one field of a copy, of all colours, behind the lens.
struct FieldSpot {
    std::vector<FieldFan::FilmRay> rays;  ///< weights add up to 1; empty if no ray passes
    double light;  ///< fraction of the rays that pass
    FieldFan::FilmRay chief;  ///< chief ray of the main colour
    double film;  ///< film position before compensation, mm behind the last vertex
    double index;  ///< refractive index behind the lens

    /// Mean square spot radius about the centroid as a function of the film position: a + 2 b z + c z^2, mm^2, z from
    /// `film`.
    struct Square {
        double a, b, c;
    };
    Square square() const;
    /// Radius, in slope, of the uniform disc with the variance of the ray slopes behind the lens.
    double half_slope() const { return std::sqrt(2 * square().c); }
    /// Intersection of the chief ray with the plane `shift` behind `film`, mm.
    Vec2<double> chief_at(double shift) const;
    /// Geometric MTF at this frequency, periods per mm, on the plane `shift` behind `film`. `along`: unit vector across
    /// the lines.
    double contrast(double shift, Vec2<double> along, double frequency) const;
    /// Adds the contrast on `sum.size()` planes: the first lies `shift` behind `film`, each other one `step` behind the
    /// previous one.
    void add_contrast(double shift, double step, Vec2<double> along, double frequency, std::vector<double>& sum) const;
    /// Diffraction-limited contrast: that of a lens without aberrations whose elliptic pupil is as wide as the light.
    double limit(Vec2<double> along, double frequency, const std::vector<StudyColour>& colours) const;
};

/// Film plane after compensation: at a film point, mm, it lies shift + slope . point, mm, behind its nominal position.
struct FilmSetting {
    double shift = 0;
    Vec2<double> slope{0, 0};

    double at(Vec2<double> point) const { return shift + slope.x * point.x + slope.y * point.y; }
};

/// Adjustable degrees of freedom of the film.
struct FilmFreedom {
    bool moves, tilts;
};

/// Returns the film plane with the smallest sum of the spots' mean square radii.
FilmSetting film_of_small_spots(const std::vector<FieldSpot>& spots, FilmFreedom freedom);

/// Mean of the fields' mean square spot radii, mm^2. NaN if a field has no light.
double mean_square(const std::vector<FieldSpot>& spots, const FilmSetting& film);

/// Returns the film plane with the largest mean contrast at `frequency`, periods per mm, over all fields, of lines
/// across and along each field's direction `outwards`. The search extends around film_of_small_spots to three times the
/// defocus at which a perfect lens loses its contrast.
FilmSetting film_of_high_contrast(const std::vector<FieldSpot>& spots, const std::vector<Vec2<double>>& outwards,
                                  double frequency, FilmFreedom freedom);

/// Mean contrast that film_of_high_contrast maximises. NaN if a field has no light.
double mean_contrast(const std::vector<FieldSpot>& spots, const std::vector<Vec2<double>>& outwards, double frequency,
                     const FilmSetting& film);

}  // namespace REALCAM_NAMESPACE
