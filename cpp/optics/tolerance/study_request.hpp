#pragma once
#include <optional>
#include <vector>

#include "../../math/vec3.hpp"
#include "../prescription/lens_system.hpp"

namespace REALCAM_NAMESPACE {

/// A wavelength and its share of the light.
struct StudyColour {
    double wavelength_nm, weight;
};

/// Surfaces, from 0, that are moved together until the picture is sharpest: along the axis, or across it.
struct ElementShift {
    int first, last;
    bool along_axis;
    double range;  ///< to either side, mm
};

/// What may be set on a finished lens, so that the picture becomes sharpest in the mean of all fields.
struct Compensators {
    /// At which contrast is made highest, periods per mm; none: spots are made small, in mean square.
    std::optional<double> frequency = std::nullopt;
    bool refocus = false;    ///< the film moves along the axis
    bool film_tilt = false;  ///< it is turned about x and y
    std::optional<ElementShift> shift = std::nullopt;
};

/// What is asked about each copy of a lens.
struct StudyRequest {
    std::vector<Vec2<double>> fields;  ///< field angles towards x and y, rad: of an angle of their length
    std::optional<double> object_distance;  ///< as in FieldPoint
    std::vector<StudyColour> colours;
    std::vector<double> frequencies;  ///< periods per mm
    int rings = 6;  ///< of rays in the stop (gauss_rings)
    Compensators compensators;
};

/// What compensators were set to.
struct CopySettings {
    double film_shift = 0;    ///< mm, away from the lens
    Vec2<double> film_slope{0, 0};  ///< of the film along x and y
    Vec3d element_shift{0, 0, 0};      ///< mm

    bool operator==(const CopySettings&) const = default;
};

/// The lens with the settings made.
LensSystem with_settings(const LensSystem& lens, const CopySettings& settings, const Compensators& compensators);

}  // namespace REALCAM_NAMESPACE
