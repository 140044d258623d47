#pragma once
#include <optional>
#include <vector>

#include "../../math/vec3.hpp"
#include "../prescription/lens_system.hpp"

namespace REALCAM_NAMESPACE {

/// Wavelength with its weight in polychromatic results.
struct StudyColour {
    double wavelength_nm, weight;
};

/// Compensator: surfaces that are moved together to maximise sharpness.
struct ElementShift {
    int first, last;  ///< indices of the first and last surface, from 0
    bool along_axis;  ///< true: they are moved along the axis; false: along x and y
    double range;  ///< largest displacement to either side, mm
};

/// Compensators: adjustments of an assembled lens that maximise sharpness in the mean of all fields.
struct Compensators {
    /// Frequency at which the contrast is maximised, periods per mm; empty: the mean square spot radius is minimised
    /// instead.
    std::optional<double> frequency = std::nullopt;
    bool refocus = false;  ///< true: the film is moved along the axis
    bool film_tilt = false;  ///< true: the film is tilted about x and y
    std::optional<ElementShift> shift = std::nullopt;
};

/// Evaluation to be done for each copy of a lens.
struct StudyRequest {
    std::vector<Vec2<double>> fields;  ///< vectors away from the axis, whose length is the field angle, rad
    std::optional<double> object_distance;  ///< see FieldPoint
    std::vector<StudyColour> colours;
    std::vector<double> frequencies;  ///< periods per mm
    int rings = 6;  ///< rings of rays in the stop (gauss_rings)
    Compensators compensators;
};

/// Settings of the compensators of a lens copy.
struct CopySettings {
    double film_shift = 0;  ///< mm, away from the lens
    Vec2<double> film_slope{0, 0};  ///< dz/dx and dz/dy of the film
    Vec3d element_shift{0, 0, 0};  ///< displacement of Compensators::shift, mm

    bool operator==(const CopySettings&) const = default;
};

/// Returns the lens with its compensators at these settings.
LensSystem with_settings(const LensSystem& lens, const CopySettings& settings, const Compensators& compensators);

}  // namespace REALCAM_NAMESPACE
