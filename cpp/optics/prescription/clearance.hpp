#pragma once
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "lens_system.hpp"

namespace REALCAM_NAMESPACE {

// Optical paths through a lens as sequences of surfaces, and overlaps of its faces, which decide whether it can be
// made.

/// Ray-surface intersection on an optical path through the lens.
struct Crossing {
    int surface;  ///< index, from 0 at the front
    bool in_order;  ///< true: light arrives from the medium in front of the surface, as on the direct path to the film
    bool is_reflected;  ///< true: a surface that normally transmits reflects here, in a ghost path

    // The `indices` below are the result of LensSystem::indices.
    /// Refractive index of the medium from which the light comes.
    double index_before(const std::vector<double>& indices) const { return index(indices, in_order); }
    /// Refractive index of the medium on the other side of the surface.
    double index_beyond(const std::vector<double>& indices) const { return index(indices, !in_order); }
    /// Refractive index of the medium into which the light goes.
    double index_behind(const std::vector<double>& indices) const {
        return is_reflected ? index_before(indices) : index_beyond(indices);
    }

private:
    double index(const std::vector<double>& indices, bool in_front) const {
        return indices[static_cast<std::size_t>(in_front ? surface : surface + 1)];
    }
};

/// Two refracting surfaces, counted from 0 at the front, that reflect light on its path to the film; `first` is the one
/// nearer to the film and reflects first. The film itself, as `first`, has the index after the last surface's.
struct GhostPair {
    int first, second;

    bool operator==(const GhostPair&) const = default;
};

/// True if a surface index of a GhostPair denotes the film.
inline bool is_film(const LensSystem& lens, int surface) {
    return surface == static_cast<int>(lens.surfaces.size());
}

/// Returns the direct (ghost-free) path to the film: every surface transmits or, as a mirror, reflects.
std::vector<Crossing> crossings_of(const LensSystem& lens);

/// Returns the ghost path to the film by reflection at the two surfaces. If one is the film, its crossing is that of
/// the surface that with_film_mirror appends to the lens.
std::vector<Crossing> crossings_of(const LensSystem& lens, GhostPair pair);

/// Returns the path of light in the opposite direction.
std::vector<Crossing> reversed(std::vector<Crossing> crossings);

/// Returns all pairs whose first surface has an index in [first_begin, first_end), and refracts or is the film.
std::vector<GhostPair> ghost_pairs(const LensSystem& lens, int first_begin, int first_end);

/// Returns all pairs of refracting surfaces.
inline std::vector<GhostPair> ghost_pairs(const LensSystem& lens) {
    return ghost_pairs(lens, 1, static_cast<int>(lens.surfaces.size()));
}

/// Returns all pairs of the film and a refracting surface.
std::vector<GhostPair> film_ghost_pairs(const LensSystem& lens);

/// Overlap of two faces: light meets the second one in front of the first, so that the lens cannot be made.
struct FaceOverlap {
    int first, second;  ///< indices of the surfaces, from 0
    double radius;  ///< distance from the axis at which the overlap is deepest, mm
    double depth;  ///< length of the overlap there along the axis, mm
};

/// Returns the pairs of refracting or reflecting faces that overlap inside their clear apertures, whether or not they
/// are neighbours, in the order of the light, and at most `max_count` of them.
///
/// The two faces of an element must not overlap anywhere up to the larger of its two rims, because the smaller face is
/// edged flat unless it is concave. Stops and apertures are planes without thickness and may cross a face: a stop may
/// be specified at the vertex of one. Faces of revolution are compared only with those on the same axis, not across a
/// tilt or a decentre.
std::vector<FaceOverlap> find_overlaps(const LensSystem& lens,
                                       std::size_t max_count = std::numeric_limits<std::size_t>::max());

/// Returns the first overlap of find_overlaps; std::nullopt if no faces overlap.
std::optional<FaceOverlap> find_overlap(const LensSystem& lens);

/// True if the film of a centred lens cuts through the last face, up to the smaller of the face's rim and the film's
/// half diagonal. Always false for lenses without rotational symmetry.
bool film_crosses_lens(const LensSystem& lens);

}  // namespace REALCAM_NAMESPACE
