#include "lens_map.hpp"

#include <cmath>

#include "../../math/random.hpp"
#include "../../optics/pupil/pupil.hpp"

namespace realcam {

LensMap::LensMap(const LensSystem& lens, double film_radius, double thin_image_distance, double pupil_position,
                 const PupilTracer& tracer)
    : steps_per_mm_(static_cast<float>(kSteps / film_radius)) {
    const Pupil pupil(lens, film_radius * (1 + 1.0 / kSteps), tracer);
    const LensPath<float> path(lens, LightDirection::to_scene, lens.wavelength_nm);
    nodes_.resize(kSteps + 1);
    std::vector<int> sees_behind(kSteps + 1, 0);
    tracer.for_each(kSteps + 1, [&](int step) {
        const auto k = static_cast<std::size_t>(step);
        // On the axis the quotient is 0 / 0; that of a nearby film point replaces it.
        const double radius = step == 0 ? 0.1 * film_radius / kSteps : film_radius * step / kSteps;
        const FilmPointView view = trace_film_point(lens, pupil.view(), path.view(), radius, tracer);
        sees_behind[k] = view.is_behind;
        nodes_[k].light = static_cast<float>(view.light);
        if (!(view.light > 0)) return;
        // A thin lens images the direction of slope r / image distance, from its centre, at the film radius r.
        const double distance = lens.focus_distance - lens.film_position() + pupil_position;
        const double slope = std::isfinite(lens.focus_distance) ? view.position / distance : view.position;
        nodes_[k].scale = static_cast<float>(slope * thin_image_distance / radius);
    });
    for (std::size_t k = 1; k < nodes_.size(); ++k) {
        if (sees_behind[k])
            throw InputError(
                "the camera model mapped cannot represent lens \"" + lens.name +
                "\": its film sees 90 degrees from the axis and more; use a smaller film or the model full");
        if (!(nodes_[k].light > 0)) nodes_[k].scale = nodes_[k - 1].scale;
    }
}

LensMap::FilmPointView LensMap::trace_film_point(const LensSystem& lens, const PupilView& pupil,
                                                 const LensView<float>& path, double radius,
                                                 const PupilTracer& tracer) {
    constexpr int kSamples = 4096;
    const double plane = lens.film_position() - lens.focus_distance;
    double light = 0, sum = 0;
    bool is_behind = false;
    for (int first = 0; first < kSamples; first += PupilTracer::kBlock) {
        PupilTracer::Rays rays;
        float weights[PupilTracer::kBlock];
        for (int k = 0; k < PupilTracer::kBlock; ++k) {
            const Vec2f u = sample_2d(0, static_cast<std::uint32_t>(first + k), 0);
            const PupilSample sample = sample_pupil(pupil, static_cast<float>(radius), 0, u.x, u.y);
            weights[k] = sample.weight;
            rays.origin.set(k, {static_cast<float>(radius), 0, static_cast<float>(lens.film_distance)});
            rays.direction.set(k, sample.direction);
            rays.status[k] = sample.weight > 0 ? 0 : static_cast<int>(RayStatus::vignetted);
        }
        tracer.trace(path, rays);
        for (int k = 0; k < PupilTracer::kBlock; ++k) {
            if (rays.status[k] != 0) continue;
            const Vec3d o = static_cast<Vec3d>(rays.origin[k]), d = static_cast<Vec3d>(rays.direction[k]);
            is_behind |= d.z > -1e-3 * length(d);
            const double weight = static_cast<double>(weights[k]), slope = d.x / d.z;
            const double position = std::isfinite(plane) ? o.x + (plane - o.z) * slope : -slope;
            light += weight;
            sum -= weight * position;  // the image is inverted: a film point at +x sees points at -x
        }
    }
    static_assert(kSamples % PupilTracer::kBlock == 0);
    return {light / kSamples, light > 0 ? sum / light : 0, is_behind};
}

}  // namespace realcam
