#pragma once
#include <cmath>

#include "../../math/lanes.hpp"

namespace REALCAM_NAMESPACE {

// The pupil as seen from a film point is a region of directions. It is stored in optical direction cosines (l, m), in
// which the exposure integral (source paper, equations 6 and 7) has no factors: n^2 cos(theta') dω = dl dm. So the
// irradiance from a field of radiance L is L times the region's area, also on a film that glass covers. Uniform samples
// all have the same weight.
//
// The region is tabulated over a film map: the film radius (PupilView), or the film's x and y (PupilGridView). A view
// has a `pupil_lookup`, whose result finds sectors (`draw`, `half`) and converts directions between the map's frame and
// the film's (`in_box`, `from_box`, `to_film`); `pupil_weight`; and `may_be_lit`.

/// A triangle from the centre of the region to a piece of its outline, in units of the box. A central obstruction (a
/// mirror lens) removes a smaller similar triangle.
struct PupilSector {
    float x, y;  ///< first corner on the outline
    float dx, dy;  ///< to the second corner
    float hole_squared;
};

/// A sampled sector, and the position along its outer edge, from 0 to 1.
struct PupilSectorDraw {
    int index;  ///< in the view's outline
    float along;
    int lower;  ///< 1: in the lower half of the region, whose y points down. No bool: GCC vectorises no loop over it
};

/// Sampled direction of a ray at a film point.
struct PupilSample {
    Vec3f direction;  ///< optical, from the film point to the scene, lens frame
    float weight;  ///< 1 / pupil_pdf; 0 outside the image circle, and if the direction does not exist
};

/// Area of a sector without its hole, in units of the box's half-widths, times 2.
REALCAM_INLINE float twice_area(const PupilSector& sector) {
    return (sector.x * sector.dy - sector.y * sector.dx) * (1.0f - sector.hole_squared);
}

/// Samples a direction for a film point (x, y) in mm, from u and v in [0, 1). Uniform over each sector.
template <class View>
REALCAM_INLINE PupilSample sample_pupil(const View& pupil, float film_x, float film_y, float u, float v) {
    const auto position = pupil_lookup(pupil, film_x, film_y);
    const PupilSectorDraw drawn = position.draw(pupil, u);
    const PupilSector& sector = pupil.outline[drawn.index];
    const bool lower = drawn.lower != 0;
    const float reach = sqrt_or_zero(sector.hole_squared + v * (1.0f - sector.hole_squared));
    const float x = reach * (sector.x + drawn.along * sector.dx);
    const float y = reach * (sector.y + drawn.along * sector.dy);
    const Vec2f d = position.from_box({x, select(lower, -y, y)}), film = position.to_film(d);
    // There are no directions beyond the half-space, which the sectors of a film point far outside the lens may exceed.
    const float rest = pupil.index_squared - d.x * d.x - d.y * d.y;
    return {{film.x, film.y, -sqrt_or_zero(rest)},
            select(rest > 0.0f, pupil_weight(pupil, position, sector, lower), 0.0f)};
}

/// Index of the sector of a point in the box, by its azimuth, which runs from 0 to pi.
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

/// True if a point at a sector's azimuth lies between the sector's inner and outer edge.
REALCAM_INLINE bool holds(const PupilSector& s, float x, float y) {
    const float reach = (x * s.dy - y * s.dx) / (s.x * s.dy - s.y * s.dx);
    return reach <= 1.0f && reach * reach >= s.hole_squared;
}

/// Density of sample_pupil at the optical direction cosines (l, m), per unit of their area; 0 for directions that are
/// never sampled.
template <class View>
REALCAM_INLINE float pupil_pdf(const View& pupil, float film_x, float film_y, float l, float m) {
    const auto position = pupil_lookup(pupil, film_x, film_y);
    const Vec2f at = position.in_box({l, m});
    const bool lower = at.y < 0.0f;
    const float y = std::fabs(at.y);
    const PupilSector* const half = pupil.outline + position.half(pupil, lower);
    const PupilSector& s = half[sector_at(half, View::kSectors, at.x, y)];
    const bool inside = holds(s, at.x, y);
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

/// Rows of sectors over the film radius: row = rows * (1 - sqrt(1 - radius / image_radius)), so that their spacing
/// decreases towards the edge, where vignetting changes the outline fastest. Each row has kSectors sectors for m >= 0;
/// those for m < 0 mirror them.
struct PupilView {
    static constexpr int kSectors = 32;

    const PupilNode* nodes;  ///< rows + 1
    const PupilSector* outline;
    int rows;
    float image_radius;  ///< no light reaches film points further out, mm
    float inverse_image_radius;  ///< 0 where there is no light at all
    float index_squared;  ///< n^2 of the medium before the film
};

/// Lookup of a film point: the interpolated box of its region, and its row of sectors.
struct PupilRowPosition {
    float cos, sin;  ///< film point's azimuth, by which the region is rotated
    float centre, half_width, half_height;
    int row;
    float lit;  ///< 1 inside the image circle, else 0

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
    /// Index of the first sector of a half; both halves share them.
    REALCAM_INLINE int half(const PupilView&, bool) const { return row * PupilView::kSectors; }
    REALCAM_INLINE Vec2f from_box(Vec2f position) const {
        return {centre + half_width * position.x, half_height * position.y};
    }
    REALCAM_INLINE Vec2f to_film(Vec2f d) const { return {d.x * cos - d.y * sin, d.x * sin + d.y * cos}; }
    /// Point in the box, in units of its half-widths, of direction cosines at the film.
    REALCAM_INLINE Vec2f in_box(Vec2f film) const {
        return {(film.x * cos + film.y * sin - centre) / half_width, (film.y * cos - film.x * sin) / half_height};
    }
};

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

/// Inverse density in a sector, steradians of projected solid angle: sectors are chosen with equal probability, so that
/// it is their number times the area of this one. 0 outside the image circle.
REALCAM_INLINE float pupil_weight(const PupilView&, const PupilRowPosition& position, const PupilSector& sector, bool) {
    return static_cast<float>(PupilView::kSectors) * twice_area(sector) * position.half_width * position.half_height *
           position.lit;
}

/// False if no light can reach a film point.
REALCAM_INLINE bool may_be_lit(const PupilView&, const PupilRowPosition& position) {
    return position.lit > 0.0f;
}

}  // namespace REALCAM_NAMESPACE
