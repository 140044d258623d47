#pragma once
#include <vector>

#include "../../optics/prescription/lens_system.hpp"
#include "../../optics/pupil/pupil_tracer.hpp"
#include "../../optics/pupil/pupil_view.hpp"
#include "lens_map_view.hpp"

namespace REALCAM_NAMESPACE {

/// Distortion and vignetting of a lens, measured with real rays. Owns the memory of its view.
class LensMap {
public:
    /// `film_radius`: of the film point farthest from the axis, mm. `thin_image_distance`, `pupil_position`: of the
    /// thin lens to which distortion and vignetting are applied, mm. Throws InputError if the film sees directions of
    /// 90 degrees or more from the axis, which no thin lens can image.
    LensMap(const LensSystem& lens, double film_radius, double thin_image_distance, double pupil_position,
            const PupilTracer& tracer);

    LensMapView view() const { return {nodes_.data(), static_cast<int>(nodes_.size()), steps_per_mm_}; }

private:
    static constexpr int kSteps = 128;

    struct Seen {
        double light;  ///< irradiance for unit radiance
        double position;  ///< mean over the light of its distance from the axis in the plane in focus, mm; at infinity,
                          ///< of its slope
        bool is_behind;  ///< true if some of the light comes from 90 degrees or more from the axis
    };

    static Seen seen_at(const LensSystem& lens, const PupilView& pupil, const LensView<float>& path, double radius,
                        const PupilTracer& tracer);

    std::vector<LensMapNode> nodes_;
    float steps_per_mm_;
};

}  // namespace REALCAM_NAMESPACE
