#pragma once
#include <algorithm>
#include <vector>

#include "lens_system.hpp"
#include "lens_trace.hpp"

namespace REALCAM_NAMESPACE {

enum class LightDirection { to_film, to_scene };

/// The surfaces of a lens in the order in which light of one wavelength meets them. Owns the memory of its view.
template <class T>
class LensPath {
public:
    LensPath(const LensSystem& lens, LightDirection direction, double wavelength_nm) : iris_(iris_of(lens)) {
        const int count = static_cast<int>(lens.surfaces.size());
        const std::vector<double> n = lens.indices(wavelength_nm);
        const std::vector<double> z = lens.vertices();
        double sense = 1;  // of light on its way to the film
        for (int i = 0; i < count; ++i) {
            const Surface& surface = lens.surfaces[static_cast<std::size_t>(i)];
            const double sense_behind = surface.type == SurfaceType::mirror ? -sense : sense;
            LensStep<T> step = shape_of(surface);
            step.surface_index = i;
            const auto k = static_cast<std::size_t>(i);
            if (direction == LightDirection::to_film) {
                set_media(step, n[k], n[k + 1], sense, sense_behind);
                step.shift = static_cast<T>(i == 0 ? 0.0 : z[k] - z[k - 1]);
            } else {
                set_media(step, n[k + 1], n[k], -sense_behind, -sense);
                step.shift = static_cast<T>(i == count - 1 ? 0.0 : z[k] - z[k + 1]);
            }
            if (surface.type == SurfaceType::stop) set_stop(step, lens);
            steps_.push_back(step);
            sense = sense_behind;
        }
        if (direction == LightDirection::to_scene) std::reverse(steps_.begin(), steps_.end());
        entry_index = direction == LightDirection::to_film ? n.front() : n.back();
        // A few diameters: what a float32 of the first surface's size can square.
        entry_reach =
            16 *
            (direction == LightDirection::to_film ? lens.surfaces.front() : lens.surfaces.back()).clear_semi_diameter;
        entry_position = direction == LightDirection::to_film ? z.front() : z.back();
        exit_position = direction == LightDirection::to_film ? z.back() : z.front();
    }

    LensView<T> view() const {
        const bool plain = std::all_of(steps_.begin(), steps_.end(), [](const LensStep<T>& step) {
            return step.kind == StepKind::sphere && step.hole_squared < T(0) && !step.has_blades;
        });
        return {steps_.data(), static_cast<int>(steps_.size()), plain ? LensKind::plain : LensKind::any, iris_};
    }

    double entry_index = 1;  ///< of the medium from which rays enter: what their unit directions are multiplied by
    double entry_reach = 0;     ///< rays from farther away than this are to start nearer (enter_lens), mm
    double entry_position = 0;  ///< z of the vertex to which the origins of entering rays are relative
    double exit_position = 0;  ///< the same for leaving rays

private:
    static LensStep<T> shape_of(const Surface& surface) {
        LensStep<T> step{};
        step.kind = surface.is_asphere() ? StepKind::asphere : surface.conic != 0 ? StepKind::conic : StepKind::sphere;
        step.curvature = static_cast<T>(surface.curvature);
        step.conic_factor = static_cast<T>(1 + surface.conic);
        const double rim = surface.clear_semi_diameter, hole = surface.inner_semi_diameter;
        step.rim_squared = static_cast<T>(rim * rim);
        step.hole_squared = static_cast<T>(hole > 0 ? hole * hole : -1.0);
        if (step.kind == StepKind::asphere) set_search_region(step, surface);
        return step;
    }

    /// The search goes 2% past the rim, so that a ray that just misses it is seen to miss it; the sag's bounds there
    /// are sampled, and widened by more than it can change between two samples of a surface that can be made.
    static void set_search_region(LensStep<T>& step, const Surface& surface) {
        double reach = 1.02 * surface.clear_semi_diameter;
        if (!std::isfinite(surface.sag(reach))) reach = surface.clear_semi_diameter;
        constexpr int kSamples = 256;
        double low = 0, high = 0;
        for (int i = 1; i <= kSamples; ++i) {
            const double sag = surface.sag(reach * i / kSamples);
            low = std::min(low, sag);
            high = std::max(high, sag);
        }
        const double margin = 0.02 * (high - low) + 1e-3 * reach;
        step.sag_edge = static_cast<T>(surface.sag(reach));
        step.search_squared = static_cast<T>(reach * reach);
        step.inverse_search_squared = static_cast<T>(1 / (reach * reach));
        for (std::size_t i = 0; i < surface.aspheric.size(); ++i)
            step.aspheric[i] = static_cast<T>(surface.aspheric[i] * std::pow(reach, 4 + 2 * static_cast<double>(i)));
        step.sag_min = static_cast<T>(low - margin);
        step.sag_max = static_cast<T>(high + margin);
    }

    static void set_media(LensStep<T>& step, double before, double after, double sense_in, double sense_out) {
        step.index_squared = static_cast<T>(before * before);
        step.relative_step = static_cast<T>((after - before) * (after + before) / (before * before));
        step.sense_in = static_cast<T>(sense_in);
        step.sense_out = static_cast<T>(sense_out);
    }

    static void set_stop(LensStep<T>& step, const LensSystem& lens) {
        step.has_blades = lens.iris.blades > 0 && !lens.is_wide_open();
        if (!step.has_blades) {
            const double radius = std::min(lens.stop_semi_diameter, lens.stop().clear_semi_diameter);
            step.rim_squared = static_cast<T>(radius * radius);
        }
    }

    static Iris<T> iris_of(const LensSystem& lens) {
        Iris<T> iris{};
        if (lens.iris.blades == 0 || lens.is_wide_open()) return iris;
        const Iris<double> open = open_iris(lens.iris, lens.stop_semi_diameter, lens.stop().clear_semi_diameter);
        iris.blades = open.blades;
        iris.apothem = static_cast<T>(open.apothem);
        iris.curvature = static_cast<T>(open.curvature);
        std::transform(open.cos, open.cos + open.blades, iris.cos, [](double v) { return static_cast<T>(v); });
        std::transform(open.sin, open.sin + open.blades, iris.sin, [](double v) { return static_cast<T>(v); });
        return iris;
    }

    std::vector<LensStep<T>> steps_;
    Iris<T> iris_;
};

}  // namespace REALCAM_NAMESPACE
