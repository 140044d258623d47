#pragma once
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "lens_path.hpp"
#include "pupil_box.hpp"
#include "pupil_tracer.hpp"

namespace REALCAM_NAMESPACE {

/// A block of rays from film points on the +x axis.
struct PupilRays {
    static constexpr int kBlock = PupilTracer::kBlock;

    double radius[kBlock];  ///< of the film point, mm
    double l[kBlock], m[kBlock];

    void set(int lane, double from_radius, PupilDirection d) {
        radius[lane] = from_radius;
        l[lane] = d.l;
        m[lane] = d.m;
    }
};

/// A lens as the search for its pupil sees it, and what traces rays through it.
class PupilLens {
public:
    static constexpr int kBlock = PupilTracer::kBlock;

    /// `wavelengths_nm`: at any of which a ray may leave the lens; none: the design wavelength.
    PupilLens(const LensSystem& lens, PupilTracer tracer, const std::vector<double>& wavelengths_nm = {})
        : lens_(round_iris(lens)),
          path_(lens_, LightDirection::to_scene, wavelengths_nm.empty() ? lens.wavelength_nm : wavelengths_nm.front()),
          tracer_(std::move(tracer)),
          has_aspheres_(std::any_of(lens.surfaces.begin(), lens.surfaces.end(),
                                    [](const Surface& surface) { return surface.is_asphere(); })) {
        for (std::size_t i = 1; i < wavelengths_nm.size(); ++i)
            others_.emplace_back(lens_, LightDirection::to_scene, wavelengths_nm[i]);
        const LensView<float> all = path_.view();
        surfaces_to_stop_.assign(all.surfaces, all.surfaces + all.count - lens_.stop_index());
        surfaces_to_stop_.back().rim_squared = std::numeric_limits<float>::max();
    }

    double index_squared() const { return path_.entry_index * path_.entry_index; }

    /// Sets passes[0] to passes[kBlock - 1] to whether these rays leave the lens.
    void trace(const PupilRays& from, bool* passes) const {
        PupilTracer::Rays rays;
        trace(path_.view(), from, rays);
        REALCAM_LANES
        for (int i = 0; i < kBlock; ++i) passes[i] = rays.status[i] == 0;
        for (const LensPath<float>& other : others_) {
            trace(other.view(), from, rays);
            REALCAM_LANES
            for (int i = 0; i < kBlock; ++i) passes[i] |= rays.status[i] == 0;
        }
    }

    /// To the plane of the stop, whose rim stops none.
    void trace_to_stop(const PupilRays& from, PupilTracer::Rays& rays) const {
        LensView<float> view = path_.view();
        view.surfaces = surfaces_to_stop_.data();
        view.count = static_cast<int>(surfaces_to_stop_.size());
        trace(view, from, rays);
    }

    /// As PupilTracer::for_each.
    template <class Task>
    void for_each(int count, Task&& task) const {
        tracer_.for_each(count, std::ref(task));
    }
    /// The same for tasks of one block of rays each. A block takes less time through spheres than a thread to wake up:
    /// only aspheres are worth it.
    template <class Task>
    void for_each_block(int count, Task&& task) const {
        if (has_aspheres_) return for_each(count, task);
        for (int i = 0; i < count; ++i) task(i);
    }

    /// Box of the directions from a film point to the last surface's clear aperture.
    PupilBox box_of_last_surface(double radius) const {
        const Surface& last = lens_.surfaces.back();
        PupilBox box = PupilBox::none();
        for (int ring = 0; ring <= 8; ++ring) {
            const double r = last.clear_semi_diameter * ring / 8, z = last.sag(r) - lens_.film_distance;
            for (int spoke = 0; spoke <= 16; ++spoke) {
                const double angle = std::numbers::pi * spoke / 16;
                const Vec3d d =
                    path_.entry_index * normalized(Vec3d{r * std::cos(angle) - radius, r * std::sin(angle), z});
                box = box.with({d.x, d.y});
            }
        }
        return box.grown(0.02);
    }

private:
    /// Blades are ignored here and reject rays later; the circle around their opening holds all that pass.
    static LensSystem round_iris(LensSystem lens) {
        const double rim = lens.stop().clear_semi_diameter;
        if (lens.iris.blades > 0 && !lens.is_wide_open()) {
            const Iris<double> open = open_iris(lens.iris, lens.stop_semi_diameter, rim);
            const double h = open.apothem, q = open.curvature;
            const double linear = (1 - q * h) * std::cos(std::numbers::pi / open.blades), constant = 2 * h - q * h * h;
            lens.stop_semi_diameter = std::min(rim, constant / (linear + std::sqrt(linear * linear + q * constant)));
        }
        lens.iris.blades = 0;
        return lens;
    }

    void trace(const LensView<float>& view, const PupilRays& from, PupilTracer::Rays& rays) const {
        const double n2 = index_squared();
        const auto z = static_cast<float>(lens_.film_distance);
        REALCAM_LANES
        for (int i = 0; i < kBlock; ++i) {
            const double l = from.l[i], m = from.m[i], squared = n2 - l * l - m * m;
            rays.origin.set(i, {static_cast<float>(from.radius[i]), 0, z});
            rays.direction.set(
                i, {static_cast<float>(l), static_cast<float>(m), -static_cast<float>(sqrt_or_zero(squared))});
            rays.status[i] = squared > 0 ? 0 : static_cast<int>(RayStatus::missed);
        }
        tracer_.trace(view, rays);
    }

    LensSystem lens_;
    LensPath<float> path_;
    std::vector<LensPath<float>> others_;  ///< of other wavelengths
    PupilTracer tracer_;
    std::vector<SurfaceView<float>> surfaces_to_stop_;
    bool has_aspheres_;
};

}  // namespace REALCAM_NAMESPACE
