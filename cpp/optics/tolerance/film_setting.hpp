#pragma once
#include "field_spot.hpp"

namespace REALCAM_NAMESPACE {

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
