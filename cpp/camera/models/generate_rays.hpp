#pragma once
#include "../../math/sampling.hpp"
#include "../../optics/trace/lens_trace.hpp"
#include "camera_view.hpp"
#include "lane_numbers.hpp"

namespace REALCAM_NAMESPACE {

// Camera rays: film and pupil sampling for all camera models, and the trace through the lens (generate_rays).

/// A ray from the film into the lens.
struct FilmRaySample {
    Vec3f origin;  ///< point of the film's surface, mm, in the frame in which the trace towards the scene begins
    Vec3f direction;  ///< optical direction: length is the refractive index
    float weight;  ///< see PupilSample::weight
};

/// Film surface in front of a lens of any kind, also without rotational symmetry.
REALCAM_INLINE FilmSurface<float> film_surface(const CameraView& camera) {
    return {camera.film_distance, camera.film_curvature};
}

/// Samples a ray from a film point (mm) into the lens. `u`: random numbers that select the pupil point, each in [0, 1).
/// `lens_kind`: LensKind::any, or the lens's own kind. The weight is 0 if no light reaches the film point.
template <LensKind lens_kind>
REALCAM_INLINE FilmRaySample sample_film_ray(const CameraView& camera, Vec2f film, Vec2f u) {
    if constexpr (lens_kind == LensKind::any) {
        if (camera.pupil_grid.nodes) {
            const PupilSample pupil = sample_pupil(camera.pupil_grid, film.x, film.y, u.x, u.y);
            const FilmSurface<float> surface = film_surface(camera);
            return {surface.point(film), surface.direction(film, pupil.direction), pupil.weight};
        }
    }
    const PupilSample pupil = sample_pupil(camera.pupil, film.x, film.y, u.x, u.y);
    return {{film.x, film.y, camera.film_distance}, pupil.direction, pupil.weight};
}

/// Intersection of a ray that has left the lens towards the film with the film, mm.
template <LensKind lens_kind>
REALCAM_INLINE Vec2f landing_on_film(const CameraView& camera, Vec3f origin, Vec3f direction) {
    if constexpr (lens_kind == LensKind::any) return film_surface(camera).landing(origin, direction);
    return crossing_at(camera.film_distance, origin, direction);
}

/// Irradiance of a pixel for unit flux arriving at a film point, 1/mm^2. A pixel's irradiance is the mean, over x and y
/// of its film samples, of the irradiance on the film's surface, whose area is larger than the pixel's where it is
/// inclined.
template <LensKind lens_kind>
REALCAM_INLINE float irradiance_of_flux(const CameraView& camera, Vec2f film) {
    const float pixel_area = 4.0f * camera.film_half_width * camera.film_half_height /
                             (static_cast<float>(camera.width) * static_cast<float>(camera.height));
    if constexpr (lens_kind == LensKind::any) return film_surface(camera).cosine(film) / pixel_area;
    return 1.0f / pixel_area;
}

/// Density of a direction sampled by sample_film_ray at a film point (mm), per unit area of optical direction cosines.
/// `direction`: optical direction at the film.
REALCAM_INLINE float camera_pupil_pdf(const CameraView& camera, Vec2f film, Vec3f direction) {
    if (camera.pupil_grid.nodes) return pupil_pdf(camera.pupil_grid, film.x, film.y, direction.x, direction.y);
    return pupil_pdf(camera.pupil, film.x, film.y, direction.x, direction.y);
}

/// Rays in render space: scene axes, metres.
template <int N>
struct CameraRays {
    Vec3Lanes<float, N> origin, direction;  ///< metres; unit vector
    Lanes<float, N> weight;  ///< irradiance of the sample on the film per unit radiance
    Lanes<std::int32_t, N> sampled;  ///< 1 if a ray was sent into the lens
    Lanes<std::int32_t, N> passed;  ///< 1 if it left the lens
};

/// Film point of a sample, mm. `offset`: position relative to the pixel's upper left corner, in pixels. The lens
/// inverts the picture, so the film's axes are opposite to the picture's.
REALCAM_INLINE Vec2f film_point(const CameraView& camera, std::int32_t column, std::int32_t row, Vec2f offset) {
    const float x = quotient(2.0f * (static_cast<float>(column) + offset.x), static_cast<float>(camera.width)) - 1.0f;
    const float y = quotient(2.0f * (static_cast<float>(row) + offset.y), static_cast<float>(camera.height)) - 1.0f;
    return {camera.film_centre.x - x * camera.film_half_width, camera.film_centre.y + y * camera.film_half_height};
}

/// Ray that has left the lens, in the lens frame.
struct LensFrameRay {
    Vec3f origin_mm;  ///< z relative to the front vertex
    Vec3f direction;  ///< unit vector
    float weight;  ///< see CameraRays::weight
};

/// Ray of the ideal thin lens from a pupil point towards the point in focus that is conjugate to a film point (mm).
/// `u`: random numbers that select the pupil point; `pupil_radius`: mm, 0 for a pinhole. Off the axis, irradiance falls
/// off as cos^4.
REALCAM_INLINE LensFrameRay thin_lens_ray(const CameraView& camera, Vec2f film, Vec2f u, float pupil_radius) {
    const Vec2f disc = sample_disc(u);
    const Vec2f p = {pupil_radius * disc.x, pupil_radius * disc.y};
    const float b = camera.thin.image_distance, a = camera.thin.inverse_object_distance;
    const float cosine2 = b * b / (b * b + film.x * film.x + film.y * film.y);
    const Vec3f direction = normalized(Vec3f{-film.x / b - p.x * a, -film.y / b - p.y * a, -1.0f});
    const float pupil_z = 1000.0f * (camera.front_vertex_m - camera.pupil_m);
    return {{p.x, p.y, pupil_z}, direction, camera.axis_irradiance * cosine2 * cosine2};
}

/// thin_lens_ray with the real lens's distortion and vignetting: the camera model mapped_lens.
REALCAM_INLINE LensFrameRay mapped_lens_ray(const CameraView& camera, Vec2f film, Vec2f u) {
    const LensMapNode map = lens_map_at(camera.map, film);
    LensFrameRay ray = thin_lens_ray(camera, {map.scale * film.x, map.scale * film.y}, u, camera.thin.pupil_radius);
    ray.weight = map.light;
    return ray;
}

/// Ray of the paraxial thick lens: from a film point (mm) through a point of the exit pupil, selected by the random
/// numbers `u`, to the front vertex plane.
REALCAM_INLINE LensFrameRay thick_lens_ray(const CameraView& camera, Vec2f film, Vec2f u) {
    const ThickLens& lens = camera.thick;
    const Vec2f disc = sample_disc(u);
    const float z = lens.exit_pupil_distance;
    // Slopes dx/dz, z growing towards the film.
    const Vec2f slope = {(film.x - lens.exit_pupil_radius * disc.x) / z,
                         (film.y - lens.exit_pupil_radius * disc.y) / z};
    const Vec2f last = {film.x - camera.film_distance * slope.x, film.y - camera.film_distance * slope.y};
    const Vec2f front = {lens.D * last.x - lens.B * slope.x, lens.D * last.y - lens.B * slope.y};
    const Vec2f out = {lens.A * slope.x - lens.C * last.x, lens.A * slope.y - lens.C * last.y};
    const float cosine2 = z * z / (z * z + film.x * film.x + film.y * film.y);
    return {
        {front.x, front.y, 0.0f}, normalized(Vec3f{-out.x, -out.y, -1.0f}), camera.axis_irradiance * cosine2 * cosine2};
}

/// Ray of an ideal model, one without the real lens's pupil, from a film point (mm) through the centre of the pupil.
REALCAM_INLINE LensFrameRay ideal_chief_ray(const CameraView& camera, Vec2f film) {
    const Vec2f centre = {0.0f, 0.0f};  // of the disc that sample_disc makes of the unit square
    if (camera.model == CameraModel::thick_lens) return thick_lens_ray(camera, film, centre);
    if (camera.model == CameraModel::mapped_lens) return mapped_lens_ray(camera, film, centre);
    return thin_lens_ray(camera, film, centre, 0.0f);
}

/// Transforms a ray from the lens frame to render space and stores it in a lane. If `has_light` is false, stores a
/// valid ray of weight 0 instead.
template <int N>
REALCAM_INLINE void set_camera_ray(const CameraView& camera, CameraRays<N>& rays, int lane, LensFrameRay ray,
                                   bool has_light) {
    const Vec3f o = select(has_light, ray.origin_mm, Vec3f{0, 0, 0});
    const Vec3f d = select(has_light, ray.direction, Vec3f{0, 0, -1});
    const float z = 0.001f * o.z - camera.front_vertex_m;
    rays.origin.set(lane,
                    camera.position + (0.001f * o.x) * camera.right + (0.001f * o.y) * camera.up + z * camera.backward);
    rays.direction.set(lane, d.x * camera.right + d.y * camera.up + d.z * camera.backward);
    rays.weight[lane] = select(has_light, ray.weight, 0.0f);
}

/// Moves a lane's ray by the motion of a bundle of a calibrated camera.
template <int N>
REALCAM_INLINE void move_ray(const CameraView& camera, const BundleMotion& motion, int lane, CameraRays<N>& rays) {
    const Vec3f origin = to_camera_axes(camera, rays.origin[lane] - camera.position),
                direction = to_camera_axes(camera, rays.direction[lane]);
    rays.origin.set(lane, camera.position + from_camera_axes(camera, moved_point(camera.bundles, motion, origin)));
    rays.direction.set(lane, from_camera_axes(camera, rotated(motion.rotation(), direction)));
}

/// Moves the rays of a calibrated camera with the bundles of their film points, and weights them by the gain there.
/// Rays of film points where the calibration has none are blocked. The rays of all other cameras stay as they are.
template <int N, class Points>
REALCAM_HD inline void move_bundles(const CameraView& camera, const Points& film, CameraRays<N>& rays) {
    const BundleMotionsView& bundles = camera.bundles;
    if (!bundles.nodes) return;
    // Loops of their own, because each is vector code in another way: over the lanes, or over the numbers of a motion.
    Lanes<std::int32_t, N> index;
    Vec2Lanes<float, N> within;
    REALCAM_LANES
    for (int i = 0; i < N; ++i) {
        const bundle_motion_detail::GridCell cell = bundle_motion_detail::cell_of(bundles, film[i]);
        index[i] = cell.index;
        within.set(i, {cell.x, cell.y});
    }
    BundleMotion motions[N];
    for (int i = 0; i < N; ++i) motions[i] = motion_in_cell(bundles, {index[i], within.x[i], within.y[i]});
    REALCAM_LANES
    for (int i = 0; i < N; ++i) {
        move_ray(camera, motions[i], i, rays);
        rays.weight[i] *= motions[i].gain();
    }
    if (!bundles.defined) return;
    for (int i = 0; i < N; ++i) {
        const bool defined = is_defined(bundles, film[i]);
        rays.weight[i] = select(defined, rays.weight[i], 0.0f);
        rays.passed[i] = select(defined, rays.passed[i], 0);
    }
}

/// Position of a sample relative to its pixel's upper left corner, in pixels, with the density of the camera's filter.
/// `u`: random numbers in [0, 1).
REALCAM_INLINE Vec2f filtered_offset(PixelFilter filter, Vec2f u) {
    if (filter == PixelFilter::box) return u;
    return {0.5f + sample_filter(filter, u.x), 0.5f + sample_filter(filter, u.y)};
}

/// Film point of each sample, with the density of the camera's filter about its pixel's centre.
template <int N>
struct PixelPoints {
    const CameraView& camera;
    const SampleBlock<N>& block;
    LaneNumbers<N> u;  ///< positions relative to the pixel's corner

