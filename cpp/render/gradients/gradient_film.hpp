#pragma once
#include <numbers>

#include "../../camera/models/generate_rays.hpp"
#include "../../optics/derivatives/outline_search.hpp"

namespace REALCAM_NAMESPACE {

/// Film of a picture for its derivatives. It extends past the picture's border by `margin` pixels on each side, from
/// which light counts for the pixels at the border.
struct GradientFilm {
    int width, height, margin;  ///< size of the picture and width of the margin, pixels

    REALCAM_INLINE int extended_width() const { return width + 2 * margin; }
    REALCAM_INLINE int extended_height() const { return height + 2 * margin; }

    /// Sets a lane to sample `sample` of all those of a row of the extended film, each of whose pixels has `spp`.
    template <int N>
    REALCAM_INLINE void set_sample(SampleBlock<N>& block, int lane, int row, std::int64_t sample, int spp,
                                   std::uint32_t seed) const {
        const int column = static_cast<int>(sample / spp), x = column - margin, y = row - margin;
        const bool inside = x >= 0 && x < width && y >= 0 && y < height;
        // Pixels of the picture have its random numbers; those beyond its border have others.
        const int index = inside ? y * width + x : width * height + row * extended_width() + column;
        block.column[lane] = column;
        block.row[lane] = row;
        block.stream[lane] = pixel_stream(index, seed);
        block.sample[lane] = static_cast<std::uint32_t>(sample % spp);
    }
    /// Converts a film point from pixels of the extended film to pixels of the picture.
    REALCAM_INLINE Vec2f in_picture(Vec2f pixel) const {
        const auto away = static_cast<float>(margin);
        return {pixel.x - away, pixel.y - away};
    }
};

/// Makes two consecutive samples of a pixel a pair (GradientSamples::pairs), which has the same random numbers. Returns
/// 1 for the second, whose film point is mirrored (FilmSamples::mirrored), and 0 for the first.
template <int N>
REALCAM_INLINE std::int32_t pair_sample(SampleBlock<N>& block, int lane) {
    const auto is_second = static_cast<std::int32_t>(block.sample[lane] & 1u);
    block.sample[lane] >>= 1;
    return is_second;
}

/// Line of directions from the centre of the pupil's box at a film point.
struct PupilLine {
    static constexpr double kEnd = 1.6;  ///< end of the search, in half-widths of the box: beyond its corners

    DirectionLine line;
    double area;  ///< area of a quarter of the box, in direction cosines

    /// Inverse density of a point of the outline that lies on the line, per length on the rim.
    REALCAM_INLINE double weight(const OutlinePoint& point) const {
        return 2 * std::numbers::pi * area * point.t * point.inverse_speed;
    }
};

/// Returns the line in the direction that a random number u selects.
template <class Map>
REALCAM_INLINE PupilLine pupil_line(const PupilLookup<Map>& pupil, Vec2f film, float u) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(u);
    const Vec2f centre = pupil.to_film(pupil.from_box({0, 0}));
    const Vec2f step = pupil.to_film({pupil.box.half_width * static_cast<float>(std::cos(angle)),
                                      pupil.box.half_height * static_cast<float>(std::sin(angle))});
    const auto vector = [](Vec2f v) { return Vec2d{static_cast<double>(v.x), static_cast<double>(v.y)}; };
    return {{vector(film), vector(centre), pupil.may_be_lit() ? vector(step) : Vec2d{0, 0}},
            static_cast<double>(pupil.box.half_width) * static_cast<double>(pupil.box.half_height)};
}
REALCAM_INLINE PupilLine pupil_line(const CameraView& camera, Vec2f film, float u) {
    return camera.pupil_grid.nodes ? pupil_line(PupilLookup(camera.pupil_grid, film.x, film.y), film, u)
                                   : pupil_line(PupilLookup(camera.pupil, film.x, film.y), film, u);
}

/// Ray of the film in the double precision of its tangent, for one lane.
template <int N>
REALCAM_INLINE void set_film_ray(const OutlineLens& lens, Vec3f origin, Vec3f direction, LensRays<double, N>& rays,
                                 int lane) {
    const double l = static_cast<double>(direction.x), m = static_cast<double>(direction.y);
    rays.origin.set(lane, {static_cast<double>(origin.x), static_cast<double>(origin.y), lens.film_distance});
    rays.direction.set(lane, {l, m, -std::sqrt(lens.squared_index - l * l - m * m)});
    rays.status[lane] = 0;
}

/// Sets tangent m of a film ray by the light's direction cosines at the film, which are opposite to the ray's.
template <int N, int M>
REALCAM_INLINE void set_film_tangent(TangentRays<N, M>& rays, int lane, int m, Vec2d w) {
    rays.tangents[m].direction.set(lane, tangent_of_cosines(rays.direction[lane], {-w.x, -w.y}));
}

/// Stores a ray that grazes a rim in a lane, in render space.
template <int N>
REALCAM_INLINE void set_outline_ray(const CameraView& camera, const OutlinePoint& point, bool used, CameraRays<N>& rays,
                                    int lane) {
    const Vec3d o = point.origin;
    const Vec3d from_vertex = {o.x, o.y, o.z + 1000 * static_cast<double>(camera.front_vertex_m)};
    set_camera_ray(camera, rays, lane,
                   {static_cast<Vec3f>(from_vertex), static_cast<Vec3f>(normalized(point.direction)), 1.0f}, used);
    rays.sampled[lane] = rays.passed[lane] = used;
}

}  // namespace REALCAM_NAMESPACE
