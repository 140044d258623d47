#pragma once
#include <algorithm>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "../../error.hpp"
#include "iris_shape.hpp"
#include "surface.hpp"
#include "zoom_range.hpp"

namespace REALCAM_NAMESPACE {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr int kMaxSurfaces = 256;

// Numbers beyond these are no lens's, and their squares, or those of their sums, leave the range of float32.
inline constexpr double kLongest = 1e9;         ///< any length, mm
inline constexpr double kShortestRadius = 1e-6;  ///< of curvature, and clear semi-diameter, mm
inline constexpr double kLargestConic = 1e6;
/// The largest coefficient of an asphere, whatever its unit. Float32 rays need no such limit, but some pictures through
/// lenses past it are NaN.
inline constexpr double kLargestCoefficient = 1e37;

/// How the focusing ring moves the glass.
struct FocusingRule {
    double nearest_mm = 0;  ///< nearest object plane, measured to the film; 0: as near as the optics can
    int group_first = -1;  ///< first and last surface (from 0) of the moving group; -1: the whole lens moves
    int group_last = -1;

    bool moves_group() const { return group_first >= 0; }
    bool operator==(const FocusingRule&) const = default;
};

/// A lens in one state of its rings: a value. Owns its data; LensPath makes the views that kernels use.
/// Lens frame: z along the axis, origin at the front vertex, light from the scene travels to +z. Lengths in mm.
struct LensSystem {
    std::string name;
    std::string title;
    std::string source;
    std::vector<Surface> surfaces;
    double wavelength_nm = kLineD_nm;  ///< design wavelength, used where none is given
    double film_width = 36, film_height = 24;
    double film_distance = 0;  ///< last vertex to film
    double film_radius_of_curvature = kInfinity;  ///< mm; above 0: the centre lies behind the film
    SurfacePlacement film_placement;  ///< as seen from the last axis, film_distance behind the last vertex
    double focus_distance = kInfinity;  ///< object plane to film
    double stop_semi_diameter = 0;  ///< radius of the circle that has the diaphragm's open area
    IrisShape iris;
    FocusingRule focusing;
    ZoomRange zoom;
    bool allow_crossing =
        false;  ///< faces may cross inside their rims: for experiments, as nobody can make such a lens

    bool operator==(const LensSystem&) const = default;

    int stop_index() const;
    const Surface& stop() const { return surfaces[static_cast<std::size_t>(stop_index())]; }
    bool is_wide_open() const { return stop_semi_diameter >= stop().clear_semi_diameter; }
    /// The radius of the stop's opening, which its rim limits, mm.
    double open_stop_radius() const { return std::min(stop_semi_diameter, stop().clear_semi_diameter); }

    /// Why this is no centred lens of revolution, by the first surface that makes it another: "surface 3 is tilted".
    /// Empty: it is one.
    std::string asymmetry() const;
    bool is_rotational() const { return asymmetry().empty(); }
    /// For what only a centred lens of revolution has. Throws InputError for others: "`what` needs a centred lens of
    /// revolution; surface 3 is tilted".
    void require_rotational(const std::string& what) const;

    /// z of each vertex, along the axis: of lenses that are not centred, as if their surfaces were not moved.
    std::vector<double> vertices() const;
    double last_vertex() const;
    double film_position() const { return last_vertex() + film_distance; }

    /// Refractive index of the n + 1 media: before the first surface, between the surfaces, behind the last.
    /// Throws InputError at a wavelength where a glass has none: a formula near its resonances gives anything.
    std::vector<double> indices(double wavelength) const;
};

/// The lens with all its surfaces, and the film, in place on one axis, and each of revolution, as in the yz plane: for
/// numbers that say what kind of lens it is.
LensSystem centred(LensSystem lens);

/// The lens at rest in a zoom position that it has: wide open, and focused as the position says.
LensSystem at_zoom_position(LensSystem lens, int position);

}  // namespace REALCAM_NAMESPACE