    REALCAM_INLINE PixelPoints(const CameraView& view, const SampleBlock<N>& samples)
        : camera(view), block(samples), u(samples, dimension::film) {
        if (view.filter != PixelFilter::box)
            u.transform([&](int, Vec2f numbers) { return filtered_offset(view.filter, numbers); });
    }
    REALCAM_INLINE Vec2f operator[](int lane) const {
        return film_point(camera, block.column[lane], block.row[lane], u[lane]);
    }
    /// Film point that light of a lane's sample and of a wavelength reaches if geometrical optics brings it to `at`:
    /// without diffraction, `at` itself.
    REALCAM_INLINE Vec2f landing(int, Vec2f at, float) const { return at; }
};

/// Generates the rays of an ideal lens; `ray_of(film point, lane)` returns a LensFrameRay.
template <int N, class Points, class RayOf>
REALCAM_HD inline void generate_ideal_rays(const CameraView& camera, const SampleBlock<N>& block, const Points& film,
                                           CameraRays<N>& rays, RayOf&& ray_of) {
    REALCAM_LANES
    for (int i = 0; i < N; ++i) {
        const bool used = block.used[i] != 0;
        set_camera_ray(camera, rays, i, ray_of(film[i], i), used);
        rays.sampled[i] = rays.passed[i] = block.used[i];
    }
}

/// Marks used lanes with a positive weight as sampled, and the rays of all other lanes as vignetted.
template <class T, int N>
REALCAM_INLINE void mark_sampled(const SampleBlock<N>& block, LensRays<T, N>& inside, CameraRays<N>& rays) {
    REALCAM_LANES
    for (int i = 0; i < N; ++i) {
        rays.sampled[i] = select(rays.weight[i] > 0.0f, block.used[i], 0);
        inside.status[i] = select(rays.sampled[i] == 0, static_cast<int>(RayStatus::vignetted), 0);
    }
}

/// Starts rays at film points towards sampled points of the pupil: sets the rays `inside` the lens, before the last
/// surface, and the weights of `rays`. `u`: random numbers that select the pupil points.
template <LensKind lens_kind, class T, int N, class Points>
REALCAM_INLINE void start_lens_rays(const CameraView& camera, const SampleBlock<N>& block, const Points& film,
                                    const LaneNumbers<N>& u, LensRays<T, N>& inside, CameraRays<N>& rays) {
    REALCAM_LANES
    for (int i = 0; i < N; ++i) {
        const Vec2f at = film[i];
        const FilmRaySample ray = sample_film_ray<lens_kind>(camera, at, u[i]);
        inside.origin.set(i, static_cast<Vec3<T>>(ray.origin));
        inside.direction.set(i, static_cast<Vec3<T>>(ray.direction));
        rays.weight[i] = ray.weight;
    }
    mark_sampled(block, inside, rays);
}

/// Transforms the rays that have left the lens to render space.
template <class T, int N>
REALCAM_INLINE void set_camera_rays(const CameraView& camera, const LensRays<T, N>& inside, CameraRays<N>& rays) {
    REALCAM_LANES
    for (int i = 0; i < N; ++i) {
        const bool passed = inside.status[i] == 0;
        // Tracing keeps the length only near 1: to 1e-4 for a ray from far beside the lens.
        set_camera_ray(
            camera, rays, i,
            {static_cast<Vec3f>(inside.origin[i]), static_cast<Vec3f>(normalized(inside.direction[i])), rays.weight[i]},
            passed);
        rays.passed[i] = select(passed, 1, 0);
    }
}

/// Generates rays of a full lens, surface by surface.
template <LensKind lens_kind, int N, class Points>
REALCAM_HD inline void generate_lens_rays(const CameraView& camera, const SampleBlock<N>& block, const Points& film,
                                          const LaneNumbers<N>& u, CameraRays<N>& rays) {
    LensRays<float, N> inside;
    start_lens_rays<lens_kind>(camera, block, film, u, inside, rays);
    trace_lens<lens_kind>(camera.lens, inside);
    set_camera_rays(camera, inside, rays);
}

/// generate_lens_rays in double precision, for CameraModel::full_lens_double.
template <int N, class Points>
REALCAM_HD inline void generate_lens_rays_in_double(const CameraView& camera, const SampleBlock<N>& block,
                                                    const Points& film, const LaneNumbers<N>& u, CameraRays<N>& rays) {
    LensRays<double, N> inside;
    start_lens_rays<LensKind::any>(camera, block, film, u, inside, rays);
    trace_lens(*camera.lens_in_double, inside);
    set_camera_rays(camera, inside, rays);
}

/// generate_lens_rays for a camera whose pixels learn through which cells of the pupil light passes (PixelPupil).
/// Samples the cells known so far, and records the outcome.
template <LensKind lens_kind, int N, class Points>
REALCAM_HD inline void generate_learning_rays(const CameraView& camera, const SampleBlock<N>& block, const Points& film,
                                              const LaneNumbers<N>& numbers, CameraRays<N>& rays) {
    LensRays<float, N> inside;
    int cells[N];
    const auto pixel_of = [&](int lane) { return block.row[lane] * camera.width + block.column[lane]; };
    for (int i = 0; i < N; ++i) {
        const Vec2f at = film[i];
        const GuidedSample u = guided(camera.pixel_pupils.known[pixel_of(i)].promising(), numbers[i]);
        cells[i] = pixel_pupil::cell_of(u.point);
        const FilmRaySample ray = sample_film_ray<lens_kind>(camera, at, u.point);
        inside.origin.set(i, ray.origin);
        inside.direction.set(i, ray.direction);
        rays.weight[i] = ray.weight * u.weight;
    }
    mark_sampled(block, inside, rays);
    trace_lens<lens_kind>(camera.lens, inside);
    set_camera_rays(camera, inside, rays);
    for (int i = 0; i < N; ++i) {
        PixelPupil& pupil = camera.pixel_pupils.found[pixel_of(i)];
        if (rays.sampled[i]) add_bits(&pupil.tried, 1u << cells[i]);
        if (rays.passed[i]) add_bits(&pupil.passed, 1u << cells[i]);
    }
}

/// Generates rays of the polynomial lens model.
template <int N, class Points>
REALCAM_HD inline void generate_polynomial_rays(const CameraView& camera, const SampleBlock<N>& block,
                                                const Points& film, const LaneNumbers<N>& u, CameraRays<N>& rays) {
    LensRays<float, N> inside;
    start_lens_rays<LensKind::rotational>(camera, block, film, u, inside, rays);
    trace_polynomial(camera.polynomial, camera.film_distance, inside);
    set_camera_rays(camera, inside, rays);
}

/// generate_rays_from without the motion of calibrated cameras.
template <LensKind lens_kind, int N, class Points>
REALCAM_HD inline void generate_model_rays(const CameraView& camera, const SampleBlock<N>& block, const Points& film,
                                           CameraRays<N>& rays) {
    if (camera.model == CameraModel::pinhole)
        return generate_ideal_rays(camera, block, film, rays,
                                   [&](Vec2f at, int) { return thin_lens_ray(camera, at, {0.5f, 0.5f}, 0.0f); });
    const LaneNumbers<N> u(block, dimension::pupil);
    switch (camera.model) {
        case CameraModel::pinhole: break;
        case CameraModel::thin_lens:
            generate_ideal_rays(camera, block, film, rays, [&](Vec2f at, int lane) {
                return thin_lens_ray(camera, at, u[lane], camera.thin.pupil_radius);
            });
            break;
        case CameraModel::mapped_lens:
            generate_ideal_rays(camera, block, film, rays,
                                [&](Vec2f at, int lane) { return mapped_lens_ray(camera, at, u[lane]); });
            break;
        case CameraModel::thick_lens:
            generate_ideal_rays(camera, block, film, rays,
                                [&](Vec2f at, int lane) { return thick_lens_ray(camera, at, u[lane]); });
            break;
        case CameraModel::full_lens:
            if constexpr (lens_kind != LensKind::plain) {
                if (camera.pixel_pupils.known) {
                    generate_learning_rays<lens_kind>(camera, block, film, u, rays);
                    break;
                }
            }
            generate_lens_rays<lens_kind>(camera, block, film, u, rays);
            break;
        case CameraModel::polynomial_lens:
            if constexpr (lens_kind != LensKind::plain) generate_polynomial_rays(camera, block, film, u, rays);
            break;
        case CameraModel::full_lens_double:
            if constexpr (lens_kind != LensKind::plain && !kIsDeviceCode)
                generate_lens_rays_in_double(camera, block, film, u, rays);
            break;
    }
}

/// Samples the pupil as seen from given film points and traces the rays through the camera's lens model. `film[lane]`:
/// film point of a lane, mm. Lanes that are not used, or whose ray is blocked, get a valid ray of weight 0.
template <LensKind lens_kind, int N, class Points>
REALCAM_HD inline void generate_rays_from(const CameraView& camera, const SampleBlock<N>& block, const Points& film,
                                          CameraRays<N>& rays) {
    generate_model_rays<lens_kind>(camera, block, film, rays);
    move_bundles(camera, film, rays);
}

/// Samples film and pupil and traces the rays through the lens. The expected value of weight times radiance is the
/// pixel's irradiance, pi L sin^2(theta') for a constant field on the axis. `lens_kind`: LensKind::any, or the lens's
/// own kind.
template <LensKind lens_kind, int N>
REALCAM_HD inline void generate_rays(const CameraView& camera, const SampleBlock<N>& block, CameraRays<N>& rays) {
    generate_rays_from<lens_kind>(camera, block, PixelPoints<N>(camera, block), rays);
}

}  // namespace REALCAM_NAMESPACE
