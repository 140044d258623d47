#pragma once
#include <cmath>

#include "film_map.hpp"

namespace REALCAM_NAMESPACE {

// Sampling of the pupil on CPU and GPU. The pupil as seen from a film point is a region of directions. It is described
// in optical direction cosines (l, m): x and y of the unit vector times the refractive index n in front of the film.
// They are a measure of projected solid angle, n^2 cos(theta') dω = dl dm. So the irradiance of a film point under a
// uniform radiance L is L times the area of the region, also if glass covers the film, and uniform samples have equal
// weights. The region is tabulated over a film map (film_map.hpp).

/// Triangle from the centre of the region's bounding box to a segment of the region's outline. Coordinates are relative
/// to the centre, in units of the half-widths of the box. If the lens has a central obstruction, a smaller similar
/// triangle at the centre (hole) is removed.
struct PupilSector {
    float x, y;  ///< first corner on the outline
    float dx, dy;  ///< vector from the first to the second corner on the outline
    float hole_squared;  ///< squared ratio of the hole's size to the triangle's size; 0: no hole
};

/// Twice the area of a sector without its hole, in units of the half-widths of the box.
REALCAM_INLINE float twice_area(const PupilSector& sector) {
    return (sector.x * sector.dy - sector.y * sector.dx) * (1.0f - sector.hole_squared);
}

/// Number of sectors of half a region.
inline constexpr int kPupilSectors = 32;

/// Sampling of the two halves of a region, above and below the centre of its box.
struct PupilHalfSampling {
    float upper_probability;  ///< probability of sampling the upper half: its fraction of the region's area
    float upper_weight, lower_weight;  ///< 1 / (2 x probability of choosing a sector); 0 if no light arrives
};

/// Pupil of a lens, tabulated over a film map. The sectors of a cell are used for all of its film points.
template <class Map>
struct PupilTableView : Map {
    static constexpr int kSectors = kPupilSectors;

    const typename Map::Node* nodes;  ///< null: a camera uses a table over the other film map
    const PupilSector* outline;  ///< of each cell, kSectors sectors of the upper half; then, unless the region is
                                 ///< symmetric in m, those of the lower half, whose y points down
    const PupilHalfSampling* halves;  ///< of each cell; null if regions are symmetric in m
    float index_squared;  ///< n^2 of the medium in front of the film

    /// Calls move(address of an array, its number of elements) for each array.
    template <class Move>
    void move_arrays(Move&& move) {
        move(nodes, this->node_count());
        move(outline, this->cell_count() * Map::kHalves * kSectors);
        move(halves, this->cell_count());
    }
};

/// Pupil of a centred, rotationally symmetric lens.
using PupilView = PupilTableView<RadialFilmMap>;
/// Pupil of a lens of any kind.
using PupilGridView = PupilTableView<PlanarFilmMap>;

/// Entry of a table for a film point (mm). Its constructor initialises each member in place: GCC does not vectorise
/// over copies of structures.
template <class Map>
struct PupilLookup {
    FilmMapPosition<Map> at;
    typename Map::Node box;  ///< interpolated box of the region
    PupilHalfSampling halves;

    REALCAM_INLINE PupilLookup(const PupilTableView<Map>& pupil, float film_x, float film_y)
        : at(pupil.locate(film_x, film_y)),
          box(pupil.interpolated(pupil.nodes, at.nodes)),
          halves(half_sampling(pupil, at)) {}

