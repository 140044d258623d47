#pragma once
#include <algorithm>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "../../error.hpp"
#include "../../platform.hpp"
#include "surface.hpp"

namespace REALCAM_NAMESPACE {

/// One position of the zoom ring, with the lens at rest: wide open, and not refocused. Lengths in mm.
struct ZoomPosition {
    std::string name;
    std::vector<double> thicknesses;  ///< thicknesses behind ZoomRange::surfaces, in their order
    double film_distance = 0;  ///< last vertex to film
    double focus_distance = std::numeric_limits<double>::infinity();  ///< object plane to film
    double stop_semi_diameter = 0;  ///< clear semi-diameter of the aperture stop; 0: zooming does not change it

    bool operator==(const ZoomPosition&) const = default;
};

/// Thicknesses that the zoom ring changes. `positions` is empty for a lens of fixed focal length.
struct ZoomRange {
    std::vector<int> surfaces;  ///< surfaces whose thicknesses change, also by focusing; from 0, ascending
    std::vector<ZoomPosition> positions;
    int current = 0;  ///< index of the lens's current position

    bool operator==(const ZoomRange&) const = default;
};

/// Blades of an iris diaphragm, independent of its opening. blades = 0: a round diaphragm.
struct IrisShape {
    int blades = 0;
    double rounding = 0;      ///< 0: straight edges; 1: the opening is a circle
    double rotation_rad = 0;  ///< angle of the first blade, from the x axis towards y

    bool operator==(const IrisShape&) const = default;
};

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr int kMaxSurfaces = 256;

// Limits of a prescription's numbers. No real lens exceeds them, and squares of larger numbers, or of their sums, leave
// the range of float32.
inline constexpr double kLongest = 1e9;  ///< any length, mm
inline constexpr double kShortestRadius = 1e-6;  ///< radius of curvature or clear semi-diameter, mm
inline constexpr double kLargestConic = 1e6;
/// Largest coefficient of an asphere, whatever its unit. Float32 rays need no such limit, but some pictures through
/// lenses past it are NaN.
inline constexpr double kLargestCoefficient = 1e37;

/// Focusing mechanism: which surfaces move, and the nearest focus.
struct FocusingRule {
    double nearest_mm = 0;  ///< nearest object plane, measured to the film; 0: the nearest that the optics can image
    int group_first = -1;  ///< first and last surface (from 0) of the moving group; -1: the whole lens moves
    int group_last = -1;

    bool moves_group() const { return group_first >= 0; }
    bool operator==(const FocusingRule&) const = default;
};

/// Lens prescription at one setting of its zoom, focus and aperture rings: a value type that owns its data. LensPath
/// derives the views that kernels use.
///
/// Lens frame: z along the axis, origin at the front vertex, light from the scene travels to +z. Lengths in mm.
struct LensSystem {
    std::string name;
    std::string title;
    std::string source;
    std::vector<Surface> surfaces;
    double wavelength_nm = kLineD_nm;  ///< design wavelength: the default of calculations
    double film_width = 36, film_height = 24;
    double film_distance = 0;  ///< last vertex to film
    double film_radius_of_curvature = kInfinity;  ///< mm; above 0: the centre lies behind the film
    SurfacePlacement film_placement;  ///< relative to the last axis, at film_distance behind the last vertex
    double focus_distance = kInfinity;  ///< object plane to film
    double stop_semi_diameter = 0;  ///< radius of the circle with the diaphragm's open area
    IrisShape iris;
    FocusingRule focusing;
    ZoomRange zoom;
    bool allow_overlap =
        false;  ///< faces may overlap inside their rims: for experiments, as such a lens cannot be made

    bool operator==(const LensSystem&) const = default;

    int stop_index() const;
    const Surface& stop() const { return surfaces[static_cast<std::size_t>(stop_index())]; }
    bool is_wide_open() const { return stop_semi_diameter >= stop().clear_semi_diameter; }
    /// Radius of the stop's opening, limited by its rim, mm.
    double open_stop_radius() const { return std::min(stop_semi_diameter, stop().clear_semi_diameter); }

    /// Reason why this is not a centred lens of revolution, naming the first surface at fault: "surface 3 is tilted";
    /// empty if it is one.
    std::string asymmetry() const;
    bool is_rotational() const { return asymmetry().empty(); }
    /// Throws InputError unless this is a centred lens of revolution: "`what` needs a centred lens of revolution;
    /// surface 3 is tilted".
    void require_rotational(const std::string& what) const;

    /// z of each vertex along the axis; tilts and decentres are ignored.
    std::vector<double> vertices() const;
    double last_vertex() const;
    double film_position() const { return last_vertex() + film_distance; }

    /// Refractive indices of the n + 1 media: before the first surface, between the surfaces, behind the last. Throws
    /// InputError if a glass has no valid index at this wavelength: near a resonance a formula can give any value.
    std::vector<double> indices(double wavelength) const;
};

/// Returns the centred lens of revolution with the yz section of each surface: no tilts or decentres of surfaces or
/// film, and no asymmetric form terms or apertures. It serves for numbers that characterise the lens.
LensSystem centred(LensSystem lens);

/// Returns the lens at rest in the zoom position of this index: wide open, and focused as the position specifies.
LensSystem at_zoom_position(LensSystem lens, int position);

/// True if all surfaces are surfaces of revolution about one common axis. The film's placement is ignored.
inline bool has_axis(const LensSystem& lens) {
    return std::ranges::all_of(lens.surfaces, [](const Surface& s) { return s.asymmetry().empty(); });
}

/// Frames of a lens's surfaces: transforms from the surface's own frame (origin at its vertex) to the lens frame, whose
/// origin is the front vertex before the front surface's own placement.
struct SurfaceFrames {
    std::vector<Affine<double>> surfaces;
    Affine<double> last_axis;  ///< axis behind the last surface, with origin at its vertex; the film is placed along it
};

SurfaceFrames surface_frames(const LensSystem& lens);

/// Transform from the frame of surface `index` + 1 to that of surface `index`. Exactly a translation by the thickness
/// if neither surface is moved.
Affine<double> frame_of_next(const LensSystem& lens, int index);

}  // namespace REALCAM_NAMESPACE
