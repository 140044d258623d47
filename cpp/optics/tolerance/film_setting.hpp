#pragma once
#include "field_spot.hpp"

namespace REALCAM_NAMESPACE {

/// Where the film stands at a point of the picture: shift + slope . point, mm behind where it was drawn.
struct FilmSetting {
    double shift = 0;
    Vec2<double> slope{0, 0};

    double at(Vec2<double> point) const { return shift + slope.x * point.x + slope.y * point.y; }
};

/// How the film may be set.
struct FilmFreedom {
    bool moves, tilts;
};

/// With the least sum of the spots' mean square radii.
FilmSetting film_of_small_spots(const std::vector<FieldSpot>& spots, FilmFreedom freedom);

/// The mean of the mean square radii, mm^2. NaN where a field has no light.
double mean_square(const std::vector<FieldSpot>& spots, const FilmSetting& film);

/// With the largest mean contrast at a frequency, of lines across `outwards` and along it, of each field. It is looked
/// for around the film of the smallest spots, as far as a perfect lens loses its contrast three times over.
FilmSetting film_of_high_contrast(const std::vector<FieldSpot>& spots, const std::vector<Vec2<double>>& outwards,
                                  double frequency, FilmFreedom freedom);

/// That mean. NaN where a field has no light.
double mean_contrast(const std::vector<FieldSpot>& spots, const std::vector<Vec2<double>>& outwards, double frequency,
                     const FilmSetting& film);

}  // namespace REALCAM_NAMESPACE
