#pragma once
#include <vector>

#include "lens_path.hpp"

namespace REALCAM_NAMESPACE {

/// Path of a lens with modified rims, for ray aiming. Owns the memory of its views.
class AimingPath {
public:
    /// The path without rims, blades, obstructions and apertures, for aiming rays; whether the real lens passes a ray
    /// is checked afterwards. Aspheres are still searched only within their search radius.
    static AimingPath open(const LensPath<double>& path);
    /// The real path, except that the stop is unbounded. `stop`: its surface index in the lens.
    static AimingPath with_open_stop(const LensPath<double>& path, int stop);
    /// The unmodified path.
    static AimingPath real(const LensPath<double>& path) { return AimingPath(path); }

    LensView<double> view() const;
    /// The first `count` surfaces in the order of the light. Rays end in the frame of the last of them.
    LensView<double> first(int count) const;

private:
    explicit AimingPath(const LensPath<double>& path);

    LensKind kind_;
    std::vector<SurfaceView<double>> steps_;
    std::vector<FrameChanges<double>> frames_, frames_without_exit_;  ///< the latter without the changes to exit frames
    std::vector<FreeformView<double>> freeforms_;
    std::vector<ApertureView<double>> apertures_;
    Iris<double> iris_;
};

}  // namespace REALCAM_NAMESPACE
