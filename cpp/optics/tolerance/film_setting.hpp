#pragma once
#include <cmath>

#include "field_fan.hpp"
#include "study_request.hpp"

namespace REALCAM_NAMESPACE {

/// Rays of one field of a lens copy, of all wavelengths, behind the lens.
struct FieldSpot {
    std::vector<FieldFan::FilmRay> rays;  ///< weights add up to 1; empty if no ray passes
    double light;  ///< fraction of the rays that pass, by weight
    FieldFan::FilmRay chief;  ///< chief ray of the main wavelength
    double film;  ///< film position before compensation, mm behind the last vertex
    double index;  ///< refractive index behind the lens

    /// Mean square spot radius about the centroid, mm^2, as a function of the film position: a + 2 b z + c z^2 on the
    /// plane z mm behind `film`.
    struct MeanSquare {
        double a, b, c;
    };
    /// Computes the mean square spot radius.
    MeanSquare mean_square_radius() const;
    /// Returns the radius of the uniform disc of slopes that has the variance of the rays' slopes.
    double half_slope() const { return std::sqrt(2 * mean_square_radius().c); }
    /// Returns the intersection of the chief ray with the plane `shift` mm behind `film`, mm.
    Vec2<double> chief_at(double shift) const;
    /// Returns the geometric MTF at `frequency`, periods per mm, on the plane `shift` mm behind `film`. `along`: unit
    /// vector in the direction in which the pattern of lines varies.
    double contrast(double shift, Vec2<double> along, double frequency) const;
    /// Adds the contrast on sum.size() planes to `sum`. The first plane lies `shift` mm behind `film`, and each next
    /// one `step` mm behind the previous one.
    void add_contrast(double shift, double step, Vec2<double> along, double frequency, std::vector<double>& sum) const;
    /// Returns the diffraction-limited MTF, averaged over the wavelengths: that of a lens without aberrations whose
    /// elliptic pupil is as wide as the rays' directions.
    double diffraction_limit(Vec2<double> along, double frequency, const std::vector<StudyColour>& colours) const;
};

/// Film plane after compensation: at a film point (mm), it lies shift + slope . point, in mm, behind its position
/// before.
struct FilmAdjustment {
    double shift = 0;
    Vec2<double> slope{0, 0};

    /// Returns the displacement of the film at a point, mm.
    double at(Vec2<double> point) const { return shift + slope.x * point.x + slope.y * point.y; }
};

/// Adjustable degrees of freedom of the film.
struct FilmFreedom {
    bool moves;  ///< along the axis
    bool tilts;  ///< about x and y
};

/// Returns the film plane with the smallest sum of the spots' mean square radii.
FilmAdjustment film_for_small_spots(const std::vector<FieldSpot>& spots, FilmFreedom freedom);

/// Returns the mean of the fields' mean square spot radii, mm^2; NaN if no light of a field passes.
double mean_square(const std::vector<FieldSpot>& spots, const FilmAdjustment& film);

/// Returns the film plane with the largest mean contrast at `frequency`, periods per mm. The mean is over all fields
/// and over patterns that vary along and across each field's direction. `outwards`: for each field, the unit vector
/// away from the axis. The search extends to three times the defocus at which a perfect lens loses its contrast, to
/// either side of film_for_small_spots.
FilmAdjustment film_for_high_contrast(const std::vector<FieldSpot>& spots, const std::vector<Vec2<double>>& outwards,
                                      double frequency, FilmFreedom freedom);

/// Returns the mean contrast, as film_for_high_contrast maximises it; NaN if no light of a field passes.
double mean_contrast(const std::vector<FieldSpot>& spots, const std::vector<Vec2<double>>& outwards, double frequency,
                     const FilmAdjustment& film);

}  // namespace REALCAM_NAMESPACE
