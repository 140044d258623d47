#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "../camera/film/develop.hpp"
#include "../camera/models/generate_rays.hpp"
#include "../math/hypotenuse.hpp"
#include "../optics/pupil/pupil_tracer.hpp"
#include "../optics/trace/film_frame.hpp"
#include "../optics/trace/lens_path.hpp"
#include "plan.hpp"
#include "scene_facts.hpp"

namespace REALCAM_NAMESPACE {

// Differences between the picture of the full lens and those of cheaper camera models, from ray bundles of a few film
// points.

/// Ray bundle of one film point, traced into the scene through one camera model.
struct SampledBundle {
    static constexpr int kRays = PupilTracer::kBlock;

    std::array<LensFrameRay, kRays> rays;
    std::array<bool, kRays> passes{};  ///< true for the rays that have left the lens; others are not set
    double light = 0;  ///< irradiance of the film point for unit radiance
};

/// Intersection of a bundle with a plane of the scene.
struct BundleSpot {
    double x, y;      ///< centre, as the film point at which a lens without aberrations would image it, mm
    double diameter;  ///< of a uniform disc with the same mean square radius, mm on the film
};

namespace sampled_bundles_detail {

/// Point of the unit square from which ray `ray` of a bundle samples the pupil: the same for all camera models.
inline Vec2f pupil_sample(int ray) {
    return sample_2d(0x9e3779b9u, static_cast<std::uint32_t>(ray), dimension::pupil);
}

}  // namespace sampled_bundles_detail

/// Bundle through an ideal lens. `ray_of(u)`: its ray, a LensFrameRay, for a point `u` of the unit square from which
/// the pupil is sampled.
template <class RayOf>
SampledBundle ideal_bundle(RayOf&& ray_of) {
    SampledBundle bundle;
    for (int i = 0; i < SampledBundle::kRays; ++i) {
        const auto k = static_cast<std::size_t>(i);
        bundle.rays[k] = ray_of(sampled_bundles_detail::pupil_sample(i));
        bundle.passes[k] = true;
        bundle.light += static_cast<double>(bundle.rays[k].weight) / SampledBundle::kRays;
    }
    return bundle;
}

/// Bundle through every surface of a lens. `path`: the lens for light from the film to the scene, at one wavelength;
/// `camera`: view that holds the pupil; `film`: film point, mm.
inline SampledBundle traced_bundle(const CameraView& camera, const LensView<float>& path, Vec2f film,
                                   const PupilTracer& tracer) {
    PupilTracer::Rays inside;
    float weights[SampledBundle::kRays];
    for (int i = 0; i < SampledBundle::kRays; ++i) {
        const Vec2f u = sampled_bundles_detail::pupil_sample(i);
        const FilmRaySample ray = sample_film_ray<LensKind::any>(camera, film, u);
        inside.origin.set(i, ray.origin);
        inside.direction.set(i, ray.direction);
        inside.status[i] = ray.weight > 0 ? 0 : static_cast<int>(RayStatus::vignetted);
        weights[i] = ray.weight;
    }
    tracer.trace(path, inside);
    SampledBundle bundle;
    for (int i = 0; i < SampledBundle::kRays; ++i) {
        const auto k = static_cast<std::size_t>(i);
        bundle.passes[k] = inside.status[i] == 0;
        if (!bundle.passes[k]) continue;
        bundle.rays[k] = {inside.origin[i], normalized(inside.direction[i]), weights[i]};
        bundle.light += static_cast<double>(weights[i]) / SampledBundle::kRays;
    }
    return bundle;
}

/// Intersection of a bundle with a plane of the scene, converted to the film by the paraxial magnification. `circle`:
/// CameraView::circle of the lens; `distance_mm`: distance of the plane from the front vertex; may be infinite.
/// Members are NaN if no light passes.
inline BundleSpot spot_of(const SampledBundle& bundle, const CircleOfConfusion& circle, double distance_mm) {
    const bool is_far = !(distance_mm < 1e30);
    // Size in that plane, or slope at infinity, of a film height of 1 mm.
    const double scale =
        is_far ? static_cast<double>(circle.middle_slope)
               : static_cast<double>(circle.middle) + distance_mm * static_cast<double>(circle.middle_slope);
    double sum = 0, x = 0, y = 0, square = 0;
    for (std::size_t k = 0; k < bundle.rays.size(); ++k) {
        if (!bundle.passes[k]) continue;
        const Vec3d o = static_cast<Vec3d>(bundle.rays[k].origin_mm), d = static_cast<Vec3d>(bundle.rays[k].direction);
        const double slope_x = d.x / -d.z, slope_y = d.y / -d.z, distance = distance_mm + o.z;
        const double film_x = (is_far ? slope_x : o.x + distance * slope_x) / scale;
        const double film_y = (is_far ? slope_y : o.y + distance * slope_y) / scale;
        const auto weight = static_cast<double>(bundle.rays[k].weight);
        sum += weight;
        x += weight * film_x;
        y += weight * film_y;
        square += weight * (film_x * film_x + film_y * film_y);
    }
    x /= sum;
    y /= sum;
    return {x, y, 2 * std::sqrt(2 * std::fmax(square / sum - x * x - y * y, 0.0))};
}

/// Diameter of a blur disc, in pixels, above which displacements are hard to see in it.
inline constexpr double kWideDisc_px = 10;

/// Visible difference between two blur discs of diameters `a` and `b`, px: the diameter of a disc that blurs the
/// sharper picture as much as the other one. Pictures have as much detail at every scale (the spectrum falls with the
/// frequency), so that for wide discs the relative difference counts: a change of kVisibleChange of the diameter is as
/// visible as half a pixel in a sharp picture.
inline double blur_between(double a, double b) {
    constexpr double kVisibleChange = 0.05;
    const double smaller = std::min(a, b), masking = 1 + 8 * kVisibleChange * smaller * smaller;
    return std::sqrt(std::fabs(a * a - b * b) / masking);
}

/// Largest differences over the film between the picture of another camera model and that of the full lens.
struct ModelError {
    double moved_px = 0;  ///< displacement; reduced in proportion if the blur discs are wider than kWideDisc_px
    double blur_px = 0;  ///< see blur_between
    double light_codes = 0;  ///< difference in brightness, 8-bit codes

