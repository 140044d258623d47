#pragma once
#include <cstdint>

#include "../optics/ghost_media.hpp"
#include "../optics/lens_view.hpp"

namespace REALCAM_NAMESPACE {

/// In how many steps of the tangent of half its angle to the axis light is looked at that becomes ghosts.
inline constexpr int kGhostAngles = 64;

/// Where light of one direction has to enter to reach the film by one ghost's way: a rectangle in the plane across the
/// light through the front vertex, mm. `low`, `high`: away from the axis; across it, from -half_width to half_width.
struct GhostEntry {
    float low, high, half_width;  ///< half_width 0: nowhere
};

/// The way of one ghost through the lens.
struct GhostWay {
    std::int32_t first, count;  ///< of its crossings in the arrays of GhostView
    float probability;          ///< with which a sample takes it
};

/// The ghosts of a lens, for light on its way to the film; or the lens's own way, for starbursts. Lengths in mm.
struct GhostView {
    const GhostWay* ways;
    int way_count;
    const float* cdf;  ///< of the ways' probabilities, way_count + 1
    const GhostEntry* entries;  ///< kGhostAngles of each way
    int crossing_count;
    const SurfaceView<float>* surfaces;  ///< of all crossings of all ways, as the next three
    const GhostCoating<kOneWavelengthTerms>* coatings;
    const IndexCubic* indices;  ///< where samples have wavelengths, as the next; else null
    const GhostCoating<kSpectrumTerms>* spectral_coatings;  ///< null: surfaces pass on all light
    float largest_half_tangent;  ///< of the angle between axis and light from which any ghost comes
    float reach;  ///< radius of a circle that holds all places where light enters, mm
    Iris<float> iris;
    LensKind kind;
    bool diffracts;  ///< the light is spread as the camera's DiffractionView says
};

/// A ghost view with every array replaced by a copy elsewhere: `copy(pointer, count)` returns where to.
template <class Copy>
GhostView with_copied_arrays(GhostView view, Copy&& copy) {
    const auto move = [&](auto*& array, int count) {
        if (array) array = copy(array, static_cast<std::size_t>(count));
    };
    move(view.ways, view.way_count);
    move(view.cdf, view.way_count + 1);
    move(view.entries, view.way_count * kGhostAngles);
    move(view.surfaces, view.crossing_count);
    move(view.coatings, view.crossing_count);
    move(view.indices, view.crossing_count);
    move(view.spectral_coatings, view.crossing_count);
    return view;
}

}  // namespace REALCAM_NAMESPACE
