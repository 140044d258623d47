#pragma once
#include <vector>

#include "../optics/prescription/lens_system.hpp"
#include "../optics/pupil/pupil_tracer.hpp"
#include "../optics/pupil/pupil_view.hpp"
#include "lens_map_view.hpp"

namespace REALCAM_NAMESPACE {

/// Distortion and vignetting of a lens, measured with real rays. Owns the memory of its view.
class LensMap {
public:
    /// `film_radius`: of the film point furthest from the axis, mm. `thin_image_distance`, `pupil_position`: of the
    /// thin lens onto which they are laid, mm. Throws InputError where the film sees 90 degrees or more to the side,
    /// which is behind any thin lens.
    LensMap(const LensSystem& lens, double film_radius, double thin_image_distance, double pupil_position,
            const PupilTracer& tracer);

    LensMapView view() const { return {nodes_.data(), static_cast<int>(nodes_.size()), steps_per_mm_}; }

private:
    static constexpr int kSteps = 128;

    struct Seen {
        double light;  ///< irradiance for unit radiance
        double place;  ///< mean over it: distance from the axis in the plane in focus, mm; the slope, for infinity
        bool is_behind;  ///< some of it comes from behind the lens
    };

    static Seen seen_at(const LensSystem& lens, const PupilView& pupil, const LensView<float>& path, double radius,
                        const PupilTracer& tracer);

    std::vector<LensMapNode> nodes_;
    float steps_per_mm_;
};

}  // namespace REALCAM_NAMESPACE
