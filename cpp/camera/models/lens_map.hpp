#pragma once
#include <vector>

#include "../../optics/prescription/lens_system.hpp"
#include "../../optics/pupil/pupil_tracer.hpp"
#include "../../optics/pupil/pupil_view.hpp"
#include "lens_map_view.hpp"

namespace REALCAM_NAMESPACE {

/// Distortion and vignetting of a lens, measured with real rays, for the camera model mapped_lens. Owns the memory of
/// its view.
class LensMap {
public:
    /// `film_radius`: distance of the farthest film point from the axis, mm. `thin_image_distance`, `pupil_position`:
    /// image distance of the thin lens to which distortion and vignetting are applied, and the position of its pupil
    /// from the front vertex, mm. Throws InputError if the film sees directions of 90 degrees or more from the axis,
    /// which no thin lens can image.
    LensMap(const LensSystem& lens, double film_radius, double thin_image_distance, double pupil_position,
            const PupilTracer& tracer);

    LensMapView view() const { return {nodes_.data(), static_cast<int>(nodes_.size()), steps_per_mm_}; }

private:
    static constexpr int kSteps = 128;

    /// Light of a film point, from the rays traced from it.
    struct FilmPointView {
        double light;  ///< irradiance for unit radiance
        double position;  ///< mean over the light of its distance from the axis in the plane in focus, mm; at infinity,
                          ///< of its slope
        bool is_behind;  ///< true if some of the light comes from 90 degrees or more from the axis
    };

    /// Traces a bundle from the film point at +x at a distance `radius` from the axis, mm. `path`: the lens for light
    /// from the film to the scene.
    static FilmPointView trace_film_point(const LensSystem& lens, const PupilView& pupil, const LensView<float>& path,
                                          double radius, const PupilTracer& tracer);

    std::vector<LensMapNode> nodes_;
    float steps_per_mm_;
};

}  // namespace REALCAM_NAMESPACE
