#pragma once
#include <cstdint>

#include "../optics/ghost/ghost_media.hpp"
#include "../optics/trace/lens_view.hpp"
#include "effects.hpp"

namespace REALCAM_NAMESPACE {

/// In how many steps of the tangent of half its angle to the axis light is looked at that becomes ghosts, or of the
/// film's radius places on the film to which it comes.
inline constexpr int kGhostBins = 64;

/// Where light of one direction has to enter to reach the film by one ghost's way: a rectangle in the plane across the
/// light through the front vertex, mm. `low`, `high`: away from the axis; across it, from -half_width to half_width.
/// Or, in the plane of the last vertex, where light leaves the lens that reaches one place of the film.
struct GhostEntry {
    float low, high, half_width;  ///< half_width 0: nowhere
};

/// The same for a lens that is not of revolution. Of light, in the axes that light_axes gives; of places on the film,
/// in the axes of the film, and the plane is that of its z = 0.
struct FreeGhostEntry : GhostEntry {
    float across;  ///< in y, the middle between -half_width and half_width; low and high are in x
};

/// For such a lens directions or places on the film are looked at on a grid.
inline constexpr int kGhostColumns = 16, kGhostCells = kGhostColumns * kGhostColumns;

struct GhostGrid {
    Vec2f corner;  ///< where x and y are least
    Vec2f cells_per_unit;

    /// The cell of a place; -1: beyond the grid.
    REALCAM_INLINE int cell_of(Vec2f place) const {
        const float x = (place.x - corner.x) * cells_per_unit.x, y = (place.y - corner.y) * cells_per_unit.y;
        const float end = static_cast<float>(kGhostColumns);
        const bool inside = (x >= 0.0f) & (x < end) & (y >= 0.0f) & (y < end);
        const int column = static_cast<int>(select(inside, x, 0.0f)), row = static_cast<int>(select(inside, y, 0.0f));
        return select(inside, row * kGhostColumns + column, -1);
    }
};

/// Unit vectors across light from a direction in front of the lens: x and y of the lens, after the shortest turn that
/// brings -z there.
struct LightAxes {
    Vec3f x, y;
};

/// `from`: unit, towards the light; not along +z.
REALCAM_INLINE LightAxes light_axes(Vec3f from) {
    const float scale = 1.0f / (1.0f - from.z), both = -from.x * from.y * scale;
    return {{1.0f - from.x * from.x * scale, both, from.x}, {both, 1.0f - from.y * from.y * scale, from.y}};
}

/// By which the grid of a lens's directions names one: the tangent of half its angle to the axis is the length.
REALCAM_INLINE Vec2f half_tangents(Vec3f from) {
    const float scale = 1.0f / (1.0f - from.z);
    return {scale * from.x, scale * from.y};
}

/// The way of one ghost through the lens.
struct GhostWay {
    std::int32_t first, count;  ///< of its crossings in the arrays of GhostView
    float probability;          ///< with which a sample takes it
};

/// Which light is traced apart from the samples of pixels, and from where.
enum class GhostLight : std::int32_t {
    of_lights,   ///< ghosts of the scene's lights, from these
    starbursts,  ///< the lights themselves, spread by the edges of the aperture, from the lights
    of_objects,  ///< ghosts of what objects reflect, from the film
    direct,      ///< the lights themselves, from the lights (TracedLightsView)
};

/// Of one picture.
inline constexpr int kMostSplats = 4;

/// The ghosts of a lens, or the lens's own way, for starbursts. Lengths in mm.
struct GhostView {
    GhostLight light;
    Effects effects;  ///< of that light
    std::int32_t pixel_samples;  ///< so many samples of pixels have one of these
    const GhostWay* ways;
    int way_count;
    const float* cdf;  ///< of the ways' probabilities, way_count + 1
    const GhostEntry* entries;  ///< kGhostBins of each way
    int crossing_count;
    const SurfaceView<float>* surfaces;  ///< of all crossings of all ways, as the next three
    const GhostCoating<kOneWavelengthTerms>* coatings;
    const IndexCubic* indices;  ///< where samples have wavelengths, as the next
    const GhostCoating<kGhostSpectrumTerms>* spectral_coatings;  ///< where surfaces do not pass on all light
    float largest_half_tangent;  ///< of the angle between axis and light from which any ghost comes
    float film_radius;           ///< of a circle that holds the film
    float film_index;            ///< of the medium before the film
    float reach;  ///< radius of a circle that holds all places where samples enter the lens
    Iris<float> iris;
    LensKind kind;  ///< any: the next three instead of `entries`, largest_half_tangent and film_radius
    const FreeGhostEntry* free_entries;  ///< kGhostCells of each way
    GhostGrid grid;  ///< of half_tangents, or of places on the film, mm
    FreeParts<float> free;  ///< of all crossings of all ways
};

/// A ghost view with every array replaced by a copy elsewhere: `copy(pointer, count)` returns where to.
template <class Copy>
GhostView with_copied_arrays(GhostView view, Copy&& copy) {
    const auto move = [&](auto*& array, int count) {
        if (array) array = copy(array, static_cast<std::size_t>(count));
    };
    move(view.ways, view.way_count);
    move(view.cdf, view.way_count + 1);
    move(view.entries, view.way_count * kGhostBins);
    move(view.surfaces, view.crossing_count);
    move(view.coatings, view.crossing_count);
    move(view.free_entries, view.way_count * kGhostCells);
    view.free.move_arrays(view.crossing_count, move);
    move(view.indices, view.crossing_count);
    move(view.spectral_coatings, view.crossing_count);
    return view;
}

}  // namespace REALCAM_NAMESPACE
