#pragma once
#include <functional>
#include <vector>

#include "../trace/film_frame.hpp"
#include "direction_box.hpp"
#include "film_surface.hpp"
#include "pupil_tracer.hpp"

namespace REALCAM_NAMESPACE {

/// A block of rays from film points.
struct PupilRays {
    static constexpr int kBlock = PupilTracer::kBlock;

    double x[kBlock], y[kBlock];  ///< of the film point, mm
    double l[kBlock], m[kBlock];

    void set(int lane, Vec2<double> film, PupilDirection d);
    /// From a film point on the +x axis.
    void set(int lane, double radius, PupilDirection d) { set(lane, Vec2<double>{radius, 0}, d); }
};

/// A lens as the search for its pupil sees it, and what traces rays through it.
class PupilLens {
public:
    static constexpr int kBlock = PupilTracer::kBlock;

    /// `wavelengths_nm`: at any of which a ray may leave the lens; none: the design wavelength.
    PupilLens(const LensSystem& lens, PupilTracer tracer, const std::vector<double>& wavelengths_nm = {});

    /// Of the opening's circle, mm.
    double stop_radius() const { return lens_.open_stop_radius(); }
    double index_squared() const { return path_.entry_index * path_.entry_index; }

    /// Sets passes[0] to passes[kBlock - 1] to whether these rays leave the lens.
    void trace(const PupilRays& from, bool* passes) const;

    /// To the plane of the stop, whose rim stops none.
    void trace_to_stop(const PupilRays& from, PupilTracer::Rays& rays) const;

    /// As PupilTracer::for_each.
    template <class Task>
    void for_each(int count, Task&& task) const {
        tracer_.for_each(count, std::ref(task));
    }

    /// Box of the directions from a film point to the last surface's clear aperture.
    PupilBox box_of_last_surface(double radius) const;
    /// The same of any film point.
    DirectionBox box_of_last_surface(Vec2<double> film) const;

private:
    /// Blades are ignored here and reject rays later; the circle around their opening holds all that pass.
    static LensSystem round_iris(LensSystem lens);

    void trace(const LensView<float>& view, const PupilRays& from, PupilTracer::Rays& rays) const;

    LensSystem lens_;
    PathEnds ends_;  ///< the film, and the camera
    LensPath<float> path_;
    std::vector<LensPath<float>> others_;  ///< of other wavelengths
    FilmSurface<float> film_;
    PupilTracer tracer_;
    std::vector<SurfaceView<float>> surfaces_to_stop_;
    std::vector<FrameChanges<float>> frames_to_stop_;
    Affine<double> last_surface_;  ///< its frame, as rays from the film see it
};

}  // namespace REALCAM_NAMESPACE
