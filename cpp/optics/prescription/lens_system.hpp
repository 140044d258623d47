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

/// One position of the zoom ring, with the lens at rest: wide open, and with the focus that the prescription specifies
/// for this position. Lengths in mm.
struct ZoomPosition {
    std::string name;  ///< unique among the positions, for example "wide"
    std::vector<double> thicknesses;  ///< thicknesses behind ZoomRange::surfaces, in their order
    double film_distance = 0;  ///< last vertex to film
    double focus_distance = std::numeric_limits<double>::infinity();  ///< object plane to film
    double stop_semi_diameter = 0;  ///< clear semi-diameter of the aperture stop; 0: zooming does not change it

    bool operator==(const ZoomPosition&) const = default;
};

/// Thicknesses that the zoom ring changes. `positions` is empty for a lens of fixed focal length.
struct ZoomRange {
    std::vector<int> surfaces;  ///< indices from 0, ascending, of the surfaces behind which the thickness changes by
                                ///< zooming, or by moving the focusing group
    std::vector<ZoomPosition> positions;
    int current = 0;  ///< index of the lens's current position

    bool operator==(const ZoomRange&) const = default;
};

/// Shape of the blades of an iris diaphragm, independent of its opening.
struct IrisShape {
    int blades = 0;  ///< number of blades; 0: a round diaphragm
    double rounding = 0;  ///< curvature of the edges times the apothem. 0: straight edges; 1: the opening is a circle
    double rotation_rad = 0;  ///< angle of the first blade, from the x axis towards y

    bool operator==(const IrisShape&) const = default;
};

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr int kMaxSurfaces = 256;

// Limits of a prescription's numbers. No real lens exceeds them, and squares of larger numbers, or of their sums, leave
// the range of float32.
inline constexpr double kLongest = 1e9;  ///< largest absolute value of any length, mm
inline constexpr double kShortestRadius = 1e-6;  ///< smallest radius of curvature or clear semi-diameter, mm
inline constexpr double kLargestConic = 1e6;  ///< largest absolute value of a conic constant
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
    std::string name;  ///< identifier in messages and lists
    std::string title;  ///< full name for display; may be empty
    std::string source;  ///< publication or patent of the design; may be empty
    std::vector<Surface> surfaces;  ///< from the front (scene side) to the film
    double wavelength_nm = kLineD_nm;  ///< design wavelength: the default of calculations
    double film_width = 36, film_height = 24;
    double film_distance = 0;  ///< last vertex to film
    double film_radius_of_curvature = kInfinity;  ///< positive if the centre lies behind the film; infinite: flat
    SurfacePlacement film_placement;  ///< relative to the last axis, at film_distance behind the last vertex
    double focus_distance = kInfinity;  ///< object plane in focus to film
    double stop_semi_diameter = 0;  ///< setting of the diaphragm: radius of the circle with the area of its opening
    IrisShape iris;
    FocusingRule focusing;
    ZoomRange zoom;
    /// True: faces may overlap inside their rims. For experiments, as such a lens cannot be made.
    bool allow_overlap = false;

    bool operator==(const LensSystem&) const = default;

    /// Index of the aperture stop in `surfaces`; -1 if there is none.
    int stop_index() const;
    /// The aperture stop, which must exist.
    const Surface& stop() const { return surfaces[static_cast<std::size_t>(stop_index())]; }
    /// True if the diaphragm is fully open.
    bool is_wide_open() const { return stop_semi_diameter >= stop().clear_semi_diameter; }
    /// Radius of the stop's opening, limited by its rim, mm.
    double open_stop_radius() const { return std::min(stop_semi_diameter, stop().clear_semi_diameter); }

    /// Returns the reason why this lens is not rotationally symmetric, naming the first surface that breaks the
    /// symmetry, for example "surface 3 is tilted"; empty if it is.
    std::string asymmetry() const;
    /// True if this lens is rotationally symmetric.
    bool is_rotational() const { return asymmetry().empty(); }
    /// Throws InputError unless this lens is rotationally symmetric: "`what` needs a rotationally symmetric lens;
    /// surface 3 is tilted".
    void require_rotational(const std::string& what) const;

    /// z of each vertex along the axis, mm; tilts and decentres are ignored.
    std::vector<double> vertices() const;
    /// z of the last vertex, mm.
    double last_vertex() const;
    /// z of the film's vertex, mm.
    double film_position() const { return last_vertex() + film_distance; }

    /// Returns the refractive indices of the n + 1 media (before the first surface, between the surfaces, behind the
    /// last) at a wavelength in nm. Throws InputError if a glass has no valid index at this wavelength: near a
    /// resonance a formula can give any value.
    std::vector<double> indices(double wavelength_nm) const;
};

/// Returns the rotationally symmetric lens with the yz section of each surface: no tilts or decentres of surfaces or
/// film, and no asymmetric form terms or apertures. It serves for numbers that characterise the lens.
LensSystem centred(LensSystem lens);

/// Returns the lens at rest in the zoom position of this index (from 0): wide open, and focused as the position
/// specifies.
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

/// Returns the frames of all surfaces, including tilts and decentres.
SurfaceFrames surface_frames(const LensSystem& lens);

/// Returns the transform from the frame of surface `index` + 1 to that of surface `index`. It is exactly a translation
/// by the thickness if neither surface is tilted or decentred.
Affine<double> frame_of_next(const LensSystem& lens, int index);

}  // namespace REALCAM_NAMESPACE