    REALCAM_INLINE static PupilHalfSampling half_sampling(const PupilTableView<Map>& pupil,
                                                          const FilmMapPosition<Map>& at) {
        if constexpr (Map::kHalves == 1) {
            const float weight = static_cast<float>(kPupilSectors) * at.lit;
            return {0.5f, weight, weight};
        } else {
            const PupilHalfSampling& of_cell = pupil.halves[at.cell];
            return {of_cell.upper_probability, of_cell.upper_weight, of_cell.lower_weight};
        }
    }
    /// Index of the first sector of a half.
    REALCAM_INLINE int half(bool lower) const {
        return (Map::kHalves * at.cell + select(lower && Map::kHalves == 2, 1, 0)) * kPupilSectors;
    }
    /// Converts a point in the box, in units of its half-widths, to direction cosines of the map.
    REALCAM_INLINE Vec2f from_box(Vec2f point) const {
        return {box.centre_l + box.half_width * point.x, box.centre_m + box.half_height * point.y};
    }
    /// Converts direction cosines of the map to those at the film point.
    REALCAM_INLINE Vec2f to_film(Vec2f d) const { return at.frame.to_film(d); }
    /// Converts direction cosines at the film point to a point in the box, in units of its half-widths.
    REALCAM_INLINE Vec2f in_box(Vec2f film) const {
        const Vec2f d = at.frame.to_map(film);
        return {(d.x - box.centre_l) / box.half_width, (d.y - box.centre_m) / box.half_height};
    }
    /// Inverse density of directions in a sector of a half, an area in direction cosines; 0 if no light arrives.
    REALCAM_INLINE float weight(const PupilSector& sector, bool lower) const {
        return select(lower, halves.lower_weight, halves.upper_weight) * twice_area(sector) * box.half_width *
               box.half_height;
    }
    /// False if no light can reach the film point.
    REALCAM_INLINE bool may_be_lit() const { return halves.upper_weight > 0.0f; }
};

/// A sampled sector.
struct PupilSectorDraw {
    int index;  ///< index of the sector in the view's outline
    float along;  ///< position along its outer edge, from 0 to 1, uniform
    int lower;  ///< 1: in the lower half of the region, whose y points down; else 0 (GCC does not vectorise over bools)
};

/// Chooses a half by its probability and one of its sectors with equal probability, by a random number u in [0, 1).
template <class Map>
REALCAM_INLINE PupilSectorDraw draw_sector(const PupilLookup<Map>& position, float u) {
    const float upper_probability = position.halves.upper_probability;
    const bool lower = u >= upper_probability;
    const float part = select(lower, u - upper_probability, u),
                probability = select(lower, 1.0f - upper_probability, upper_probability);
    // Halves of equal probability need no division, which a GPU would not omit.
    const float in_half = Map::kHalves == 1 ? 2.0f * part : quotient(part, probability);
    const float scaled = in_half * static_cast<float>(kPupilSectors);
    int index = static_cast<int>(scaled);
    index = select(index < kPupilSectors, index, kPupilSectors - 1);
    return {position.half(lower) + index, scaled - static_cast<float>(index), select(lower, 1, 0)};
}

/// Sampled direction of a ray at a film point.
struct PupilSample {
    Vec3f direction;  ///< unit vector times n, towards the scene, in the tangent frame of the film point
    float weight;  ///< 1 / pupil_pdf; 0 outside the image circle, and if l^2 + m^2 > n^2
};

/// Samples a direction for a film point (mm) by random numbers u and v in [0, 1): u chooses the sector and the position
/// along its edge, and v the distance from the centre. The density is uniform over each sector.
template <class Map>
REALCAM_INLINE PupilSample sample_pupil(const PupilTableView<Map>& pupil, float film_x, float film_y, float u,
                                        float v) {
    const PupilLookup position(pupil, film_x, film_y);
    const PupilSectorDraw draw = draw_sector(position, u);
    const PupilSector& sector = pupil.outline[draw.index];
    const bool lower = draw.lower != 0;
    const float radius = sqrt_or_zero(sector.hole_squared + v * (1.0f - sector.hole_squared));
    const float x = radius * (sector.x + draw.along * sector.dx);
    const float y = radius * (sector.y + draw.along * sector.dy);
    const Vec2f d = position.from_box({x, select(lower, -y, y)}), film = position.to_film(d);
    // The sectors of a film point far outside the lens may extend beyond the half-space of directions.
    const float squared_z = pupil.index_squared - d.x * d.x - d.y * d.y;
    return {{film.x, film.y, -sqrt_or_zero(squared_z)}, select(squared_z > 0.0f, position.weight(sector, lower), 0.0f)};
}

/// Returns the index of the sector at the azimuth of a point, from 0 to pi, by bisection. `row`: sectors of half a
/// region; `sectors`: their number; `x`, `y`: point in units of the half-widths of the box.
REALCAM_INLINE int sector_at(const PupilSector* row, int sectors, float x, float y) {
    int first = 0, last = sectors;
    while (first + 1 < last) {
        const int middle = (first + last) / 2;
        const bool after = row[middle].x * y - row[middle].y * x >= 0.0f;
        first = select(after, middle, first);
        last = select(after, last, middle);
    }
    return first;
}

/// True if a point at a sector's azimuth lies between the sector's inner and outer edges.
REALCAM_INLINE bool holds(const PupilSector& s, float x, float y) {
    const float radius = (x * s.dy - y * s.dx) / (s.x * s.dy - s.y * s.dx);
    return radius <= 1.0f && radius * radius >= s.hole_squared;
}

/// Density of sample_pupil at the optical direction cosines (l, m), per unit of their area; 0 if the direction is not
/// sampled.
template <class Map>
REALCAM_INLINE float pupil_pdf(const PupilTableView<Map>& pupil, float film_x, float film_y, float l, float m) {
    const PupilLookup position(pupil, film_x, film_y);
    const Vec2f point = position.in_box({l, m});
    const bool lower = point.y < 0.0f;
    const float y = std::fabs(point.y);
    const PupilSector* const half = pupil.outline + position.half(lower);
    const PupilSector& s = half[sector_at(half, kPupilSectors, point.x, y)];
    const bool inside = holds(s, point.x, y);
    const bool exists = l * l + m * m < pupil.index_squared;
    const float weight = position.weight(s, lower);
    return select(inside && exists && weight > 0.0f, 1.0f / weight, 0.0f);
}

}  // namespace REALCAM_NAMESPACE
