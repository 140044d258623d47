#pragma once
#include "../path/advance_path.hpp"
#include "ghost_lens_paths.hpp"

namespace REALCAM_NAMESPACE {

// Ghosts of light that objects reflect, by path tracing: from a film point along one ghost path through the lens into
// the scene, where a path continues as one of a pixel sample. The ghost of a light that a ray hits directly is left to
// light tracing (splat_ghosts.hpp), unless that cannot sample the light.

namespace gather_ghosts_detail {

/// Density of camera rays that is below that of any sampled light, so that the MIS weight of lights which they hit is
/// 0.
inline constexpr float kLeftToLightTracing = 1e-30f;

/// Probe of advance_paths that measures nothing.
struct NoProbe {
    REALCAM_HD void enter(RenderStage) {}
};

/// Samples at random film points, with rays from there to random points of the last vertex plane.
template <int N>
struct FilmRays {
    SampleBlock<N> block;
    LensRays<float, N> rays;  ///< in the lens frame, mm
    Lanes<float, N> weight;  ///< irradiance on the film per unit of radiance along the ray
};

/// Ray from a film point to a point of a ghost path's bounds in the last vertex plane (GhostBounds).
struct FilmRay {
    Vec3f origin, direction;  ///< lens frame, mm; the direction has the length of the refractive index
    float weight;  ///< irradiance on the film per unit of radiance along the ray
};

// Samples a ray for a ghost path. `entries`: the bounds of the path; `film`: film point, mm; `u`: random numbers in [0,
// 1).

/// For rotationally symmetric lenses: the bounds depend on the distance of the film point from the axis alone.
REALCAM_INLINE FilmRay rotational_film_ray(const CameraView& camera, const GhostView& ghosts,
                                           const GhostBounds* entries, Vec2f film, Vec2f u) {
    const auto [x, y] = film;
    const float radius = std::sqrt(x * x + y * y), inverse = 1.0f / select(radius > 0.0f, radius, 1.0f);
    const float out_x = select(radius > 0.0f, x * inverse, 1.0f), out_y = y * inverse;
    const int bin = static_cast<int>(radius / ghosts.film_radius * static_cast<float>(kGhostBins));
    const EntryPoint point = entry_point(entries[select(bin < kGhostBins, bin, kGhostBins - 1)], ghosts.reach, u);
    const float to_x = point.along * out_x - point.across * out_y - x,
                to_y = point.along * out_y + point.across * out_x - y;
    const float to_z = -camera.film_distance, squared = to_x * to_x + to_y * to_y + to_z * to_z;
    const float scale = ghosts.film_index / std::sqrt(squared), cosine2 = to_z * to_z / squared;
    return {{x, y, camera.film_distance},
            {scale * to_x, scale * to_y, scale * to_z},
            ghosts.film_index * ghosts.film_index * cosine2 / (squared * point.density)};
}

/// For lenses without rotational symmetry.
REALCAM_INLINE FilmRay freeform_film_ray(const CameraView& camera, const GhostView& ghosts, const GhostBounds* entries,
                                         Vec2f film, Vec2f u) {
    const int cell = ghosts.grid.cell_of(film);
    const EntryPoint point = entry_point(entries[select(cell < 0, 0, cell)], ghosts.reach, u);
    const FilmSurface<float> surface = film_surface(camera);
    const Vec3f from = surface.point(film), to = Vec3f{point.along, point.across, 0} - from;
    const float squared = dot(to, to), index = ghosts.film_index, scale = index / std::sqrt(squared);
    // Product of the cosines at the film and in the plane, times the squared distance.
    const float cosines = -to.z * dot(to, surface.direction(film, {0, 0, -1}));
    const float weight = index * index * cosines / (squared * squared * point.density);
    return {from, scale * to, select((cell >= 0) & (cosines > 0.0f), weight, 0.0f)};
}

/// `path`: index of the ghost path.
template <LensKind lens_kind>
REALCAM_INLINE FilmRay film_ray(const CameraView& camera, const GhostView& ghosts, int path, Vec2f film, Vec2f u) {
    if constexpr (lens_kind == LensKind::any)
        return freeform_film_ray(camera, ghosts, ghosts.entries + path * kGhostCells, film, u);
    else
        return rotational_film_ray(camera, ghosts, ghosts.entries + path * kGhostBins, film, u);
}

/// Samples the film points and rays of N samples of a block, from its sample `first` on.
template <LensKind lens_kind, int N>
REALCAM_INLINE void start_film_rays(const CameraView& camera, const GhostView& ghosts, const GhostBlock& block,
                                    std::uint32_t first, FilmRays<N>& film) {
    REALCAM_LANES
    for (int i = 0; i < N; ++i) {
        film.block.stream[i] = block.stream;
        film.block.sample[i] = block.first_sample + first + static_cast<std::uint32_t>(i);
        film.block.used[i] = 1;
        const Vec2f u = film.block.random(i, dimension::film);
        const int column = static_cast<int>(u.x * static_cast<float>(camera.width));
        const int row = static_cast<int>(u.y * static_cast<float>(camera.height));
        film.block.column[i] = select(column < camera.width, column, camera.width - 1);
        film.block.row[i] = select(row < camera.height, row, camera.height - 1);
        Vec2f at = {camera.film_centre.x + (1.0f - 2.0f * u.x) * camera.film_half_width,
                    camera.film_centre.y + (2.0f * u.y - 1.0f) * camera.film_half_height};
        if (camera.filter != PixelFilter::box) {
            const Vec2f in_pixel = {u.x * static_cast<float>(camera.width) - static_cast<float>(film.block.column[i]),
                                    u.y * static_cast<float>(camera.height) - static_cast<float>(film.block.row[i])};
            at = film_point(camera, film.block.column[i], film.block.row[i],
                            filtered_offset(camera.filter, {below_one(in_pixel.x), below_one(in_pixel.y)}));
        }
        const FilmRay ray =
            film_ray<lens_kind>(camera, ghosts, block.path_index, at, film.block.random(i, dimension::pupil));
        film.rays.origin.set(i, ray.origin);
        film.rays.direction.set(i, ray.direction);
        film.rays.status[i] = 0;
        film.weight[i] = ray.weight;
    }
}

/// Moves the rays of ghosts of a calibrated camera to where it sees the light of their directions: with the bundle
/// whose chief ray has, in front of the lens, the direction of the ghost's ray.
template <int N>
REALCAM_INLINE void move_ghosts(const CameraView& camera, CameraRays<N>& rays) {
    const BundleMotionsView& bundles = camera.bundles;
    if (!bundles.nodes) return;
    constexpr int kIterations = 4;  // each reduces the error by the change of the rotation over one radian of the field
    for (int i = 0; i < N; ++i) {
        const Vec3f direction = to_camera_axes(camera, rays.direction[i]);
        BundleMotion motion{};
        Vec3f seen = direction;
        for (int k = 0; k < kIterations; ++k) {
            motion = bundle_motion(bundles, film_point_seeing(bundles, seen));
            seen = rotated(motion.rotation(), direction);
        }
        move_ray(camera, motion, i, rays);
    }
}

}  // namespace gather_ghosts_detail

/// Traces N samples of a block, from its sample `first` on, and calls splat(pixel, irradiance, dither) as splat_ghosts
/// does. `scene`: as in advance_paths.
template <LensKind lens_kind, SceneKind scene_kind, bool has_wavelengths, int N, class SceneT, class Splat>
REALCAM_HD inline void gather_ghosts(const SceneView& view, const CameraView& camera, const PathSettings& settings,
                                     const GhostView& ghosts, GhostRange range, std::uint32_t first, SceneT&& scene,
                                     Splat&& splat) {
    using namespace gather_ghosts_detail;
    const GhostBlock block = ghost_block(ghosts, range);
    FilmRays<N> film;
    start_film_rays<lens_kind>(camera, ghosts, block, first, film);
    [[maybe_unused]] Lanes<float, N> cell_position,
        variable;  // as in GhostSamples
    if constexpr (has_wavelengths) {
        REALCAM_LANES
        for (int i = 0; i < N; ++i) {
            cell_position[i] =
                film.block.random(i, dimension::time).y * static_cast<float>(camera.dispersion.cell_count);
            variable[i] = camera.dispersion.variable.at(wavelength_at(camera.dispersion, cell_position[i]));
        }
    }
    PassedPower<N> passed;
    pass_ghost_lens_path<lens_kind, has_wavelengths>(ghosts, block.path, film.rays, variable, passed);
    CameraRays<N> camera_rays;
    // A sample has a random pixel, out of width * height, and follows this ghost path with a given probability.
    const float scale = static_cast<float>(camera.width) * static_cast<float>(camera.height) / block.path.probability;
    REALCAM_LANES
    for (int i = 0; i < N; ++i) {
        camera_rays.weight[i] =
            select(film.rays.status[i] == 0, scale * passed.of_unpolarised(i) * film.weight[i], 0.0f);
        camera_rays.sampled[i] = 1;
    }
    set_camera_rays(camera, film.rays, camera_rays);
    move_ghosts(camera, camera_rays);
    PathState<N> path;
    PathResults<N> results;
    if constexpr (scene_kind == SceneKind::any) expose_rays(camera, film.block, camera_rays, path.rays.time);
    start_paths(camera_rays, path, results);
    for (int i = 0; i < N; ++i) set_first_density<scene_kind>(camera, kLeftToLightTracing, i, path);
    NoProbe probe;
    for (int bounce = 0;
         advance_paths<scene_kind>(view, camera, settings, film.block, bounce, scene, probe, path, results);)
        ++bounce;
    for (int i = 0; i < N; ++i) {
        Color c = results.irradiance[i];
        if (is_black(c)) continue;
        if constexpr (has_wavelengths) c = film_color(camera.dispersion, cell_position[i], c);
        const std::int32_t pixel = film.block.row[i] * camera.width + film.block.column[i];
        splat(pixel, c, unit_float(film.block.bits(i, 0)));
    }
}

}  // namespace REALCAM_NAMESPACE
