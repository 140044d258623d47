#pragma once
#include <cstdint>

#include "../../../optics/ghost/ghost_media.hpp"
#include "../../../optics/trace/lens_view.hpp"
#include "../../../platform.hpp"
#include "../effects.hpp"

namespace REALCAM_NAMESPACE {

// Data of a lens's ghosts for the render kernels. A ghost is an image by light that two surfaces reflect; its path
// through the lens is a list of surface crossings. The same structures hold the direct path of lights that are traced
// separately.

/// Selection of the ghosts of a picture.
struct GhostChoice {
    bool of_lens = true;  ///< ghosts of two lens surfaces
    double film_reflectance = 0;  ///< positive: ghosts of the film, with this reflectance, and a lens surface
    /// Ghosts with a smaller fraction of the lens's own light on the film, for a uniform surround, are left out.
    double least_share = 0;

    bool operator==(const GhostChoice&) const = default;
};

/// Number of bins: of the tangent of half the angle to the axis, for light that becomes ghosts; or of the film radius,
/// for film points that the light reaches.
inline constexpr int kGhostBins = 64;

/// Entrance-pupil bounds of one ghost's path for one direction of light: a rectangle in the plane perpendicular to the
/// light through the front vertex, mm. Also the bounds, in the plane of the last vertex, of light that reaches one film
/// point. Its x points away from the axis; for a lens without rotational symmetry, the axes are those of light_axes, or
/// of the plane z = 0 of the film's frame.
struct GhostBounds {
    float low, high;  ///< in x
    float half_width;  ///< half the size in y; 0: empty
    float across;  ///< y of the centre; 0 for a rotationally symmetric lens
};

/// Grid of directions or film points for lenses without rotational symmetry.
inline constexpr int kGhostColumns = 16, kGhostCells = kGhostColumns * kGhostColumns;

struct GhostGrid {
    Vec2f corner;  ///< least x and y
    Vec2f cells_per_unit;

    /// Index of the cell of a point; -1 outside the grid.
    REALCAM_INLINE int cell_of(Vec2f point) const {
        const float x = (point.x - corner.x) * cells_per_unit.x, y = (point.y - corner.y) * cells_per_unit.y;
        const float end = static_cast<float>(kGhostColumns);
        const bool inside = (x >= 0.0f) & (x < end) & (y >= 0.0f) & (y < end);
        const int column = static_cast<int>(select(inside, x, 0.0f)), row = static_cast<int>(select(inside, y, 0.0f));
        return select(inside, row * kGhostColumns + column, -1);
    }
};

/// Unit vectors perpendicular to light from a direction in front of the lens: the lens's x and y axes after the
/// shortest rotation that takes -z to that direction.
struct LightAxes {
    Vec3f x, y;
};

/// `from`: unit vector towards the light; not +z.
REALCAM_INLINE LightAxes light_axes(Vec3f from) {
    const float scale = 1.0f / (1.0f - from.z), both = -from.x * from.y * scale;
    return {{1.0f - from.x * from.x * scale, both, from.x}, {both, 1.0f - from.y * from.y * scale, from.y}};
}

/// Coordinates of a direction in the grid of directions; their length is the tangent of half its angle to the axis.
REALCAM_INLINE Vec2f half_tangents(Vec3f from) {
    const float scale = 1.0f / (1.0f - from.z);
    return {scale * from.x, scale * from.y};
}

/// Optical path of one ghost through the lens.
struct GhostLensPath {
    std::int32_t first, count;  ///< range of its crossings in the arrays of GhostView
    float probability;  ///< probability of being sampled
};

/// Light that is traced separately from the pixel samples, and the end that it is traced from.
enum class GhostLight : std::int32_t {
    of_lights,  ///< ghosts of the scene's lights, traced from the lights
    starbursts,  ///< the lights themselves, spread by the edges of the aperture; traced from the lights
    of_objects,  ///< ghosts of light that objects reflect, traced from the film
    direct,  ///< the lights themselves, traced from the lights (TracedLightsView)
};

/// Largest number of GhostViews of a picture.
inline constexpr int kMaxGhostViews = 4;

/// Ghosts of a lens; or its direct path, for starbursts and for the lights themselves. Lengths in mm.
struct GhostView {
    GhostLight light;
    Effects effects;  ///< effects that are simulated for it
    std::int32_t pixel_samples;  ///< number of pixel samples for each sample of this light
    const GhostLensPath* paths;
    int path_count;
    const float* cdf;  ///< cumulative probabilities of the paths: path_count + 1 elements from 0 to 1
    const GhostBounds* entries;  ///< kGhostBins for each path, or kGhostCells without rotational symmetry
    int crossing_count;  ///< number of crossings of all paths; each of the next four arrays has one element for each
    const SurfaceView<float>* surfaces;
    const GhostCoating<kOneWavelengthTerms>* coatings;  ///< null if samples have wavelengths or no light is lost
    const IndexCubic* indices;  ///< null if samples have no wavelengths
    const GhostCoating<kGhostSpectrumTerms>* spectral_coatings;  ///< null if samples have no wavelengths or no light is
                                                                 ///< lost
    float largest_half_tangent;  ///< largest tangent of half the angle to the axis of light that causes a ghost
    float film_radius;  ///< radius of a circle that contains the film
    float film_index;  ///< refractive index of the medium in front of the film
    float reach;  ///< radius of a circle that contains all points where samples enter the lens
    Iris<float> iris;
    LensKind kind;  ///< LensKind::any: `grid` replaces largest_half_tangent and film_radius
    GhostGrid grid;  ///< cells of half_tangents, or of film points in mm
    AsymmetricParts<float> free;  ///< data of lenses without rotational symmetry, by crossing
};

/// Returns the view with every array replaced by a copy; `copy(pointer, count)` returns the address of the copy.
template <class Copy>
GhostView with_copied_arrays(GhostView view, Copy&& copy) {
    const auto move = [&](auto*& array, int count) {
        if (array) array = copy(array, static_cast<std::size_t>(count));
    };
    move(view.paths, view.path_count);
    move(view.cdf, view.path_count + 1);
    move(view.entries, view.path_count * (view.kind == LensKind::any ? kGhostCells : kGhostBins));
    move(view.surfaces, view.crossing_count);
    move(view.coatings, view.crossing_count);
    view.free.move_arrays(view.crossing_count, move);
    move(view.indices, view.crossing_count);
    move(view.spectral_coatings, view.crossing_count);
    return view;
}

}  // namespace REALCAM_NAMESPACE
