#pragma once
#include <cmath>

#include "../math/lanes.hpp"

namespace REALCAM_NAMESPACE {

// The pupil as a film point sees it is a region of directions. It is kept in optical direction cosines (l, m), because
// there the exposure integral (source paper, equations 6 and 7) has no factors left: n^2 cos(theta') dω = dl dm, so
// that the irradiance of a field of radiance L is L times the region's area (also on a film that glass covers), and
// uniform samples all have the same weight.

/// Where the region lies for film points at one radius, the film point lying on the +x axis.
struct PupilNode {
    float centre;       ///< l of the middle of the region's bounding box; its m is 0 by symmetry
    float half_width;   ///< along l
    float half_height;  ///< along m
};

/// A triangle from the middle of the region to a piece of its outline, in units of the box. Light that is blocked in
/// the middle (a mirror lens) leaves out a smaller similar triangle.
struct PupilSector {
    float x, y;    ///< first corner on the outline
    float dx, dy;  ///< to the second one
    float hole_squared;
};

/// Rows of sectors over the film radius: row = rows * (1 - sqrt(1 - radius / image_radius)), so that they lie closer
/// and closer towards the edge, where vignetting changes the outline fastest. Each row has `sectors` sectors for m >=
/// 0; the others mirror them.
struct PupilView {
    const PupilNode* nodes;  ///< rows + 1
    const PupilSector* outline;
    int rows, sectors;
    float image_radius;         ///< no light reaches film points further out, mm
    float inverse_image_radius;  ///< 0 where there is no light at all
    float index_squared;         ///< n^2 of the medium before the film
};

/// A ray's start direction.
struct PupilSample {
    Vec3f direction;  ///< optical, from the film point to the scene, lens frame
    float weight;     ///< one over the density: steradians of projected solid angle; 0 outside the image circle
};

/// Chooses a direction for a film point (x, y) in mm, from u and v in [0, 1). Uniform over the row's outline.
REALCAM_INLINE PupilSample sample_pupil(const PupilView& pupil, float film_x, float film_y, float u, float v) {
    const float radius = std::sqrt(film_x * film_x + film_y * film_y);
    const float inverse = 1.0f / select(radius > 0.0f, radius, 1.0f);
    const float cos = select(radius > 0.0f, film_x * inverse, 1.0f);
    const float sin = film_y * inverse;

    const bool lit = radius < pupil.image_radius;
    const float position =
        static_cast<float>(pupil.rows) * (1.0f - sqrt_or_zero(1.0f - radius * pupil.inverse_image_radius));
    int row = static_cast<int>(position);
    row = select(row < pupil.rows, row, pupil.rows - 1);
    const float f = position - static_cast<float>(row);
    const PupilNode& near = pupil.nodes[row];
    const PupilNode& far = pupil.nodes[row + 1];
    const float centre = near.centre + f * (far.centre - near.centre);
    const float width = near.half_width + f * (far.half_width - near.half_width);
    const float height = near.half_height + f * (far.half_height - near.half_height);

    const float scaled = u * static_cast<float>(2 * pupil.sectors);
    int index = static_cast<int>(scaled);
    index = select(index < 2 * pupil.sectors, index, 2 * pupil.sectors - 1);
    const float along = scaled - static_cast<float>(index);
    const bool lower = index >= pupil.sectors;
    index = select(lower, index - pupil.sectors, index);
    const PupilSector& sector = pupil.outline[row * pupil.sectors + index];
    const float open = 1.0f - sector.hole_squared;
    const float reach = std::sqrt(sector.hole_squared + v * open);
    const float x = reach * (sector.x + along * sector.dx);
    const float y = reach * (sector.y + along * sector.dy);
    // Sectors are chosen evenly, so the density is one over this: their number times the area of one.
    const float area = static_cast<float>(pupil.sectors) * (sector.x * sector.dy - sector.y * sector.dx) * open;

    const float l = centre + width * x;
    const float m = height * select(lower, -y, y);
    const float l_film = l * cos - m * sin, m_film = l * sin + m * cos;
    const float towards_scene = sqrt_or_zero(pupil.index_squared - l * l - m * m);
    return {{l_film, m_film, -towards_scene}, select(lit, area * width * height, 0.0f)};
}

}  // namespace REALCAM_NAMESPACE
