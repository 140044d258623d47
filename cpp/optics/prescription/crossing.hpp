#pragma once
#include <cstddef>
#include <vector>

#include "lens_system.hpp"

namespace REALCAM_NAMESPACE {

/// A meeting of light with a surface.
struct Crossing {
    int surface;        ///< from 0 at the front
    bool in_order;      ///< the light comes from the medium in front of the surface, in the lens's order
    bool is_reflected;  ///< by a surface that otherwise lets light pass: a ghost's

    // Indices of refraction; `indices`: those of LensSystem::indices.
    /// Index of the medium from which the light comes.
    double index_before(const std::vector<double>& indices) const { return index(indices, in_order); }
    /// Index of the medium on the other side of the surface.
    double index_beyond(const std::vector<double>& indices) const { return index(indices, !in_order); }
    /// Index of the medium into which the light goes.
    double index_behind(const std::vector<double>& indices) const {
        return is_reflected ? index_before(indices) : index_beyond(indices);
    }

private:
    double index(const std::vector<double>& indices, bool in_front) const {
        return indices[static_cast<std::size_t>(in_front ? surface : surface + 1)];
    }
};

/// Two refracting surfaces, from 0 at the front, that reflect light on its way to the film: first the one nearer to the
/// film. The film itself, which reflects first, has the number behind the last surface's.
struct GhostPair {
    int first, second;

    bool operator==(const GhostPair&) const = default;
};

/// Whether the number of a GhostPair is the film's.
inline bool is_film(const LensSystem& lens, int surface) {
    return surface == static_cast<int>(lens.surfaces.size());
}

/// The crossings of light on its way to the film, which every surface transmits or, as a mirror, reflects.
std::vector<Crossing> crossings_of(const LensSystem& lens);

/// The crossings of light on its way to the film that the two surfaces reflect. The film is a mirror
/// (with_film_mirror).
std::vector<Crossing> crossings_of(const LensSystem& lens, GhostPair pair);

/// The crossings of light that goes the same way back.
std::vector<Crossing> reversed(std::vector<Crossing> way);

/// All pairs whose first surface has one of these numbers and refracts, or is the film.
std::vector<GhostPair> ghost_pairs(const LensSystem& lens, int first_begin, int first_end);

/// All pairs of refracting surfaces.
inline std::vector<GhostPair> ghost_pairs(const LensSystem& lens) {
    return ghost_pairs(lens, 1, static_cast<int>(lens.surfaces.size()));
}

/// All pairs of the film and a refracting surface.
std::vector<GhostPair> film_ghost_pairs(const LensSystem& lens);

}  // namespace REALCAM_NAMESPACE
