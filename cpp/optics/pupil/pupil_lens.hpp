#pragma once
#include <functional>
#include <utility>
#include <vector>

#include "../trace/film_frame.hpp"
#include "direction_box.hpp"
#include "film_surface.hpp"
#include "pupil_tracer.hpp"

namespace REALCAM_NAMESPACE {

/// The film points over which a pupil is tabulated.
enum class FilmMap {
    radial,  ///< one dimension, the film radius: points on the +x axis of a lens with a radial pupil, where the region
             ///< of passing directions is symmetric in m
    planar,  ///< two dimensions, x and y: all points of any film
};

/// A block of rays from film points, with their optical direction cosines.
struct PupilRays {
    static constexpr int kBlock = PupilTracer::kBlock;

    double x[kBlock], y[kBlock];  ///< film point, mm
    double l[kBlock], m[kBlock];

    void set(int lane, Vec2<double> film, PupilDirection d);
};

/// A lens as the pupil search traces it, and its tracer.
class PupilLens {
public:
    static constexpr int kBlock = PupilTracer::kBlock;

    /// `wavelengths_nm`: a ray passes if it leaves the lens at any of these; empty: the design wavelength. The blades
    /// of the iris are replaced by the circle around their opening, which contains all rays that pass; blades reject
    /// rays later.
    PupilLens(const LensSystem& lens, PupilTracer tracer, const std::vector<double>& wavelengths_nm = {})
        : PupilLens(lens, round_iris(lens), std::move(tracer), wavelengths_nm) {}

    /// The lens with its blades, at the design wavelength.
    static PupilLens with_blades(const LensSystem& lens, PupilTracer tracer) {
        return {lens, lens, std::move(tracer), {}};
    }

    /// Radius of the stop's bounding circle, mm.
    double stop_radius() const { return lens_.open_stop_radius(); }
    double index_squared() const { return path_.entry_index * path_.entry_index; }

    /// Sets passes[0] to passes[kBlock - 1] to true for rays that leave the lens.
    void trace(const PupilRays& from, bool* passes) const;

    /// Traces rays to the plane of the stop, ignoring the stop's rim.
    void trace_to_stop(const PupilRays& from, PupilTracer::Rays& rays) const;

    /// Calls PupilTracer::for_each.
    template <class Task>
    void for_each(int count, Task&& task) const {
        tracer_.for_each(count, std::ref(task));
    }

    /// Box of the directions from a film point to the last surface's clear aperture; for a radial map, to its half
    /// y >= 0.
    DirectionBox box_of_last_surface(Vec2<double> film, FilmMap film_map) const;

private:
    /// `traced`: the lens with the iris that blocks rays.
    PupilLens(const LensSystem& lens, LensSystem traced, PupilTracer tracer, const std::vector<double>& wavelengths_nm);

    static LensSystem round_iris(LensSystem lens);

    void trace(const LensView<float>& view, const PupilRays& from, PupilTracer::Rays& rays) const;

    LensSystem lens_;
    PathEnds ends_;  ///< frames of the film and of the camera
    LensPath<float> path_;
    std::vector<LensPath<float>> others_;  ///< paths of the other wavelengths
    FilmSurface<float> film_;
    PupilTracer tracer_;
    std::vector<SurfaceView<float>> surfaces_to_stop_;
    std::vector<FrameChanges<float>> frames_to_stop_;
    Affine<double> last_surface_;  ///< frame of the last surface, in the film's frame
};

}  // namespace REALCAM_NAMESPACE
