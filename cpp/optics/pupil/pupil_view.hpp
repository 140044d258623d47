#pragma once
#include <cmath>

#include "../../math/lanes.hpp"

namespace REALCAM_NAMESPACE {

// Sampling of the pupil on CPU and GPU. The pupil as seen from a film point is a region of directions. It is described
// in optical direction cosines (l, m): x and y of the unit vector times the refractive index n in front of the film.
// They are a measure of projected solid angle, n^2 cos(theta') dω = dl dm. So the irradiance of a film point under a
// uniform radiance L is L times the area of the region, also if glass covers the film, and uniform samples have equal
// weights.
//
// The region is tabulated over a film map: over the film radius (PupilView), or over the film's x and y
// (PupilGridView). Both views provide
//   pupil_lookup(view, film_x, film_y)  the table's entry for a film point, of a type Lookup with the members
//     draw(view, u)                       chooses a sector by a random number
//     half(view, lower)                   index of the first sector of the upper or lower half of the region
//     in_box, from_box, to_film           convert directions between the film's frame and the box of the region
//   pupil_weight(view, lookup, sector, lower)  inverse density of a sector
//   may_be_lit(view, lookup)            false if no light can reach the film point

/// Triangle from the centre of the region's bounding box to a segment of the region's outline. Coordinates are relative
/// to the centre, in units of the half-widths of the box. If the lens has a central obstruction, a smaller similar
/// triangle at the centre (hole) is removed.
struct PupilSector {
    float x, y;  ///< first corner on the outline
    float dx, dy;  ///< vector from the first to the second corner on the outline
    float hole_squared;  ///< squared ratio of the hole's size to the triangle's size; 0: no hole
};

/// A sampled sector.
struct PupilSectorDraw {
    int index;  ///< index of the sector in the view's outline
    float along;  ///< position along its outer edge, from 0 to 1, uniform
    int lower;  ///< 1: in the lower half of the region, whose y points down; else 0 (GCC does not vectorise over bools)
};

/// Sampled direction of a ray at a film point.
struct PupilSample {
    Vec3f direction;  ///< unit vector times n, towards the scene, in the tangent frame of the film point
    float weight;  ///< 1 / pupil_pdf; 0 outside the image circle, and if l^2 + m^2 > n^2
};

/// Twice the area of a sector without its hole, in units of the half-widths of the box.
REALCAM_INLINE float twice_area(const PupilSector& sector) {
    return (sector.x * sector.dy - sector.y * sector.dx) * (1.0f - sector.hole_squared);
}

/// Samples a direction for a film point (mm) by random numbers u and v in [0, 1): u chooses the sector and the position
/// along its edge, and v the distance from the centre. The density is uniform over each sector.
template <class View>
REALCAM_INLINE PupilSample sample_pupil(const View& pupil, float film_x, float film_y, float u, float v) {
    const auto position = pupil_lookup(pupil, film_x, film_y);
    const PupilSectorDraw draw = position.draw(pupil, u);
    const PupilSector& sector = pupil.outline[draw.index];
    const bool lower = draw.lower != 0;
    const float radius = sqrt_or_zero(sector.hole_squared + v * (1.0f - sector.hole_squared));
    const float x = radius * (sector.x + draw.along * sector.dx);
    const float y = radius * (sector.y + draw.along * sector.dy);
    const Vec2f d = position.from_box({x, select(lower, -y, y)}), film = position.to_film(d);
    // The sectors of a film point far outside the lens may extend beyond the half-space of directions.
    const float squared_z = pupil.index_squared - d.x * d.x - d.y * d.y;
    return {{film.x, film.y, -sqrt_or_zero(squared_z)},
            select(squared_z > 0.0f, pupil_weight(pupil, position, sector, lower), 0.0f)};
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
template <class View>
REALCAM_INLINE float pupil_pdf(const View& pupil, float film_x, float film_y, float l, float m) {
    const auto position = pupil_lookup(pupil, film_x, film_y);
    const Vec2f point = position.in_box({l, m});
    const bool lower = point.y < 0.0f;
    const float y = std::fabs(point.y);
    const PupilSector* const half = pupil.outline + position.half(pupil, lower);
    const PupilSector& s = half[sector_at(half, View::kSectors, point.x, y)];
    const bool inside = holds(s, point.x, y);
    const bool exists = l * l + m * m < pupil.index_squared;
    const float weight = pupil_weight(pupil, position, s, lower);
    return select(inside && exists && weight > 0.0f, 1.0f / weight, 0.0f);
}

/// Bounding box of the region for film points at one radius, with the film point on the +x axis.
struct PupilNode {
    float centre;  ///< l of the box's centre; its m is 0 by symmetry
    float half_width;  ///< along l
    float half_height;  ///< along m
};

/// Pupil of a rotationally symmetric lens, tabulated over the film radius. A film radius lies at the position
/// rows * (1 - sqrt(1 - radius / image_radius)), so that the spacing of rows decreases towards the edge, where
/// vignetting changes the outline fastest. Each row has kSectors sectors for m >= 0; those for m < 0 are their mirror
/// images. Boxes are interpolated between nodes, and the sectors of a row are used for all film radii from node to
/// node.
struct PupilView {
    static constexpr int kSectors = 32;  ///< sectors of half a region

    const PupilNode* nodes;  ///< rows + 1
    const PupilSector* outline;  ///< rows x kSectors
    int rows;
    float image_radius;  ///< radius of the image circle, mm: no light reaches film points further out
    float inverse_image_radius;  ///< 0 if the image radius is 0
    float index_squared;  ///< n^2 of the medium in front of the film
};

/// Entry of a PupilView for a film point: the interpolated box of its region, and its row of sectors.
struct PupilRowPosition {
    float cos, sin;  ///< cosine and sine of the film point's azimuth, by which the region is rotated
    float centre, half_width, half_height;  ///< see PupilNode
    int row;  ///< index of the row of sectors
    float lit;  ///< 1 inside the image circle, else 0

    /// Chooses a sector of the region with equal probability, by a random number u in [0, 1).
    REALCAM_INLINE PupilSectorDraw draw(const PupilView&, float u) const {
        constexpr int kBoth = 2 * PupilView::kSectors;
        const float scaled = u * static_cast<float>(kBoth);
        int index = static_cast<int>(scaled);
        index = select(index < kBoth, index, kBoth - 1);
        const float along = scaled - static_cast<float>(index);
        const bool lower = index >= PupilView::kSectors;
        return {row * PupilView::kSectors + (index - select(lower, PupilView::kSectors, 0)), along,
                select(lower, 1, 0)};
    }
    /// Index of the first sector of a half; both halves share their sectors.
    REALCAM_INLINE int half(const PupilView&, bool) const { return row * PupilView::kSectors; }
    /// Converts a point in the box, in units of its half-widths, to direction cosines of the map (film point on the +x
    /// axis).
    REALCAM_INLINE Vec2f from_box(Vec2f position) const {
        return {centre + half_width * position.x, half_height * position.y};
    }
    /// Converts direction cosines of the map to those at the film point.
    REALCAM_INLINE Vec2f to_film(Vec2f d) const { return {d.x * cos - d.y * sin, d.x * sin + d.y * cos}; }
    /// Converts direction cosines at the film point to a point in the box, in units of its half-widths.
    REALCAM_INLINE Vec2f in_box(Vec2f film) const {
        return {(film.x * cos + film.y * sin - centre) / half_width, (film.y * cos - film.x * sin) / half_height};
    }
};

/// Looks up a film point (mm).
REALCAM_INLINE PupilRowPosition pupil_lookup(const PupilView& pupil, float film_x, float film_y) {
    const float squared = film_x * film_x + film_y * film_y;
    const bool off_axis = squared > 0.0f;
    const float radius = sqrt_or_zero(squared);
    const float inverse = quotient(1.0f, select(off_axis, radius, 1.0f));
    const float position =
        static_cast<float>(pupil.rows) * (1.0f - sqrt_or_zero(1.0f - radius * pupil.inverse_image_radius));
    int row = static_cast<int>(position);
    row = select(row < pupil.rows, row, pupil.rows - 1);
    const float f = position - static_cast<float>(row);
    const PupilNode& near = pupil.nodes[row];
    const PupilNode& far = pupil.nodes[row + 1];
    return {select(off_axis, film_x * inverse, 1.0f),
            film_y * inverse,
            near.centre + f * (far.centre - near.centre),
            near.half_width + f * (far.half_width - near.half_width),
            near.half_height + f * (far.half_height - near.half_height),
            row,
            select(radius < pupil.image_radius, 1.0f, 0.0f)};
}

/// Inverse density of directions in a sector, an area in direction cosines. All 2 kSectors sectors are equally
/// probable, so that it is their number times the area of this sector. 0 outside the image circle.
REALCAM_INLINE float pupil_weight(const PupilView&, const PupilRowPosition& position, const PupilSector& sector, bool) {
    return static_cast<float>(PupilView::kSectors) * twice_area(sector) * position.half_width * position.half_height *
           position.lit;
}

/// False if no light can reach a film point.
REALCAM_INLINE bool may_be_lit(const PupilView&, const PupilRowPosition& position) {
    return position.lit > 0.0f;
}

}  // namespace REALCAM_NAMESPACE