    bool is_within(const PlanThresholds& thresholds) const {
        return moved_px < thresholds.pixels && blur_px < thresholds.pixels && light_codes < thresholds.codes;
    }
};

/// Differences of each cheaper camera model, and properties of the lens that the planner compares with thresholds.
struct LensErrors {
    ModelError pinhole, thin, mapped, thick;
    double defocus_px = 0;  ///< diameter of the widest circle of confusion of a lens without aberrations
    double lateral_colour_px = 0;  ///< displacement between blue and red light
    double axial_colour_px = 0;  ///< difference in blur between blue and red light
    double film_sine = 0;  ///< sine of half the angle under which the film centre sees the aperture
};

namespace lens_errors_detail {

/// A tenth of the luminous response to white light lies below kBlue_nm, and a tenth above kRed_nm.
inline constexpr double kBlue_nm = 500, kRed_nm = 620;

/// Raises `largest` to `value` if that is larger. NaN, from a model that sees nothing at that point, counts as
/// infinite.
inline void raise(double& largest, double value) {
    if (!(value <= largest)) largest = std::isnan(value) ? kInfinity : value;
}

/// Raises the errors of displacement and blur to those between two spots, of the full lens and of another model.
inline void compare(const BundleSpot& full, const BundleSpot& other, double px_per_mm, ModelError& error) {
    const double smaller = px_per_mm * std::min(full.diameter, other.diameter);
    const double visible_px_per_mm = px_per_mm / std::max(1.0, smaller / kWideDisc_px);
    raise(error.moved_px, visible_px_per_mm * hypotenuse(full.x - other.x, full.y - other.y));
    raise(error.blur_px, blur_between(px_per_mm * full.diameter, px_per_mm * other.diameter));
}

/// Codes below which a tile is too dark to show any blur. Such a tile may be half black and half twice as bright, and
/// half a pixel of blur takes an eighth of that.
inline constexpr double kDarkCodes = 4;

/// Object distances from the front vertex, mm, at which models are compared: the nearest and the farthest in view, and
/// the plane in focus, clamped between them.
inline std::vector<double> depths_of(const SceneFacts& facts, const LensSystem& lens) {
    double nearest = kInfinity, farthest = 0;
    for (const SceneTile& tile : facts.tiles) {
        if (!(tile.depth_mm > 0) || code_of(tile.value) < kDarkCodes) continue;
        nearest = std::min(nearest, tile.depth_mm);
        farthest = std::max(farthest, tile.depth_mm);
    }
    const double focus = lens.focus_distance - lens.film_position();
    if (farthest == 0) return {focus};
    return {nearest, std::clamp(focus, nearest, farthest), farthest};
}

/// Value of the brightest of the four tiles at a fraction `field` of the distance from the picture's centre to its
/// corners.
inline double brightest_value_at(const SceneFacts& facts, double field) {
    double largest = 0;
    for (const double x : {-field, field})
        for (const double y : {-field, field})
            largest = std::max(largest, facts.tile_at(0.5 + 0.5 * x, 0.5 + 0.5 * y).value);
    return largest;
}

}  // namespace lens_errors_detail

/// Compares camera models by ray bundles of film points from the film centre to a corner, at the object distances of
/// the scene. `full`: view of a camera with the full model; `ideal`: view of the same camera with an ideal lens;
/// `lens`: the camera's lens.
inline LensErrors lens_errors(const CameraView& full, const CameraView& ideal, const LensSystem& lens,
                              const SceneFacts& facts, const PupilTracer& tracer) {
    using namespace lens_errors_detail;
    const double px_per_mm = 0.5 * full.width / static_cast<double>(full.film_half_width);
    const std::vector<double> depths = depths_of(facts, lens);
    const double focused_depth = depths[depths.size() / 2];
    const PathEnds ends = film_path_ends(lens, LightDirection::to_scene);
    const LensPath<float> blue(lens, LightDirection::to_scene, kBlue_nm, ends),
        red(lens, LightDirection::to_scene, kRed_nm, ends);
    LensErrors errors;
    errors.film_sine = std::sqrt(static_cast<double>(ideal.axis_irradiance) / std::numbers::pi);
    for (const double field : {0.0, 0.25, 0.5, 0.7, 0.85, 0.97}) {
        // Towards the corner farthest from the axis.
        const Vec2f film = {
            full.film_centre.x + std::copysign(static_cast<float>(field) * full.film_half_width, full.film_centre.x),
            full.film_centre.y + std::copysign(static_cast<float>(field) * full.film_half_height, full.film_centre.y)};
        const SampledBundle traced = traced_bundle(full, full.lens, film, tracer);
        const SampledBundle pinhole = ideal_bundle([&](Vec2f u) { return thin_lens_ray(ideal, film, u, 0.0f); });
        const SampledBundle thin =
            ideal_bundle([&](Vec2f u) { return thin_lens_ray(ideal, film, u, ideal.thin.pupil_radius); });
        const SampledBundle thick = ideal_bundle([&](Vec2f u) { return thick_lens_ray(ideal, film, u); });
        const double value = brightest_value_at(facts, field), value_per_light = value / thin.light;
        const auto codes_between = [&](double light) {
            return std::fabs(code_of(value_per_light * traced.light) - code_of(value_per_light * light));
        };
        for (ModelError* error : {&errors.pinhole, &errors.thin}) raise(error->light_codes, codes_between(thin.light));
        raise(errors.thick.light_codes, codes_between(thick.light));
        if (!(traced.light > 0)) continue;  // outside the image circle
        // The film point at which the thin lens images the same point of the plane in focus.
        const BundleSpot real = spot_of(traced, full.circle, focused_depth),
                         undistorted = spot_of(thin, full.circle, focused_depth);
        const auto scale = static_cast<float>(
            film.x != 0 || film.y != 0 ? hypotenuse(real.x, real.y) / hypotenuse(undistorted.x, undistorted.y) : 1.0);
        const SampledBundle mapped = ideal_bundle([&](Vec2f u) {
            return thin_lens_ray(ideal, {scale * film.x, scale * film.y}, u, ideal.thin.pupil_radius);
        });
        const SampledBundle in_blue = traced_bundle(full, blue.view(), film, tracer);
        const SampledBundle in_red = traced_bundle(full, red.view(), film, tracer);
        for (const double depth : depths) {
            const BundleSpot spot = spot_of(traced, full.circle, depth);
            compare(spot, spot_of(pinhole, full.circle, depth), px_per_mm, errors.pinhole);
            const BundleSpot without_aberrations = spot_of(thin, full.circle, depth);
            raise(errors.defocus_px, px_per_mm * without_aberrations.diameter);
            compare(spot, without_aberrations, px_per_mm, errors.thin);
            compare(spot, spot_of(mapped, full.circle, depth), px_per_mm, errors.mapped);
            compare(spot, spot_of(thick, full.circle, depth), px_per_mm, errors.thick);
            ModelError colour;
            compare(spot_of(in_blue, full.circle, depth), spot_of(in_red, full.circle, depth), px_per_mm, colour);
            raise(errors.lateral_colour_px, colour.moved_px);
            raise(errors.axial_colour_px, colour.blur_px);
        }
    }
    return errors;
}

}  // namespace REALCAM_NAMESPACE
