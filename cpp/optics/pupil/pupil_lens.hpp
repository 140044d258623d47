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

/// A block of rays that start at film points.
struct PupilRays {
    static constexpr int kBlock = PupilTracer::kBlock;

    double x[kBlock], y[kBlock];  ///< film point, mm
    double l[kBlock], m[kBlock];  ///< optical direction cosines in the tangent frame of the film point (FilmSurface)

    /// Sets the ray of one lane.
    void set(int lane, Vec2<double> film, PupilDirection d);
};

/// A lens prepared for the pupil search, with its ray tracer. Traces rays in float from the film towards the scene.
class PupilLens {
public:
    static constexpr int kBlock = PupilTracer::kBlock;

    /// `wavelengths_nm`: a ray passes if it leaves the lens at any of these wavelengths; if empty, at the design
    /// wavelength. An iris with blades is replaced by the circle around its opening: the pupil then contains all rays
    /// that pass, and the blades block some of its rays when they are traced.
    PupilLens(const LensSystem& lens, PupilTracer tracer, const std::vector<double>& wavelengths_nm = {})
        : PupilLens(lens, round_iris(lens), std::move(tracer), wavelengths_nm) {}

    /// Returns the lens with its blades, at the design wavelength.
    static PupilLens with_blades(const LensSystem& lens, PupilTracer tracer) {
        return {lens, lens, std::move(tracer), {}};
    }

    /// Radius of the stop's bounding circle, mm.
    double stop_radius() const { return lens_.open_stop_radius(); }
    /// Squared refractive index of the medium in front of the film.
    double index_squared() const { return path_.entry_index * path_.entry_index; }

    /// Traces a block of rays: sets passes[i] to true if ray i leaves the lens, and to false otherwise.
    void trace(const PupilRays& start, bool* passes) const;

    /// Traces a block of rays to the plane of the stop, ignoring the stop's rim. `rays`: result, in the frame of the
    /// stop.
    void trace_to_stop(const PupilRays& start, PupilTracer::Rays& rays) const;

    /// Calls task(0) to task(count - 1) in any order and on any threads (PupilTracer::for_each).
    template <class Task>
    void for_each(int count, Task&& task) const {
        tracer_.for_each(count, std::ref(task));
    }

    /// Returns the bounding box of the directions from a film point to the clear aperture of the last surface; for a
    /// radial map, to its half with y >= 0.
    DirectionBox box_of_last_surface(Vec2<double> film, FilmMap film_map) const;

private:
    /// `lens`: provides the film and the design wavelength; `traced`: the lens through which rays are traced, whose
    /// iris may be another one.
    PupilLens(const LensSystem& lens, LensSystem traced, PupilTracer tracer, const std::vector<double>& wavelengths_nm);

    /// Returns the lens with its iris replaced by the circle around the iris's opening.
    static LensSystem round_iris(LensSystem lens);

    /// Traces a block of rays through the surfaces of `view`.
    void trace(const LensView<float>& view, const PupilRays& start, PupilTracer::Rays& rays) const;

    LensSystem lens_;
    PathEnds ends_;  ///< frames of the film and of the camera
    LensPath<float> path_;  ///< path of the first wavelength
    std::vector<LensPath<float>> others_;  ///< paths of the other wavelengths
    FilmSurface<float> film_;
    PupilTracer tracer_;
    std::vector<SurfaceView<float>> surfaces_to_stop_;  ///< from the film to the stop, which has no rim here
    std::vector<FrameChanges<float>> frames_to_stop_;  ///< of these surfaces; empty for a centred lens
    Affine<double> last_surface_;  ///< transform from the last surface's frame to the film's frame
};

}  // namespace REALCAM_NAMESPACE
